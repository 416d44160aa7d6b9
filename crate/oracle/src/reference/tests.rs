//! Tests of the reference against steps so small that they need no bounds.
use super::{Near, Reference};
use field::{Kernel, Profile, Wave};
use glam::DVec3;
use scene::{Element, Scene, Shape};
use trials::scenes::{clothe, element, empty, soft};
use trials::{Random, count};

/// Returns some elements of one kernel; every other scene carves, tapers or has a profile.
fn scene(kernel: Kernel, seed: u64) -> Scene {
    let mut n = Random::new(seed * 8 + kernel as u64);
    let mut scene = empty();
    for i in 0..1 + seed % 3 {
        let mut material = soft(libm::exp(n.range(-2.0, 3.0)), 1.0);
        material.kernel = Some(kernel);
        if i == 2 {
            material.strength = -0.7;
        }
        match seed % 4 {
            1 => material.end_radius = Some(0.05),
            2 => {
                let waves = [Wave::Sin, Wave::Hat, Wave::Step, Wave::Saw, Wave::Cos2];
                material.profile = Some(Profile {
                    waves: [n.pick(&waves), Wave::One],
                    scale: [n.range(1.0, 9.0), 1.0],
                    bounds: [0.5, 1.0],
                    times: 1.3,
                    restriction: 0.4,
                });
            }
            _ => (),
        }
        let kind = n.below(7);
        let radius = 0.25;
        let shape = match kind {
            5 => Shape::curve([0, 1, 2, 3].map(|_| n.vector(1.0)), radius),
            6 => {
                let (x, y) = (DVec3::X, (DVec3::Y + DVec3::Z * n.unit()).normalize());
                let star = |i: u32, far: f64| {
                    let (sine, cosine) = libm::sincos(f64::from(i) * 1.1);
                    (x * cosine + y * sine) * far
                };
                Shape::polygon(
                    vec![
                        (0..5).map(|i| star(i, 0.5 + 0.5 * n.unit())).collect(),
                        (0..5).map(|i| star(i, 0.2)).collect(),
                    ],
                    radius,
                )
            }
            kind => n.shape(kind),
        };
        scene.elements.push(Element {
            flesh: Some(scene.flesh.len() as u32),
            ..Element::new(shape)
        });
        scene.flesh.push(material);
    }
    scene
}

fn reference(scene: &Scene) -> Reference {
    Reference::new(scene.soft_surfaces().swap_remove(0).sum.primitives)
}

#[test]
fn crossings_are_those_of_small_steps() {
    let mut seen = 0;
    for kernel in Kernel::ALL {
        for seed in 0..count(6) as u64 {
            let scene = scene(kernel, seed);
            let mut reference = reference(&scene);
            let mut n = Random::new(seed * 77 + kernel as u64);
            for _ in 0..2 {
                let origin = n.vector(3.0);
                let direction = (n.vector(0.5) - origin).normalize();
                let found = reference.crossings(origin, direction, 7.0, 1e-9);
                assert!(found.complete, "{kernel:?} {seed}");
                assert!(found.roots.windows(2).all(|w| w[0].t < w[1].t));
                seen += found.roots.len();
                // Every change of sign between steps is an odd number of crossings.
                let step = 7.0 / 1000.0;
                let mut before = reference.excess(origin).0 >= 0.0;
                assert_eq!(before, found.starts_inside);
                let mut next = found.roots.iter().peekable();
                for i in 1..=1000 {
                    let end = f64::from(i) * step;
                    let after = reference.excess(origin + direction * end).0 >= 0.0;
                    let mut count = 0;
                    while let Some(root) = next.next_if(|r| r.t <= end) {
                        count += 1;
                        assert!(root.width < 1e-6);
                        assert_eq!(root.enters, before != (count % 2 == 1), "{kernel:?} {seed}");
                    }
                    assert_eq!(
                        count % 2 == 1,
                        before != after,
                        "{kernel:?} {seed} at {end}"
                    );
                    before = after;
                }
            }
        }
    }
    assert!(seen > count(75), "{seen} crossings");
}

/// The scenes' profiles are smooth, as there is no second derivative at kinks.
#[test]
fn slopes_change_no_faster_than_the_bound() {
    let mut tight = 0;
    for kernel in Kernel::ALL {
        for seed in 0..count(12) as u64 {
            let mut scene = scene(kernel, seed);
            for material in &mut scene.flesh {
                if let Some(profile) = &mut material.profile {
                    profile.waves[0] = Wave::Sin;
                    profile.restriction = 0.0;
                    material.restriction = 0.0;
                }
            }
            let mut reference = reference(&scene);
            let mut n = Random::new(seed * 91 + kernel as u64);
            for _ in 0..40 {
                let center = n.vector(1.5);
                let radius = libm::exp(n.range(-9.0, 0.0));
                for _ in 0..4 {
                    let [a, b] = [0, 1].map(|_| center + n.vector(1.0) * (radius * 0.57));
                    let way = (b - a).normalize();
                    let extent = reference.function.extent(center, radius, Some(way));
                    let [p, q] = [a, b].map(|x| reference.sample(x));
                    // Kinks of waves, where they are cut off at the ends of bones, are no faults.
                    if reference
                        .kinks
                        .iter()
                        .any(|k| (a - k.point).dot(k.normal) * (b - k.point).dot(k.normal) <= 0.0)
                    {
                        continue;
                    }
                    let change = (q.gradient - p.gradient).dot(way).abs() / a.distance(b);
                    let noise = (p.slope_noise + q.slope_noise) / a.distance(b);
                    assert!(
                        change <= extent.curvature + noise + 1e-15,
                        "{kernel:?} {seed} {center} {radius}: {change} > {}",
                        extent.curvature
                    );
                    assert!(
                        (q.excess - p.excess).abs()
                            <= extent.slope * a.distance(b) + p.noise + q.noise
                    );
                    assert!(p.excess + 1.0 <= extent.above + p.noise);
                    assert!(-p.excess - 1.0 <= extent.below + p.noise);
                    tight += usize::from(change > 0.1 * extent.curvature);
                }
            }
        }
    }
    assert!(
        tight > count(1500),
        "{tight} of {} within a factor of 10",
        count(15_360)
    );
}

#[test]
fn a_ball_is_found_to_the_last_digits() {
    let mut scene = empty();
    clothe(&mut scene, vec![soft(4.0, 1.0)]);
    scene
        .elements
        .push(element(Shape::sphere(DVec3::X, 0.25), 0));
    let mut reference = reference(&scene);
    for (off, count) in [(0.0, 2), (0.2, 2), (0.25 - 1e-8, 2), (0.25 + 1e-8, 0)] {
        let origin = DVec3::new(-3.0, off, 0.0);
        let found = reference.crossings(origin, DVec3::X, 10.0, 1e-7);
        assert_eq!(found.roots.len(), count, "{off}: {found:?}");
        let half = (0.0625f64 - off * off).max(0.0).sqrt();
        for (root, side) in found.roots.iter().zip([-half, half]) {
            assert!((root.t - 4.0 - side).abs() < 1e-7, "{off}: {root:?}");
        }
    }
    for off in [-0.01, -1e-4, 1e-5, 0.02] {
        let point = DVec3::new(1.0, 0.25 + off, 0.0);
        match reference.surface_near(point, 1.01 * off.abs()) {
            Near::Within(d) => {
                assert!(d >= 0.99 * off.abs() && d <= 1.01 * off.abs(), "{off}: {d}")
            }
            other => panic!("{off}: {other:?}"),
        }
        assert_eq!(
            reference.surface_near(point, 0.98 * off.abs()),
            Near::Beyond,
            "{off}"
        );
    }
}

#[test]
fn wrong_reports_are_noticed() {
    use super::Fault;
    let scene = scene(Kernel::Cauchy, 0);
    let mut reference = reference(&scene);
    let mut n = Random::new(3);
    let mut tried = 0;
    for _ in 0..40 {
        let origin = n.direction() * 4.0;
        let direction = (n.vector(0.3) - origin).normalize();
        let found = reference.crossings(origin, direction, 10.0, 1e-9);
        let tolerance = 1e-4;
        let mut judge = |t: Option<f64>| reference.judge(origin, direction, t, 10.0, |_| tolerance);
        if found.starts_inside {
            continue;
        }
        let [first, second, ..] = found.roots[..] else {
            let verdict = judge(Some(2.0));
            assert!(
                matches!(verdict.fault, Some(Fault::Invented(_))),
                "{verdict:?}"
            );
            continue;
        };
        if second.t - first.t < 0.1 {
            continue;
        }
        tried += 1;
        assert_eq!(judge(Some(first.t)).fault, None);
        assert!(judge(Some(first.t)).distance < 1e-8);
        assert!(matches!(
            judge(None).fault,
            Some(Fault::Missed { grazing: false, .. })
        ));
        assert!(matches!(
            judge(Some(second.t)).fault,
            Some(Fault::Missed { .. })
        ));
        assert!(matches!(
            judge(Some(first.t - 0.05)).fault,
            Some(Fault::Invented(_))
        ));
        assert!(judge(Some(0.5 * (first.t + second.t))).fault.is_some());
    }
    assert!(tried > 5, "{tried}");
}
