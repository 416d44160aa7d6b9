//! Bounds on the logarithm of a sum of Gaussians against differences of values and gradients in
//! balls.

use field::{
    Ball, BlobScale, Implicit, Jet, Kernel, Logarithm, Primitive, Shaping, Skeleton, Slack, Sum,
    THRESHOLD, Variation,
};
use glam::DVec3;
use trials::{Random, count};

/// Returns a few points and segments, some much thinner than others and some in one place.
fn sum(random: &mut Random) -> Sum {
    let terms = 1 + random.below(7);
    (0..terms)
        .filter_map(|i| {
            let base = 0.5 * random.vector(1.0);
            let length = random.decades(-3.0, 0.5);
            let skeleton = if i % 2 == 0 {
                Skeleton::Point { center: base }
            } else {
                let apex = base + random.vector(1.0) * length;
                Skeleton::Segment { base, apex }
            };
            let shaping = Shaping {
                kernel: Kernel::Gauss,
                radius: random.decades(-1.7, -0.2),
                blobbiness: 0.5 + 3.0 * random.unit(),
                blob_scale: BlobScale::Relative,
                strength: 0.2 + random.unit(),
                influence: 1e-3,
                taper: None,
            };
            Primitive::new(skeleton, &shaping, None)
        })
        .collect()
}

fn jet(sum: &Sum, point: DVec3) -> Jet<f64> {
    Logarithm::of(&sum.jet(point))
}

/// Holds bounds in a ball against values and gradients at random points of it. Returns how near the
/// second and the third derivative came to their bounds.
fn check(sum: &Sum, ball: Ball, variation: &Variation, random: &mut Random) -> [f64; 2] {
    let Ball { center, radius } = ball;
    let mut nearest = [0.0_f64; 2];
    let gradient = |point: DVec3| DVec3::from_array(jet(sum, point).gradient);
    for _ in 0..20 {
        let direction = random.direction();
        let point = center + direction * radius * random.unit();
        let at = jet(sum, point);
        let [low, high] = variation.range.value;
        let doubt = 1e-9 * (1.0 + at.value.abs());
        assert!(
            low - doubt <= at.value && at.value <= high + doubt,
            "{at:?} {variation:?}"
        );
        let slope = gradient(point).length();
        let doubt = 1e-9 * slope;
        assert!(
            slope <= variation.range.slope + doubt,
            "{slope} {variation:?}"
        );
        let step = random.direction() * (1e-3 * radius);
        let inner = center + (point - center) * 0.99;
        let [before, here, after] = [inner - step, inner, inner + step].map(gradient);
        let length = step.length();
        let rounding = 1e-9 * (before.length() + after.length());
        let second = (after - before).length() / (2.0 * length);
        let doubt = rounding / length;
        assert!(
            second <= variation.curvature + doubt,
            "{second} {variation:?}"
        );
        let third = (after - here * 2.0 + before).length() / (length * length);
        let most = variation.third + variation.rough / length;
        let doubt = 4.0 * rounding / (length * length);
        assert!(third <= most + doubt, "{third} {variation:?} {ball:?}");
        nearest = [
            nearest[0].max((second - doubt) / variation.curvature),
            nearest[1].max((third - doubt) / most),
        ];
    }
    nearest
}

#[test]
fn bounds_on_the_logarithm_hold_in_balls() {
    let mut random = Random::new(61);
    let mut nearest = [0.0_f64; 2];
    for _ in 0..count(400) {
        let sum = sum(&mut random);
        if sum.primitives.is_empty() {
            continue;
        }
        let logarithm = sum.logarithm().expect("all are Gaussians");
        let ball = Ball {
            center: 0.7 * random.vector(1.0),
            radius: random.decades(-3.0, -0.3),
        };
        let found = check(&sum, ball, &logarithm.variation(None, ball), &mut random);
        // The slack of a part that leaves some out.
        let slack = Slack {
            left_out: Logarithm::slack(1e-7),
            far: 0.0,
        };
        if let Some(part) = sum.narrow(ball, None, slack) {
            let bounds = logarithm.variation(Some(&part), ball);
            check(&sum, ball, &bounds, &mut random);
            let whole = jet(&sum, ball.center);
            let own = Logarithm::of(&sum.jet_of(&part, ball.center));
            assert!((whole.value - own.value).abs() <= 1e-7, "{whole:?} {own:?}");
        }
        nearest = [0, 1].map(|i| nearest[i].max(found[i]));
    }
    // A single term has its own second derivative, and no bound is far from all.
    assert!(nearest[0] > 0.9 && nearest[1] > 0.05, "{nearest:?}");
}

#[test]
fn logarithm_is_the_function_at_the_threshold() {
    let mut random = Random::new(62);
    for _ in 0..count(200) {
        let at = Jet {
            value: THRESHOLD,
            gradient: random.vector(1.0).to_array(),
        };
        let of = Logarithm::of(&at);
        assert!((of.value - THRESHOLD).abs() < 1e-12);
        let off = DVec3::from_array(of.gradient) - DVec3::from_array(at.gradient);
        assert!(off.length() < 1e-12);
        // The logarithm grows with the function.
        let above = Logarithm::of(&Jet {
            value: THRESHOLD + 1e-6,
            ..at
        });
        assert!(above.value > of.value);
    }
}

#[test]
fn others_have_no_logarithm() {
    let shaping = |kernel, strength| Shaping {
        kernel,
        radius: 0.3,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength,
        influence: 1e-3,
        taper: None,
    };
    let ball = Skeleton::Point {
        center: DVec3::ZERO,
    };
    for shaping in [shaping(Kernel::Cauchy, 1.0), shaping(Kernel::Gauss, -1.0)] {
        let sum: Sum = Primitive::new(ball.clone(), &shaping, None)
            .into_iter()
            .collect();
        assert!(!sum.primitives.is_empty() && sum.logarithm().is_none());
    }
}
