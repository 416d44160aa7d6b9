//! Bodies in contact: against the formulas, and what they promise of surfaces.

use contact::{Bulge, Squashed};
use field::{
    Ball, BlobScale, Exponentials, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD,
};
use glam::DVec3;
use std::sync::Arc;
use trials::{Random, count};
use wide::f32x8;

/// Returns a limb of two segments, or some balls.
fn body(random: &mut Random) -> Arc<dyn Implicit> {
    if random.chance(0.3) {
        let hardness = random.range(3.0, 5.0);
        let balls = (0..2).map(|_| (0.5 * random.vector(1.0), random.range(0.3, 0.5)));
        let balls = Exponentials::new(hardness, balls.collect());
        return Arc::new(balls.expect("the numbers are usable"));
    }
    let shaping = Shaping {
        kernel: random.pick(&[Kernel::Cubed, Kernel::Cauchy, Kernel::Gauss]),
        radius: random.range(0.25, 0.45),
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let [a, b, c] = [0; 3].map(|_| 0.7 * random.vector(1.0));
    let segments = [(a, b), (b, c)].into_iter();
    let primitives = segments.filter_map(|(base, apex)| {
        Primitive::new(Skeleton::Segment { base, apex }, &shaping, None)
    });
    Arc::new(primitives.collect::<Sum>())
}

fn bulge(random: &mut Random) -> Bulge {
    let c = random.range(0.1, 0.5);
    match random.below(3) {
        0 => Bulge::Fast { c },
        1 => Bulge::Height {
            c,
            m: 0.7,
            h: 0.3 * random.unit(),
        },
        _ => Bulge::Ripple {
            c,
            h: 0.3 * random.unit(),
            n: 2,
        },
    }
}

/// Returns some bodies, and each as all the others press it, with one bulge for all.
fn crowd(seed: u64, size: usize) -> (Vec<Arc<dyn Implicit>>, Vec<Squashed>, Bulge) {
    let random = &mut Random::new(seed);
    let bodies: Vec<_> = (0..size).map(|_| body(random)).collect();
    let bulge = bulge(random);
    let squashed = (0..size).map(|i| {
        let others = (0..size).filter(|j| *j != i);
        let others = others.map(|j| (bodies[j].clone(), bulge)).collect();
        Squashed::new(bodies[i].clone(), others)
    });
    (bodies.clone(), squashed.collect(), bulge)
}

/// The largest field of all bodies but one.
fn largest(bodies: &[Arc<dyn Implicit>], but: usize, point: DVec3) -> f64 {
    let others = bodies.iter().enumerate().filter(|(j, _)| *j != but);
    let values = others.map(|(_, body)| body.jet(point).value);
    values.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn it_is_the_formula() {
    for seed in 0..count(40) as u64 {
        let (bodies, squashed, bulge) = crowd(seed, 2 + seed as usize % 3);
        let random = &mut Random::new(seed + 1000);
        for _ in 0..100 {
            let point = 1.2 * random.vector(1.0);
            for (i, touching) in squashed.iter().enumerate() {
                let other = largest(&bodies, i, point);
                let want = bodies[i].jet(point).value + bulge.jet(other).0;
                let value = touching.jet(point).value;
                assert!(
                    (value - want).abs() <= 1e-12 * (1.0 + want.abs() + other),
                    "{seed}"
                );
            }
        }
    }
}

#[test]
fn bodies_share_space_without_gap_or_overlap() {
    let (mut together, mut boundary) = (0, 0);
    for seed in 0..count(40) as u64 {
        let (bodies, squashed, _) = crowd(seed, 2 + seed as usize % 3);
        let random = &mut Random::new(seed + 2000);
        for _ in 0..300 {
            let point = 0.8 * random.vector(1.0);
            let fields: Vec<f64> = bodies.iter().map(|body| body.jet(point).value).collect();
            let inside = fields.iter().filter(|f| **f > THRESHOLD).count();
            if inside < 2 {
                continue;
            }
            together += 1;
            // Where bodies overlapped, the one with the largest field has the place, and the others
            // none of it.
            let most = fields.iter().copied().fold(0.0, f64::max);
            for (field, touching) in fields.iter().zip(&squashed) {
                let value = touching.jet(point).value;
                let slack = 1e-12 * (1.0 + most);
                match *field == most {
                    true => assert!(value >= THRESHOLD - slack, "{seed}"),
                    false => assert!(value <= THRESHOLD + slack, "{seed}"),
                }
            }
        }
        // On the sheet both surfaces are at the same place.
        let [a, b] = [&bodies[0], &bodies[1]];
        for _ in 0..30 {
            let (mut p, mut q) = (0.7 * random.vector(1.0), 0.7 * random.vector(1.0));
            let ahead = |p: DVec3| a.jet(p).value - b.jet(p).value;
            if ahead(p) * ahead(q) > 0.0 {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (p + q);
                if ahead(p) * ahead(middle) <= 0.0 {
                    q = middle;
                } else {
                    p = middle;
                }
            }
            let fields = [a.jet(p).value, b.jet(p).value];
            if fields[0] < THRESHOLD || largest(&bodies[2..], usize::MAX, p) > fields[0] {
                continue;
            }
            boundary += 1;
            for touching in &squashed[..2] {
                let value = touching.jet(p).value;
                assert!(
                    (value - THRESHOLD).abs() < 1e-9 * (1.0 + fields[0]),
                    "{seed} {value}"
                );
            }
        }
    }
    assert!(
        together > count(500) && boundary > count(60),
        "{together} {boundary}"
    );
}

/// The gradient is continuous where the other's field is c and where it is T, so that the surface's
/// tangent is.
#[test]
fn tangents_are_continuous() {
    let mut looked = 0;
    for seed in 0..count(60) as u64 {
        let (bodies, squashed, bulge) = crowd(seed, 2);
        let random = &mut Random::new(seed + 3000);
        for level in [bulge.start(), THRESHOLD] {
            for _ in 0..10 {
                let (mut p, mut q) = (1.2 * random.vector(1.0), 1.2 * random.vector(1.0));
                let over = |p: DVec3| bodies[1].jet(p).value - level;
                if over(p) * over(q) > 0.0 {
                    continue;
                }
                for _ in 0..60 {
                    let middle = 0.5 * (p + q);
                    if over(p) * over(middle) <= 0.0 {
                        q = middle;
                    } else {
                        p = middle;
                    }
                }
                let normal = DVec3::from_array(bodies[1].jet(p).gradient).normalize_or_zero();
                // The body's own gradient is continuous, and steep next to its skeleton.
                let gradient = |s: f64| {
                    let [all, own] = [
                        squashed[0].jet(p + s * normal),
                        bodies[0].jet(p + s * normal),
                    ];
                    DVec3::from_array(all.gradient) - DVec3::from_array(own.gradient)
                };
                let steep = DVec3::from_array(bodies[1].jet(p).gradient).length();
                let jump = gradient(1e-8).distance(gradient(-1e-8));
                // Second derivatives are some hundreds at most.
                assert!(jump < 1e-4 * (1.0 + steep * steep), "{seed} {level} {jump}");
                looked += 1;
            }
        }
    }
    assert!(looked > count(100), "{looked}");
}

#[test]
fn all_precisions_agree() {
    for seed in 0..count(20) as u64 {
        let (_, squashed, _) = crowd(seed, 3);
        let random = &mut Random::new(seed + 4000);
        let points: [DVec3; 8] = core::array::from_fn(|_| 1.2 * random.vector(1.0));
        let lanes = [0, 1, 2].map(|k| f32x8::new(points.map(|p| p[k] as f32)));
        for touching in &squashed {
            let eight = touching.jet8(lanes);
            for (i, point) in points.into_iter().enumerate() {
                let double = touching.jet(point);
                let single = touching.jet32(point.as_vec3().to_array());
                let scale = 1.0 + double.value.abs();
                assert!(
                    (double.value - f64::from(single.value)).abs() < 1e-3 * scale,
                    "{seed}"
                );
                assert_eq!(single.value, eight.value.to_array()[i]);
            }
        }
    }
}

#[test]
fn enclosures_hold() {
    let (mut narrow, mut smooth) = (0, 0);
    for seed in 0..count(40) as u64 {
        let (_, squashed, _) = crowd(seed, 2 + seed as usize % 2);
        let random = &mut Random::new(seed + 5000);
        for _ in 0..20 {
            let center = 1.2 * random.vector(1.0);
            let radius = random.decades(-4.0, 0.0);
            let touching = &squashed[0];
            let bounds = touching.enclose(Ball { center, radius });
            narrow += usize::from(bounds.value[0] > THRESHOLD || bounds.value[1] < THRESHOLD);
            smooth += usize::from(bounds.curvature.is_finite());
            for _ in 0..30 {
                let offset = radius * random.vector(1.0) / 3.0_f64.sqrt();
                let point = center + offset;
                let jet = touching.jet(point);
                let slack = 1e-11 * (1.0 + jet.value.abs());
                assert!(jet.value >= bounds.value[0] - slack, "{seed}");
                assert!(jet.value <= bounds.value[1] + slack, "{seed}");
                let gradient = DVec3::from_array(jet.gradient);
                assert!(gradient.length() <= bounds.slope * (1.0 + 1e-9), "{seed}");
                let along = random.direction();
                let step = (1e-4 * radius).min(0.5 * (radius - offset.length()));
                let slope =
                    |s: f64| DVec3::from_array(touching.jet(point + along * s).gradient).dot(along);
                let bend = (slope(step) - slope(-step)).abs() / (2.0 * step);
                assert!(
                    bend <= bounds.curvature * (1.0 + 1e-3) + 1e-2,
                    "{seed}: {bend} {bounds:?}"
                );
            }
        }
    }
    assert!(
        narrow > count(200) && smooth > count(60),
        "{narrow} {smooth}"
    );
}

/// Differences of gradients, once and twice, keep within the bounds on the second and the third
/// derivative, and on what is rough.
#[test]
fn variations_hold() {
    let (mut alone, mut tight) = (0, 0.0_f64);
    for seed in 0..count(40) as u64 {
        let (bodies, squashed, _) = crowd(seed, 2 + seed as usize % 2);
        let random = &mut Random::new(seed + 7000);
        for _ in 0..40 {
            let center = 0.8 * random.vector(1.0);
            let radius = random.decades(-3.0, -1.0);
            let ball = Ball { center, radius };
            let bounds = squashed[0].variation(None, ball);
            if !(bounds.curvature.is_finite() && bounds.step == 0.0) {
                continue;
            }
            let own = bodies[0].variation(None, ball);
            // A bulge that is known to be smooth.
            let is_alone = bounds.third > own.third && bounds.rough == own.rough;
            alone += usize::from(is_alone);
            for _ in 0..20 {
                let along = random.direction();
                let length = radius * random.decades(-2.0, -0.7);
                let middle = center + random.direction() * ((radius - length) * random.unit());
                let [before, here, after] = [-length, 0.0, length].map(|s| {
                    let jet = squashed[0].jet(middle + along * s);
                    DVec3::from_array(jet.gradient)
                });
                let slack = 1e-9 * (1.0 + before.length() + after.length());
                let second = (after - before).length();
                let most = 2.0 * bounds.curvature * length + bounds.jump;
                assert!(second <= most + slack, "{seed} {second} {bounds:?}");
                let third = (after - here * 2.0 + before).length();
                let rough = 2.0 * (bounds.rough * length + bounds.jump);
                let most = bounds.third * length * length + rough;
                assert!(third <= most + slack, "{seed} {third} {bounds:?}");
                if is_alone {
                    tight = tight.max(third / most);
                }
            }
        }
    }
    assert!(alone > count(60) && tight > 0.2, "{alone} {tight}");
}

#[test]
fn outside_the_support_is_nothing() {
    let mut inside = 0;
    for seed in 0..count(20) as u64 {
        let (_, squashed, _) = crowd(seed, 2);
        let random = &mut Random::new(seed + 6000);
        let Some(ball) = squashed[0].support() else {
            continue;
        };
        for _ in 0..300 {
            let point = ball.center + ball.radius * 1.5 * random.unit() * random.vector(1.0);
            let above = squashed[0].jet(point).value > THRESHOLD;
            assert!(
                !above || point.distance(ball.center) <= ball.radius,
                "{seed}"
            );
            inside += usize::from(above);
        }
    }
    assert!(inside > count(100), "{inside}");
}
