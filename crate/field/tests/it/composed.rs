//! Functions composed of others: sums, moved and stretched ones.

use field::{Ball, Blend, Exponentials, Implicit, Placed, Primitive, Skeleton, Sum, THRESHOLD};
use glam::{DAffine3, DMat3, DVec3};
use std::sync::Arc;
use trials::skeletons::shaping;
use trials::{Random, count};
use wide::f32x8;

/// Returns `count` random balls that melt together, with a random hardness.
fn balls(random: &mut Random, count: usize) -> Exponentials {
    let hardness = random.range(1.0, 9.0);
    let balls = (0..count).map(|_| (random.vector(1.0), random.range(0.1, 0.6)));
    Exponentials::new(hardness, balls.collect()).expect("the numbers are usable")
}

/// Returns a map that turns, mirrors, shears and stretches.
fn map(random: &mut Random) -> DAffine3 {
    let column = |random: &mut Random, axis: DVec3| axis + 0.4 * random.vector(1.0);
    let matrix = DMat3::from_cols(
        column(random, DVec3::X) * random.range(0.5, 2.0),
        column(random, DVec3::Y),
        column(random, DVec3::NEG_Z) * random.range(0.5, 2.0),
    );
    DAffine3::from_mat3_translation(matrix, random.vector(1.0))
}

/// Primitives, balls and stretched balls in one.
fn blend(seed: u64) -> Blend {
    let random = &mut Random::new(seed);
    let sum: Sum = (0..3)
        .filter_map(|_| {
            let skeleton = Skeleton::Segment {
                base: random.vector(1.0),
                apex: random.vector(1.0),
            };
            Primitive::new(skeleton, &shaping(0.2, 2.0), None)
        })
        .collect();
    let plain: Arc<dyn Implicit> = Arc::new(balls(random, 3));
    let inner = Arc::new(balls(random, 2));
    let placed = Placed::new(inner, map(random)).expect("the map has an inverse");
    Blend::new(sum, vec![(plain, 1), (Arc::new(placed), 1)])
}

#[test]
fn a_placed_function_is_the_inner_one_elsewhere() {
    for seed in 0..count(20) as u64 {
        let random = &mut Random::new(seed);
        let (inner, map) = (balls(random, 3), map(random));
        let placed = Placed::new(Arc::new(inner.clone()), map).expect("the map has an inverse");
        for _ in 0..20 {
            let point = 1.5 * random.vector(1.0);
            let [here, there] = [placed.jet(map.transform_point3(point)), inner.jet(point)];
            assert!((here.value - there.value).abs() < 1e-12 * (1.0 + there.value));
        }
    }
}

#[test]
fn a_ball_is_e_to_the_distance() {
    let ball = Exponentials::new(3.0, vec![(DVec3::X, 0.5)]).expect("the numbers are usable");
    let jet = ball.jet(DVec3::new(1.0, 2.0, 0.0));
    let want = libm::exp(-3.0 * 1.5);
    assert!((jet.value - want).abs() < 1e-15);
    assert!((jet.gradient[1] + 3.0 * want).abs() < 1e-14);
    assert_eq!([jet.gradient[0], jet.gradient[2]], [0.0; 2]);
    // The gradient has no direction at the centre.
    assert_eq!(ball.jet(DVec3::X).gradient, [0.0; 3]);
    for (hardness, radius) in [
        (0.0, 1.0),
        (-1.0, 1.0),
        (f64::NAN, 1.0),
        (8.0, 8.0),
        (1.0, -1.0),
    ] {
        assert!(Exponentials::new(hardness, vec![(DVec3::X, radius)]).is_none());
    }
    assert!(Exponentials::new(1.0, Vec::new()).is_none());
    assert!(Exponentials::new(1.0, vec![(DVec3::NAN, 0.1)]).is_none());
}

#[test]
fn gradients_are_differences() {
    for seed in 0..count(10) as u64 {
        let function = blend(seed);
        let random = &mut Random::new(seed + 100);
        for _ in 0..20 {
            let point = 1.5 * random.vector(1.0);
            let jet = function.jet(point);
            for (axis, slope) in DVec3::AXES.into_iter().zip(jet.gradient) {
                let value = |s: f64| function.jet(point + axis * s * 1e-6).value;
                let difference = (value(1.0) - value(-1.0)) / 2e-6;
                assert!(
                    (slope - difference).abs() < 1e-5 * (1.0 + slope.abs()),
                    "{seed}"
                );
            }
        }
    }
}

#[test]
fn all_precisions_agree() {
    for seed in 0..count(10) as u64 {
        let function = blend(seed);
        let random = &mut Random::new(seed + 200);
        let points: [DVec3; 8] = core::array::from_fn(|_| 1.5 * random.vector(1.0));
        let lanes = [0, 1, 2].map(|k| f32x8::new(points.map(|p| p[k] as f32)));
        let eight = function.jet8(lanes);
        for (i, point) in points.into_iter().enumerate() {
            let (double, single) = (
                function.jet(point),
                function.jet32(point.as_vec3().to_array()),
            );
            assert!((double.value - f64::from(single.value)).abs() < 3e-5 * (1.0 + double.value));
            assert_eq!(single.value, eight.value.to_array()[i]);
            for k in 0..3 {
                assert_eq!(single.gradient[k], eight.gradient[k].to_array()[i]);
            }
        }
    }
}

#[test]
fn enclosures_hold() {
    let mut narrow = 0;
    for seed in 0..count(40) as u64 {
        let function = blend(seed);
        let random = &mut Random::new(seed + 300);
        for _ in 0..10 {
            let (center, radius) = (1.5 * random.vector(1.0), random.decades(-4.0, 0.0));
            let bounds = function.enclose(Ball { center, radius });
            narrow += usize::from(bounds.value[0] > THRESHOLD || bounds.value[1] < THRESHOLD);
            for _ in 0..40 {
                let point = center + radius * random.vector(1.0) / 3.0_f64.sqrt();
                let jet = function.jet(point);
                let slack = 1e-12 * (1.0 + jet.value);
                assert!(
                    jet.value >= bounds.value[0] - slack && jet.value <= bounds.value[1] + slack
                );
                let gradient = DVec3::from_array(jet.gradient);
                assert!(gradient.length() <= bounds.slope * (1.0 + 1e-9));
                let along = random.vector(1.0).normalize();
                let step = (1e-4 * radius).min(radius - point.distance(center));
                let slope =
                    |s: f64| DVec3::from_array(function.jet(point + along * s).gradient).dot(along);
                let bend = (slope(step) - slope(-step)).abs() / (2.0 * step);
                assert!(
                    bend <= bounds.curvature * (1.0 + 1e-3) + 1e-3,
                    "{seed}: {bend} {bounds:?}"
                );
            }
        }
    }
    assert!(narrow > count(100), "{narrow}");
}

#[test]
fn outside_the_support_is_nothing() {
    let mut inside = 0;
    for seed in 0..count(20) as u64 {
        let function = blend(seed);
        let random = &mut Random::new(seed + 400);
        for level in [1.0, 0.3, 1e-3] {
            let ball = function.support_at(level).expect("it has an end");
            for _ in 0..300 {
                let size = random.pick(&[0.2, 0.5, 1.5]);
                let point = ball.center + size * ball.radius * random.vector(1.0);
                let above = function.jet(point).value > level;
                assert!(
                    !above || point.distance(ball.center) <= ball.radius,
                    "{seed} {level}"
                );
                inside += usize::from(above);
            }
        }
    }
    assert!(inside > count(300), "{inside}");
}

#[test]
fn shares_add_up_to_the_value() {
    for seed in 0..count(20) as u64 {
        let function = blend(seed);
        let mut shares = Vec::new();
        let point = Random::new(seed + 500).vector(1.0);
        function.shares(point, &mut shares);
        let numbers: Vec<u32> = shares.iter().map(|(element, _)| *element).collect();
        assert_eq!(numbers, [0, 1, 2, 3, 4]);
        let total: f64 = shares.iter().map(|(_, share)| share).sum();
        assert!((total - function.jet(point).value).abs() < 1e-12 * (1.0 + total));
    }
}

#[test]
fn degenerate_maps_are_refused() {
    let ball = Arc::new(balls(&mut Random::new(1), 1));
    for factor in [0.0, f64::NAN, f64::INFINITY, 1e-200] {
        let map = DAffine3::from_scale(DVec3::new(1.0, 1.0, factor));
        assert!(Placed::new(ball.clone(), map).is_none(), "{factor}");
    }
}
