//! Checks of a kernel on bones whose radius and blobbiness vary along them: against adaptive
//! quadrature, against differences, and against what a taper promises.
//!
//! Each panics where a kernel, as it is evaluated, does not hold.

use crate::evaluation::{
    Evaluation, assert_near, evaluate_alike, jet, peak, primitive, sensitivity, single,
};
use crate::quadrature;
use field::bound::Bound;
use field::shaping::SLIMMEST;
use field::{Kernel, Primitive, Shaping, Skeleton, THRESHOLD, Taper};
use glam::{DQuat, DVec3};
use trials::skeletons::{Kind, LINES, halves, move_by, shaping};
use trials::{Random, count};
use wide::f32x8;

/// Returns a shaping of radius 1 at the start and anything from a tip to three times that at the
/// end.
fn taper(random: &mut Random, kernel: Kernel) -> Shaping {
    let (any, slim) = (random.decades(-1.0, 0.5), random.decades(-3.0, 0.0));
    let radius = random.pick(&[any, any, slim, 0.0]);
    let shaping = random.shaping(1.0);
    let other = random.decades(-1.0, 1.0);
    let blobbiness = random.pick(&[shaping.blobbiness, shaping.blobbiness, other]);
    Shaping {
        kernel,
        taper: Some(Taper { radius, blobbiness }),
        ..shaping
    }
}

/// Returns a random tapered bone, of at least these decades of its radius.
fn random_primitive(random: &mut Random, kernel: Kernel, kind: Kind, low: f64) -> Primitive {
    let size = random.decades(low, 1.0);
    let skeleton = random.skeleton(kind, size);
    primitive(skeleton, &taper(random, kernel), None)
}

/// Checks that values are those of quadrature, to 10⁻⁹ (metaballs 10⁻⁸).
pub fn matches_quadrature(kernel: Kernel, evaluate: Evaluation<'_>) {
    for kind in LINES {
        let mut random = Random::new(401);
        for _ in 0..count(80) {
            let primitive = random_primitive(&mut random, kernel, kind, -2.0);
            let far = random.pick(&[0.3, 0.3, 2.0]);
            let point = random.near(&primitive.skeleton, -4.0, far);
            let want = quadrature::value(&primitive, point);
            let (value, gradient) = evaluate(&primitive, point);
            // The width of metaballs has a kink where |B| passes ½ (Shaping::width), which the
            // spans only close in on.
            let relative = if kernel == Kernel::Metaballs {
                1e-8
            } else {
                1e-9
            };
            let mut tolerance = relative * want.abs()
                + 1e-13 * peak(&primitive)
                + 64.0 * f64::EPSILON * sensitivity(&primitive, point);
            if let Skeleton::Arc { radius, .. } = primitive.skeleton {
                // The circle made of cubics is that much larger.
                tolerance += 2.5e-13 * radius * gradient.length();
            }
            assert_near(value, want, tolerance, &primitive, point);
            assert!(gradient.is_finite());
        }
    }
}

/// Checks that two forms in single precision have the same bits, and are `field`'s double form to
/// 10⁻⁵.
pub fn single_matches_double(kernel: Kernel, forms: [Evaluation<'_>; 2]) {
    for kind in LINES {
        let mut random = Random::new(402);
        for _ in 0..count(150) {
            let primitive = random_primitive(&mut random, kernel, kind, -2.0);
            for _ in 0..3 {
                let point = single(random.near(&primitive.skeleton, -3.0, 1.0));
                let (want, want_gradient) = jet::<f64>(&primitive, point);
                let (value, gradient) = evaluate_alike(forms, &primitive, point);
                // 32 units in the last place of the input, like on the chart.
                let slack = 32.0 * f64::from(f32::EPSILON) * sensitivity(&primitive, point);
                let distance = primitive.skeleton.distance(point);
                // Next to a pole it counts that the ends of spans are rounded: a gap or an overlap
                // of 10⁻⁸ widths, where the squared kernel is 10¹⁰ high and its field 10⁵, and the
                // cubed one 10¹⁵ and 10¹⁰.
                let relative = match kernel {
                    Kernel::Cubed if distance < 1e-3 => 1e-3,
                    _ if kernel.has_pole() && distance < 1e-3 => 3e-4,
                    _ => 1e-5,
                };
                let tolerance = relative * want.abs() + 2e-6 * peak(&primitive) + slack;
                assert_near(value, want, tolerance, &primitive, point);
                if kernel.has_pole() && distance < 1e-3 {
                    // A rounding of the coordinates turns the gradient here.
                    continue;
                }
                let near = (primitive.width * distance).max(1e-3);
                let slopes = primitive.width * (1.0 + 1.0 / near);
                let tolerance = 30.0 * (tolerance * slopes + 1e-5 * want_gradient.length());
                let error = (gradient - want_gradient).length();
                assert!(
                    error <= tolerance,
                    "{gradient} instead of {want_gradient} \
                     (off by {error:e}, at most {tolerance:e}): {:?} {:?} at {point:?}",
                    primitive.skeleton,
                    primitive.tapered
                );
            }
        }
    }
}

/// Checks that gradients are differences of values.
pub fn gradient_is_the_derivative(kernel: Kernel, evaluate: Evaluation<'_>) {
    for kind in LINES {
        let mut random = Random::new(403);
        for _ in 0..count(60) {
            let primitive = random_primitive(&mut random, kernel, kind, -1.0);
            let point = random.near(&primitive.skeleton, -2.0, 0.5);
            let u = primitive.width * primitive.skeleton.distance(point);
            if kernel.has_pole() && u < 0.05 || kernel == Kernel::Metaballs && u < 0.01 {
                continue;
            }
            let (_, gradient) = evaluate(&primitive, point);
            let h = 1e-5 / primitive.width;
            for axis in 0..3 {
                let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|step| {
                    let mut p = point;
                    p[axis] += step * h;
                    evaluate(&primitive, p).0
                });
                let slope = (8.0 * (a - b) - (c - d)) / (12.0 * h);
                let scale = primitive.most_beyond(primitive.skeleton.distance(point));
                // Rounding over h; where a clip passes a kink of the kernel, h² times a jump.
                let tolerance = 1e-6 * gradient.length()
                    + 1e-7 * scale * primitive.width
                    + 1e-13 * (1.0 + point.length() / h) * gradient.length();
                assert!(
                    (slope - gradient[axis]).abs() <= tolerance,
                    "{slope} instead of {}: {:?} {:?} at {point:?}",
                    gradient[axis],
                    primitive.skeleton,
                    primitive.tapered
                );
            }
        }
    }
}

/// Returns the parts of a bone before and after a fraction of its length.
fn parts(skeleton: &Skeleton, fraction: f64) -> [Skeleton; 2] {
    let mut at = fraction;
    if !matches!(skeleton, Skeleton::Segment { .. } | Skeleton::Arc { .. }) {
        let whole = skeleton.measure();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let first = halves(skeleton, middle).map(|[first, _]| first.measure());
            if first.is_some_and(|length| length < fraction * whole) {
                low = middle;
            } else {
                high = middle;
            }
        }
        at = low;
    }
    halves(skeleton, at).expect("a bone")
}

/// Checks that a bone cut in two, with the radius and blobbiness that it has there, is the same
/// field.
pub fn superposition(kernel: Kernel, evaluate: Evaluation<'_>) {
    for kind in LINES {
        let mut random = Random::new(404);
        for _ in 0..count(60) {
            let size = random.decades(-1.0, 1.0);
            let skeleton = random.skeleton(kind, size);
            let mut shaping = taper(&mut random, kernel);
            if let Some(end) = &mut shaping.taper {
                end.radius = end.radius.max(0.01);
            }
            let fraction = random.range(0.1, 0.9);
            let cut = shaping.at(fraction);
            let before = Shaping {
                taper: Some(Taper {
                    radius: cut.radius,
                    blobbiness: cut.blobbiness,
                }),
                ..shaping
            };
            let after = Shaping {
                taper: shaping.taper,
                ..cut
            };
            let [first, second] = parts(&skeleton, fraction);
            let whole = primitive(skeleton, &shaping, None);
            let parts = [
                primitive(first, &before, None),
                primitive(second, &after, None),
            ];
            for _ in 0..4 {
                let point = random.near(&whole.skeleton, -2.0, 0.5);
                let (value, gradient) = evaluate(&whole, point);
                let sum: f64 = parts.iter().map(|part| evaluate(part, point).0).sum();
                let slopes: DVec3 = parts.iter().map(|part| evaluate(part, point).1).sum();
                // Corners of the parts are rounded anew.
                let slack = 64.0 * f64::EPSILON * sensitivity(&whole, point);
                let tolerance = 2e-9 * value.abs() + 1e-12 * peak(&whole) + slack;
                assert!(
                    (sum - value).abs() <= tolerance,
                    "{sum:e} instead of {value:e}: {:?} {shaping:?} at {point:?}",
                    whole.skeleton
                );
                let near = (whole.width * whole.skeleton.distance(point)).max(1e-4);
                let tolerance = 1e3 * (tolerance * whole.width / near + 1e-9 * gradient.length());
                assert!(
                    (slopes - gradient).length() <= tolerance,
                    "{slopes} instead of {gradient}: {:?} {shaping:?} at {point:?}",
                    whole.skeleton
                );
            }
        }
    }
}

/// Checks that a bone magnified with its radii has the same field at magnified places.
pub fn scale_invariance(kernel: Kernel, evaluate: Evaluation<'_>) {
    for kind in LINES {
        let mut random = Random::new(405);
        for _ in 0..count(40) {
            let size = random.decades(-1.0, 1.0);
            let skeleton = random.skeleton(kind, size);
            let shaping = taper(&mut random, kernel);
            let scale = random.decades(-2.0, 2.0);
            let larger = Shaping {
                radius: shaping.radius * scale,
                taper: shaping.taper.map(|end| Taper {
                    radius: end.radius * scale,
                    ..end
                }),
                ..shaping
            };
            let magnified = move_by(&skeleton, DQuat::IDENTITY, scale, DVec3::ZERO);
            let here = primitive(skeleton, &shaping, None);
            let there = primitive(magnified, &larger, None);
            let point = random.near(&here.skeleton, -2.0, 0.5);
            let value = evaluate(&here, point).0;
            let after = evaluate(&there, point * scale).0;
            let tolerance = 2e-9 * value.abs()
                + 1e-12 * peak(&here)
                + 64.0 * f64::EPSILON * sensitivity(&here, point);
            assert!(
                (after - value).abs() <= tolerance,
                "{after:e} instead of {value:e}: {here:?} at {point:?}"
            );
        }
    }
}

/// Returns the distance from the axis x at which the field is T.
fn surface(primitive: &Primitive, x: f64) -> f64 {
    let (mut low, mut high) = (1e-3, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if primitive.value([x, middle, 0.0]) > THRESHOLD {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Checks that a slender cone has the radius that is asked for, far from its ends.
pub fn cones_have_their_radius(kernel: Kernel) {
    // The inverse kernel's lines have the radius that their lengths give them.
    if !kernel.is_finite_over(1) {
        return;
    }
    for blobbiness in [0.5, 1.0, 3.0] {
        let cone = Shaping {
            kernel,
            taper: Some(Taper {
                radius: 0.3,
                blobbiness,
            }),
            ..shaping(1.0, blobbiness)
        };
        let length = 60.0;
        let bone = Skeleton::Segment {
            base: DVec3::ZERO,
            apex: DVec3::X * length,
        };
        let primitive = primitive(bone, &cone, None);
        for i in 3..=7 {
            let fraction = f64::from(i) / 10.0;
            let want = cone.at(fraction).radius;
            let found = surface(&primitive, fraction * length);
            // The ends are 18 to 42 away, where a squared kernel still has R/(π·18) of its field.
            let share = if kernel == Kernel::Squared {
                0.04
            } else {
                0.01
            };
            assert!(
                (found / want - 1.0).abs() < share,
                "{found} instead of {want} at {fraction}, blobbiness {blobbiness}"
            );
        }
    }
}

/// Checks that no field exceeds its bounds, at its distance or in a ball; none is above ε·T outside
/// its depth of influence, its sphere or its interval of a ray; none is outside a compact kernel's
/// support.
pub fn bounds_hold(kernel: Kernel) {
    for kind in LINES {
        let mut random = Random::new(406);
        for _ in 0..count(50) {
            let primitive = random_primitive(&mut random, kernel, kind, -1.5);
            let level = THRESHOLD * 1e-3;
            let bound = Bound::new(&primitive);
            let (center, radius) = primitive
                .bounding_sphere()
                .unwrap_or_else(|| unreachable!("bones have spheres"));
            for _ in 0..20 {
                let depth = random.decades(-2.0, 1.0);
                let spread = random.direction() * depth;
                let point = random.place(&primitive.skeleton) + spread;
                let distance = primitive.skeleton.distance(point);
                let value = jet::<f64>(&primitive, point).0.abs();
                let most = primitive.most_beyond(distance);
                assert!(
                    value <= most * (1.0 + 1e-9),
                    "{value} > {most}: {primitive:?} at {point:?}"
                );
                let most = bound.magnitude(bound.nearness(point, 0.0));
                assert!(
                    value <= most * (1.0 + 1e-6),
                    "{value} > {most}: {primitive:?} at {point:?}"
                );
                let outside = distance > primitive.influence || point.distance(center) > radius;
                if outside && primitive.influence > 0.0 {
                    assert!(
                        value <= level * (1.0 + 1e-9),
                        "{value} {primitive:?} {point:?}"
                    );
                    if kernel.is_compact() {
                        assert_eq!(value, 0.0, "{primitive:?} {point:?}");
                        assert_eq!(jet::<f32x8>(&primitive, point).0, 0.0);
                    }
                }
                let direction = random.direction();
                let interval = primitive.ray_interval(point, direction);
                assert!(
                    interval.is_some_and(|[a, b]| a <= 0.0 && 0.0 <= b)
                        || distance >= primitive.influence * (1.0 - 1e-9),
                    "{interval:?} {primitive:?} {point:?}"
                );
            }
        }
    }
}

/// Checks that tips of radius 0 are finite, cut at [`SLIMMEST`]; that a bone whose ends are equal
/// is no tapered one; and that there is no primitive of negative radii.
pub fn degenerate_tapers(kernel: Kernel) {
    let with = |start: f64, end: f64, blobbiness: f64| Shaping {
        kernel,
        taper: Some(Taper {
            radius: end,
            blobbiness,
        }),
        ..shaping(start, 1.0)
    };
    let bones = [
        Skeleton::Segment {
            base: DVec3::ZERO,
            apex: DVec3::X * 2.0,
        },
        Skeleton::Arc {
            center: DVec3::ZERO,
            u: DVec3::X,
            v: DVec3::Y,
            radius: 1.0,
            angle: core::f64::consts::TAU,
        },
        Skeleton::Curve {
            control: [
                DVec3::ZERO,
                DVec3::ZERO,
                DVec3::X,
                DVec3::new(2.0, 1.0, 0.0),
            ],
        },
    ];
    for bone in bones {
        for (start, end) in [(1.0, 0.0), (0.0, 1.0)] {
            let tip = primitive(bone.clone(), &with(start, end, 1.0), None);
            let same = with(start.max(SLIMMEST), end.max(SLIMMEST), 1.0);
            let same = primitive(bone.clone(), &same, None);
            for x in [0.0, 1.0, 2.0, 1.999, 0.001] {
                for y in [0.0, 1e-3, 0.5] {
                    let point = DVec3::new(x, y, 0.0);
                    let (value, gradient) = jet::<f64>(&tip, point);
                    assert!(
                        value.is_finite() && gradient.is_finite(),
                        "{bone:?} {point}"
                    );
                    assert_eq!(value, same.value(point.to_array()));
                    let (value, gradient) = jet::<f32x8>(&tip, point);
                    assert!(
                        value.is_finite() && gradient.is_finite(),
                        "{bone:?} {point}"
                    );
                }
            }
        }
        let even = primitive(bone.clone(), &with(1.0, 1.0, 1.0), None);
        assert!(even.tapered.is_none());
        for bad in [-0.5, f64::NAN, f64::INFINITY] {
            assert!(Primitive::new(bone.clone(), &with(1.0, bad, 1.0), None).is_none());
        }
        assert!(Primitive::new(bone.clone(), &with(0.0, 0.0, 1.0), None).is_none());
    }
    // A taper whose end nears its start nears none at all.
    let bone = Skeleton::Segment {
        base: DVec3::ZERO,
        apex: DVec3::X * 2.0,
    };
    let (even, nearly) = (with(1.0, 1.0, 1.0), with(1.0, 1.0 + 1e-10, 1.0));
    let [even, nearly] = [even, nearly].map(|s| primitive(bone.clone(), &s, None));
    for y in [0.1, 0.5, 0.8] {
        let (a, b) = (even.value([0.7, y, 0.0_f64]), nearly.value([0.7, y, 0.0]));
        assert!((a - b).abs() <= 1e-8 * a.abs(), "{a} {b}");
    }
    for length in [0.0, 1e-300, 1e-9] {
        let bone = Skeleton::Segment {
            base: DVec3::ZERO,
            apex: DVec3::X * length,
        };
        let short = primitive(bone, &with(1.0, 0.5, 1.0), None);
        let (value, gradient) = jet::<f64>(&short, DVec3::Y * 0.1);
        assert!(value.is_finite() && gradient.is_finite() && value <= 1e3 * length);
        let (value, gradient) = jet::<f32x8>(&short, DVec3::Y * 0.1);
        assert!(value.is_finite() && gradient.is_finite());
    }
    // A point has no taper.
    let point = Skeleton::Point {
        center: DVec3::ZERO,
    };
    assert!(
        primitive(point, &with(1.0, 0.5, 1.0), None)
            .tapered
            .is_none()
    );
}
