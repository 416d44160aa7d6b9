//! Closed forms of shading, each against an independent construction.

use crate::common::ODD;
use glam::{DVec2, DVec3, Vec3};
use texture::disc::{cosine, direction, disc, frame, lens, light};
use texture::fog::Fog;
use texture::refraction::{dispersed, reflect, refract, shares};
use texture::sequence::{Purpose, sample};
use texture::tone::filmic;
use trials::{Random, count};

/// Star discrepancy of points in the square, with boxes whose corners are on a grid.
fn discrepancy(points: &[[f64; 2]]) -> f64 {
    let steps = 64;
    let mut worst = 0.0_f64;
    for i in 1..=steps {
        for j in 1..=steps {
            let (x, y) = (
                f64::from(i) / f64::from(steps),
                f64::from(j) / f64::from(steps),
            );
            let inside = points.iter().filter(|p| p[0] < x && p[1] < y).count();
            worst = worst.max((inside as f64 / points.len() as f64 - x * y).abs());
        }
    }
    worst
}

/// Snell's law with angles: in the plane of normal and ray, n₁ sin α = n₂ sin β.
#[test]
fn refraction_obeys_snell() {
    let mut random = Random::new(51);
    let mut total = 0;
    for _ in 0..count(5_000) {
        let (normal, ratio) = (random.direction(), random.range(0.4, 2.5));
        let ray = random.direction();
        let side = if ray.dot(normal) < 0.0 {
            normal
        } else {
            -normal
        };
        let cos = -ray.dot(side);
        let alpha = libm::acos(cos.min(1.0));
        let sine = ratio * libm::sin(alpha);
        let got = refract(ray, normal, ratio);
        assert_eq!(
            refract(ray, -normal, ratio),
            got,
            "the normal's side must not matter"
        );
        if sine > 1.0 + 1e-12 {
            total += 1;
            assert_eq!(got, None);
        } else if sine < 1.0 - 1e-12 {
            let beta = libm::asin(sine);
            let along = (ray + cos * side).normalize_or_zero();
            let want = libm::sin(beta) * along - libm::cos(beta) * side;
            assert!(
                (got.unwrap() - want).length() < 1e-6,
                "{got:?} instead of {want}"
            );
            // Back the same way.
            let back = refract(-got.unwrap(), normal, 1.0 / ratio);
            assert!((back.unwrap() + ray).length() < 1e-6);
        }
        let mirrored = reflect(ray, normal);
        assert!((mirrored.dot(normal) + ray.dot(normal)).abs() < 1e-12);
        assert!((mirrored - ray).cross(normal).length() < 1e-12);
    }
    assert!(total > count(500));
    // Index 1: straight on. Grazing, and indices that are none.
    let ray = random.direction();
    assert!((refract(ray, DVec3::Z, 1.0).unwrap() - ray).length() < 1e-12);
    assert!(refract(DVec3::X, DVec3::Z, 1.5).is_none());
    assert!(refract(DVec3::X, DVec3::Z, 0.5).unwrap().is_finite());
    for ratio in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refract(ray, DVec3::Z, ratio), None);
    }
}

#[test]
fn dispersion_spreads_the_index() {
    for (index, spread) in [(1.5, 0.03), (1.1, -0.1), (2.4, 0.0)] {
        let n = dispersed(index, spread);
        assert_eq!(n[1], index);
        assert!((n[2] - n[0] - spread).abs() < 1e-12);
        // On Cauchy's line: n against 1/λ² is straight.
        let x = [0.61, 0.55, 0.465_f64].map(|w| 1.0 / (w * w));
        let [low, high] = [0, 1].map(|i| (n[i + 1] - n[i]) / (x[i + 1] - x[i]));
        assert!((low - high).abs() < 1e-12);
    }
    assert!(dispersed(0.1, 9.0).iter().all(|n| *n > 0.0));
    assert!(dispersed(1.5, f64::NAN).iter().all(|n| *n == 1.5));
    let (a, b) = (Vec3::splat(0.25), Vec3::splat(0.5));
    assert_eq!(shares(a, b, false), [a, b]);
    assert_eq!(shares(a, b, true), [a + b, Vec3::ZERO]);
}

/// Areas go over into equal areas: rings and sectors of the disc get their share, and the middle of
/// cosine-spread directions is at 2/3 of the axis.
#[test]
fn discs_and_directions_are_even() {
    let count = 4096_u32;
    let points: Vec<_> = (0..count)
        .map(|i| sample([5, 9], i, Purpose::Lens))
        .collect();
    let share = |test: &dyn Fn(DVec2) -> bool| {
        points.iter().filter(|p| test(disc(**p))).count() as f64 / f64::from(count)
    };
    for r in [0.2, 0.5, 0.9] {
        assert!((share(&|p| p.length() < r) - r * r).abs() < 0.01);
    }
    for (x, y) in [(1.0, 0.3), (-0.2, 1.0), (-1.0, -1.0)] {
        assert!((share(&|p| p.x * x + p.y * y > 0.0) - 0.5).abs() < 0.01);
    }
    assert!(points.iter().all(|p| disc(*p).length() <= 1.0 + 1e-12));
    let mean = |f: &dyn Fn([f64; 2]) -> DVec3| {
        points.iter().map(|p| f(*p)).sum::<DVec3>() / f64::from(count)
    };
    assert!(mean(&|p| direction(p)).length() < 5e-3);
    let squares = mean(&|p| direction(p) * direction(p));
    assert!((squares - DVec3::splat(1.0 / 3.0)).length() < 5e-3);
    let axis = DVec3::new(0.6, 0.0, 0.8);
    assert!((mean(&|p| cosine(axis, p)) - 2.0 / 3.0 * axis).length() < 5e-3);
    let [a, b] = frame(axis);
    assert!(
        a.dot(b).abs() < 1e-15 && a.dot(axis).abs() < 1e-15 && (b.length() - 1.0).abs() < 1e-15
    );
    for p in &points {
        let at = light(DVec3::ONE, 0.5, DVec3::ZERO, *p) - DVec3::ONE;
        assert!(at.length() <= 0.5 + 1e-12 && at.dot(DVec3::ONE).abs() < 1e-12);
    }
    assert_eq!(disc([0.5, 0.5]), DVec2::ZERO);
    assert!(light(DVec3::ONE, 0.5, DVec3::ONE, [0.1, 0.2]).is_finite());
}

/// Rays of a lens meet in the plane of focus, and elsewhere fill the circle of confusion.
#[test]
fn lens_focuses() {
    let (eye, aperture, focus) = (DVec3::new(1.0, 2.0, 3.0), 0.3, 7.0);
    let axes = [DVec3::X, DVec3::Y, -DVec3::Z];
    let pinhole = DVec3::new(0.2, -0.3, -1.0).normalize();
    let target = eye + pinhole * (focus / -pinhole.z);
    for z in [2.0, 5.0, 7.0, 20.0] {
        // A point at depth z, seen through all of the lens, lands on the plane of focus within a
        // circle; here from the other end: where the rays towards one point of focus pass the depth
        // z.
        let mut widest = 0.0_f64;
        for i in 0..512 {
            let (origin, way) = lens(
                eye,
                pinhole,
                axes,
                aperture,
                focus,
                sample([0, 0], i, Purpose::Lens),
            );
            let reach = (target - origin).length();
            assert!((origin + way * reach - target).length() < 1e-12);
            let at = origin + way * ((z - (eye.z - origin.z)) / -way.z);
            let middle = eye + pinhole * (z / -pinhole.z);
            widest = widest.max((at - middle).length());
        }
        let want = aperture * (focus - z).abs() / focus;
        assert!(
            (widest - want).abs() < 0.02 * want + 1e-9,
            "{widest} instead of {want}"
        );
    }
    assert_eq!(
        lens(eye, pinhole, axes, 0.0, focus, [0.3, 0.9]),
        (eye, pinhole)
    );
    assert_eq!(
        lens(eye, pinhole, axes, 0.3, f64::INFINITY, [0.3, 0.9]),
        (eye, pinhole)
    );
}

/// The first 2ᵏ samples of a pixel have one in each box of every shape of area 2⁻ᵏ.
#[test]
fn samples_are_stratified() {
    for (pixel, purpose) in [
        ([0, 0], Purpose::Pixel),
        ([17, 4], Purpose::Lens),
        ([900, 700], Purpose::Light(5)),
        ([3, 3], Purpose::Sky),
    ] {
        for k in 0..=8_u32 {
            let points: Vec<_> = (0..1 << k).map(|i| sample(pixel, i, purpose)).collect();
            for a in 0..=k {
                let (nx, ny) = (1_usize << a, 1_usize << (k - a));
                let mut seen = vec![false; nx * ny];
                for p in &points {
                    let (x, y) = ((p[0] * nx as f64) as usize, (p[1] * ny as f64) as usize);
                    assert!(
                        !std::mem::replace(&mut seen[y * nx + x], true),
                        "{pixel:?}, {nx}×{ny}"
                    );
                }
            }
        }
    }
}

#[test]
fn samples_spread_better_than_chance() {
    let mut random = Random::new(52);
    for count in [16_u32, 61, 256] {
        let (mut ours, mut chance) = (0.0, 0.0);
        for pixel in 0..8 {
            let points: Vec<_> = (0..count)
                .map(|i| sample([pixel, 2], i, Purpose::Pixel))
                .collect();
            ours += discrepancy(&points);
            let points: Vec<_> = (0..count).map(|_| [random.unit(), random.unit()]).collect();
            chance += discrepancy(&points);
        }
        assert!(ours < 0.6 * chance, "{count}: {ours} and {chance}");
    }
}

/// First samples of neighbouring pixels, and of purposes in one pixel, have nothing to do with each
/// other.
#[test]
fn samples_of_pixels_and_purposes_are_independent() {
    fn correlation(f: impl Fn(u32) -> (f64, f64)) -> f64 {
        let count = 4_000_u32;
        let products = (0..count).map(|i| {
            let (a, b) = f(i);
            (a - 0.5) * (b - 0.5)
        });
        products.sum::<f64>() / f64::from(count) * 12.0
    }
    fn first(x: u32, y: u32, purpose: Purpose) -> [f64; 2] {
        sample([x, y], 0, purpose)
    }
    for (name, got) in [
        (
            "pixels beside",
            correlation(|i| {
                (
                    first(i % 64, i / 64, Purpose::Pixel)[0],
                    first(i % 64 + 1, i / 64, Purpose::Pixel)[0],
                )
            }),
        ),
        (
            "pixels above",
            correlation(|i| {
                (
                    first(i % 64, i / 64, Purpose::Pixel)[1],
                    first(i % 64, i / 64 + 1, Purpose::Pixel)[1],
                )
            }),
        ),
        (
            "purposes",
            correlation(|i| (first(i, 3, Purpose::Lens)[0], first(i, 3, Purpose::Time)[0])),
        ),
        (
            "dimensions",
            correlation(|i| {
                let s = first(i, 7, Purpose::Sky);
                (s[0], s[1])
            }),
        ),
        (
            "samples of one pixel",
            correlation(|i| {
                (
                    sample([8, 8], i, Purpose::Lens)[0],
                    sample([8, 8], i, Purpose::Light(0))[0],
                )
            }),
        ),
    ] {
        assert!(got.abs() < 0.06, "{name}: {got}");
    }
    assert_ne!(
        sample([1, 2], 0, Purpose::Pixel),
        sample([2, 1], 0, Purpose::Pixel)
    );
    for number in [u32::MAX, u32::MAX - 1, 1 << 31] {
        assert!(
            sample([u32::MAX; 2], number, Purpose::Sky)
                .iter()
                .all(|x| (0.0..1.0).contains(x))
        );
    }
}

/// Fog against Simpson's rule, up, down, along, from below and above.
#[test]
fn fog_matches_quadrature() {
    let mut random = Random::new(53);
    for case in 0..count(400) {
        let fog = Fog {
            distance: random.range(0.5, 9.0),
            height: Some(random.range(0.2, 4.0)),
        };
        let origin = random.vector(5.0);
        let way = if case % 5 == 0 {
            DVec3::X
        } else {
            random.direction()
        };
        let length = random.range(0.0, 20.0);
        let steps = 2_000;
        let h = length / f64::from(steps);
        let sum: f64 = (0..=steps)
            .map(|i| {
                let weight = if i == 0 || i == steps {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                let y = (origin + f64::from(i) * h * way).y / fog.height.unwrap();
                weight * if y <= 0.0 { 1.0 } else { libm::exp(-y) }
            })
            .sum();
        let want = libm::exp(-sum * h / 3.0 / fog.distance);
        let got = fog.passes(origin, way, length);
        assert!(
            (got - want).abs() < 2e-5,
            "{got} instead of {want}: {fog:?} {origin} {way} {length}"
        );
    }
    let even = Fog {
        distance: 4.0,
        height: None,
    };
    assert!((even.passes(DVec3::ZERO, DVec3::Y, 8.0) - libm::exp(-2.0)).abs() < 1e-15);
    // Two parts of a way pass what the whole does.
    let fog = Fog {
        distance: 2.0,
        height: Some(0.7),
    };
    let (o, d) = (DVec3::new(0.0, -1.0, 0.0), DVec3::new(0.6, 0.8, 0.0));
    let parts = fog.passes(o, d, 2.0) * fog.passes(o + 2.0 * d, d, 3.0);
    assert!((parts - fog.passes(o, d, 5.0)).abs() < 1e-14);
    // To the sky.
    assert_eq!(fog.passes(DVec3::ZERO, DVec3::X, f64::INFINITY), 0.0);
    assert!((fog.passes(DVec3::ZERO, DVec3::Y, f64::INFINITY) - libm::exp(-0.35)).abs() < 1e-14);
    assert_eq!(fog.passes(DVec3::Y, -DVec3::Y, f64::INFINITY), 0.0);
    assert!((fog.passes(1e6 * DVec3::Y, -DVec3::Y, 1e6) - libm::exp(-0.35)).abs() < 1e-12);
    for x in ODD {
        for y in ODD {
            for length in ODD {
                let passes = Fog {
                    distance: x,
                    height: Some(y),
                }
                .passes(DVec3::new(0.0, x, 0.0), DVec3::new(0.0, y, 0.0), length);
                assert!((0.0..=1.0).contains(&passes), "{x} {y} {length}: {passes}");
            }
        }
    }
    let veil = even.veil(Vec3::ONE, Vec3::ZERO, DVec3::ZERO, DVec3::X, 4.0);
    assert!((veil.x - (1.0 - libm::expf(-1.0))).abs() < 1e-6);
}

#[test]
fn film_keeps_shadows_and_bends_lights() {
    let mut before = 0.0;
    for i in 1..4_000 {
        let x = i as f32 * 0.005;
        let got = filmic(Vec3::splat(x)).x;
        assert!(got > before && got < 1.0, "{x}");
        assert!(got - before <= 0.005_001, "never steeper than 1");
        if x <= 0.6 {
            assert_eq!(got, x);
        }
        before = got;
    }
    assert_eq!(
        filmic(Vec3::new(f32::NAN, -1.0, f32::INFINITY)),
        Vec3::new(0.0, 0.0, 1.0)
    );
}
