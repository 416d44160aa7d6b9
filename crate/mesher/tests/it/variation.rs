//! Bounds that proofs rest on: of random scenes over all kernels and primitives, with kinks, and of
//! composed functions.

use contact::{Bulge, Squashed};
use field::{Ball, Blend, Exponentials, Implicit, Kernel, Slack, Variation};
use glam::DVec3;
use std::sync::Arc;
use trials::scenes::{self, KINDS, Kind};
use trials::{Random, count};

/// Holds the bounds in some balls against samples. Returns the largest shares of the bounds that
/// were met: of changes of the slope, and of its distance from its linear interpolant.
fn check(
    name: &str,
    function: &dyn Implicit,
    around: Ball,
    balls: usize,
    random: &mut Random,
) -> [f64; 2] {
    let mut met = [0.0_f64; 2];
    for _ in 0..count(balls) {
        let radius = around.radius * random.decades(-3.0, 0.0);
        let ball = Ball {
            center: around.center + around.radius * random.vector(1.0),
            radius,
        };
        let large = Ball {
            radius: 2.0 * radius,
            ..ball
        };
        // Some with a polynomial for far terms.
        let slack = Slack {
            left_out: 1e-7,
            far: if random.chance(0.5) { 2e-4 } else { 0.0 },
        };
        let part = function.narrow(large, None, slack);
        let Variation {
            range,
            curvature,
            third,
            rough,
            jump,
            step,
        } = function.variation(part.as_ref(), ball);
        let point =
            |random: &mut Random| ball.center + radius * random.vector(1.0).clamp_length_max(1.0);
        let [a, b] = [point(random), point(random)];
        let Some(along) = (b - a).try_normalize() else {
            continue;
        };
        let length = a.distance(b);
        let [one, mid, other] = [a, a.midpoint(b), b].map(|p| function.jet(p));
        let size = 1.0 + one.value.abs() + other.value.abs();
        for (jet, p) in [(&one, a), (&other, b)] {
            let [low, high] = range.value;
            assert!(
                jet.value >= low - 1e-9 * size && jet.value <= high + 1e-9 * size,
                "{name}: {} at {p}, not in {range:?}",
                jet.value
            );
            if let Some(part) = &part {
                let near = function.jet_of(part, p);
                assert!(
                    (near.value - jet.value).abs() <= 2e-7 + part.error()[0] + 1e-12 * size,
                    "{name}: {p}"
                );
                let [near, jet] = [near, *jet].map(|jet| DVec3::from_array(jet.gradient));
                let off = 2e-7 / large.radius + part.error()[1] + 1e-12 * jet.length();
                assert!(near.distance(jet) <= off, "{name}: {p}");
            }
        }
        if step > 0.0 {
            continue;
        }
        let slope = |jet: &field::Jet<f64>| DVec3::from_array(jet.gradient).dot(along);
        let [g, h, i] = [&one, &mid, &other].map(slope);
        let noise = 1e-7 * (g.abs() + h.abs() + i.abs()) + 1e-9 * size / around.radius;
        let allowed = curvature * length + jump;
        let changed = (i - g).abs();
        assert!(
            changed <= allowed * (1.0 + 1e-6) + noise,
            "{name}: {changed} > {allowed} in {ball:?}"
        );
        let bent = (h - 0.5 * (g + i)).abs();
        let bend = third * length * length / 8.0 + 0.5 * rough * length + jump;
        assert!(
            bent <= bend * (1.0 + 1e-6) + noise,
            "{name}: {bent} > {bend} in {ball:?}"
        );
        for (met, (is, may)) in met.iter_mut().zip([(changed, allowed), (bent, bend)]) {
            if may > 10.0 * noise && may.is_finite() {
                *met = met.max(is / may);
            }
        }
    }
    met
}

#[test]
fn sums_keep_within_their_bounds() {
    let mut random = Random::new(17);
    let mut met = [0.0_f64; 2];
    for kernel in Kernel::ALL {
        for kind in KINDS {
            if matches!(kind, Kind::Cluster) {
                continue;
            }
            for seed in 0..2 {
                let (scene, _) = scenes::scene(kernel, kind, &mut random);
                for surface in scene.surfaces() {
                    let function = surface.function();
                    let around = function.support().unwrap_or(Ball {
                        center: scene.camera.target,
                        radius: scene.camera.eye.distance(scene.camera.target),
                    });
                    if around.radius == 0.0 {
                        continue;
                    }
                    let own = check(
                        &format!("{kernel:?} {kind:?} {seed}"),
                        function,
                        around,
                        60,
                        &mut random,
                    );
                    met = [0, 1].map(|i| met[i].max(own[i]));
                }
            }
        }
    }
    assert!(
        met[0] > 0.3 && met[1] > 0.1,
        "the bounds are of use: {met:?}"
    );
}

#[test]
fn composed_functions_keep_within_their_bounds() {
    let mut random = Random::new(23);
    let body = |seed: u64| -> Arc<dyn Implicit> {
        let mut random = Random::new(seed);
        let (scene, _) = scenes::scene(Kernel::Gauss, Kind::Segment, &mut random);
        let sum = scene.soft_surfaces().swap_remove(0).sum;
        let balls = vec![(DVec3::X * 0.5, 0.3), (DVec3::Y * 0.5, 0.2)];
        Arc::new(Blend::new(
            sum,
            vec![(
                Arc::new(Exponentials::new(5.0, balls).unwrap()) as Arc<dyn Implicit>,
                1,
            )],
        ))
    };
    let around = Ball {
        center: DVec3::ZERO,
        radius: 1.5,
    };
    let mut met = [0.0_f64; 2];
    for seed in 0..12 {
        let [one, other] = [2 * seed, 2 * seed + 1].map(body);
        let squashed = Squashed::new(Arc::clone(&one), vec![(other, Bulge::default())]);
        for (name, function) in [("blend", &*one), ("squashed", &squashed as &dyn Implicit)] {
            let own = check(
                &format!("{name} {seed}"),
                function,
                around,
                200,
                &mut random,
            );
            met = [0, 1].map(|i| met[i].max(own[i]));
        }
    }
    assert!(met[0] > 0.2, "the bounds are of use: {met:?}");
}
