//! Fields that are cut at planes.

use field::sliced::{Plane, Sliced};
use field::{Ball, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use trials::skeletons::shaping;
use trials::{Random, count};
use wide::f32x8;

/// Returns a limb of two bones, planes that cut it, and a steepness.
fn cut(random: &mut Random, kernel: Kernel) -> (Sum, Vec<Plane>, f64) {
    let [a, b, c] = [0, 1, 2].map(|_| random.vector(1.0));
    let limbs = [(a, b), (b, c)].into_iter().filter_map(|(base, apex)| {
        let shaping = Shaping {
            kernel,
            ..shaping(0.3, 4.0)
        };
        Primitive::new(Skeleton::Segment { base, apex }, &shaping, None)
    });
    let sum = limbs.collect();
    let planes = (0..1 + random.below(2)).map(|_| Plane {
        at: random.vector(0.5),
        inward: random.direction(),
    });
    (sum, planes.collect(), random.range(2.0, 60.0))
}

const KERNELS: [Kernel; 4] = [
    Kernel::Compact6,
    Kernel::Quartic,
    Kernel::Gauss,
    Kernel::Cauchy,
];

#[test]
fn a_cut_field_is_its_definition() {
    let mut random = Random::new(61);
    for kernel in KERNELS {
        for _ in 0..count(20) {
            let (sum, planes, steepness) = cut(&mut random, kernel);
            let sliced = Sliced::new(sum.clone(), planes.clone(), steepness).expect("usable");
            for _ in 0..50 {
                let place = random.vector(1.4);
                let depths = planes.iter().map(|p| p.inward.dot(place - p.at));
                let depth = depths.fold(f64::INFINITY, f64::min);
                let cap = (THRESHOLD * (1.0 + steepness * depth)).max(0.0);
                let wanted = sum.jet(place).value.min(cap);
                let jet = sliced.jet(place);
                assert!(
                    (jet.value - wanted).abs() < 1e-12 * (1.0 + wanted),
                    "{place}"
                );
                let narrow = place.to_array().map(|x| x as f32);
                let single = f64::from(sliced.jet32(narrow).value);
                let eight = sliced.jet8(narrow.map(f32x8::splat)).value.to_array()[3];
                for other in [single, f64::from(eight)] {
                    assert!(
                        (other - wanted).abs() < 2e-4 * (1.0 + wanted),
                        "{other} {wanted}"
                    );
                }
                // The gradient, where it does not jump.
                let h = 1e-6;
                for (axis, own) in DVec3::AXES.into_iter().zip(jet.gradient) {
                    let [left, right] = [-h, h].map(|step| sliced.jet(place + axis * step).value);
                    let [before, behind] = [jet.value - left, right - jet.value];
                    if (before - behind).abs() < 1e-9 * (1.0 + steepness) {
                        let slope = (right - left) / (2.0 * h);
                        assert!(
                            (slope - own).abs() < 1e-3 * (1.0 + own.abs()),
                            "{slope} {own}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn bounds_hold_in_balls() {
    let mut random = Random::new(62);
    for kernel in KERNELS {
        for _ in 0..count(60) {
            let (sum, planes, steepness) = cut(&mut random, kernel);
            let sliced = Sliced::new(sum, planes, steepness).expect("usable");
            let ball = Ball {
                center: random.vector(1.2),
                radius: random.range(0.001, 0.5),
            };
            let bounds = sliced.enclose(ball);
            let most = sliced.most(ball);
            let mut last: Option<(DVec3, f64)> = None;
            for _ in 0..40 {
                let place = ball.center + random.vector(1.0).clamp_length_max(1.0) * ball.radius;
                let jet = sliced.jet(place);
                let slack = 1e-9 * (1.0 + jet.value.abs());
                assert!(jet.value >= bounds.value[0] - slack, "{jet:?} {bounds:?}");
                assert!(jet.value <= bounds.value[1] + slack, "{jet:?} {bounds:?}");
                assert!(jet.value <= most + slack);
                let slope = DVec3::from_array(jet.gradient).length();
                assert!(
                    slope <= bounds.slope + 1e-6 * (1.0 + slope),
                    "{slope} {bounds:?}"
                );
                if let Some((before, value)) = last {
                    let change = (jet.value - value).abs();
                    assert!(change <= bounds.slope * before.distance(place) + slack);
                }
                last = Some((place, jet.value));
            }
            if let Some(support) = sliced.support() {
                let far = support.center + random.direction() * (support.radius * 1.001 + 1e-9);
                assert!(sliced.jet(far).value < THRESHOLD);
            }
        }
    }
}

#[test]
fn planes_that_are_none_are_refused() {
    for (inward, steepness) in [
        (None, 1.0),
        (Some(DVec3::ZERO), 1.0),
        (Some(DVec3::NAN), 1.0),
        (Some(DVec3::X), 0.0),
        (Some(DVec3::X), f64::NAN),
    ] {
        let at = DVec3::ZERO;
        let planes = inward.into_iter().map(|inward| Plane { at, inward });
        assert!(Sliced::new(Sum::default(), planes.collect(), steepness).is_none());
    }
}
