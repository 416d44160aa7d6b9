//! Parts of a surface that are thinner than the tolerance: each of their points is within the
//! tolerance of the mesh.

use crate::judges::{Distances, assert_embedded, assert_manifold, crossings, of_mesh, on_surface};
use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use mesher::{Options, Progress, SurfaceMesh, box_of, polygonize};
use std::ops::ControlFlow;
use trials::{Random, count};

const TOLERANCE: f64 = 0.05;

fn primitive(skeleton: Skeleton, kernel: Kernel, radius: f64, strength: f64) -> Primitive {
    let shaping = Shaping {
        kernel,
        radius,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength,
        influence: 1e-3,
        taper: None,
    };
    Primitive::new(skeleton, &shaping, None).unwrap()
}

fn ball() -> Primitive {
    let center = DVec3::ZERO;
    primitive(Skeleton::Point { center }, Kernel::Gauss, 1.0, 1.0)
}

fn meshed(function: &dyn Implicit) -> SurfaceMesh {
    let domain = box_of(function.support().expect("it is no plane"));
    let mut report = |_| ControlFlow::Continue(());
    let progress = &mut Progress::new(&mut report);
    polygonize(function, &domain, &Options::new(TOLERANCE), progress).unwrap()
}

/// Points of the surface around points of a thin part, each looked for in some direction.
fn around(function: &dyn Implicit, from: DVec3, random: &mut Random) -> Option<DVec3> {
    let direction = random.direction();
    let met = crossings(function, from, direction, 1.0, 1e-4);
    Some(from + direction * *met.first()?)
}

/// Checks both distances, the thin part being that around some points.
fn check(name: &str, sum: &Sum, parts: &[(DVec3, DVec3)], within: &dyn Fn(DVec3) -> f64) {
    let surface = meshed(sum);
    let mesh = &surface.mesh;
    assert_manifold(name, mesh);
    assert_embedded(name, mesh);
    let near = Distances::new(mesh);
    let mut random = Random::new(5);
    let (mut farthest, mut points) = (0.0_f64, 0);
    for (base, apex) in parts {
        for _ in 0..count(60) {
            let from = base.lerp(*apex, random.unit());
            if sum.jet(from).value <= THRESHOLD {
                continue;
            }
            if let Some(point) = around(sum, from, &mut random) {
                farthest = farthest.max(near.to(point));
                points += 1;
            }
        }
    }
    println!(
        "{name}: {} triangles, {} unproved, {} undecided, {points} points within {:.3} tolerances",
        mesh.triangles.len(),
        surface.unproved,
        surface.undecided.len(),
        farthest / TOLERANCE
    );
    assert!(points > count(20) * parts.len(), "{name}: {points}");
    assert!(farthest <= TOLERANCE, "{name}: {farthest}");
    // Back: the surface goes around the inside of the thin part, no farther from a point than that
    // is.
    for _ in 0..count(2000) {
        let (_, point) = of_mesh(&mut random, mesh);
        let own = on_surface(sum, point).map_or(f64::INFINITY, |found| found.distance(point));
        let own = own.min(within(point));
        assert!(own <= TOLERANCE, "{name}: {point} is {own} off");
    }
}

#[test]
fn spikes_thinner_than_the_tolerance_are_there() {
    for (kernel, radius) in [
        (Kernel::Gauss, 0.4 * TOLERANCE),
        (Kernel::Cauchy, 0.15 * TOLERANCE),
        (Kernel::Quartic, 0.04 * TOLERANCE),
        (Kernel::Gauss, 0.01 * TOLERANCE),
    ] {
        let mut random = Random::new(9);
        let spike = |_| {
            let way = random.direction();
            (way * 0.8, way * 1.8)
        };
        let spikes: Vec<(DVec3, DVec3)> = (0..3).map(spike).collect();
        let thin = spikes.iter().map(|(base, apex)| {
            let (base, apex) = (*base, *apex);
            primitive(Skeleton::Segment { base, apex }, kernel, radius, 1.0)
        });
        let sum: Sum = thin.chain([ball()]).collect();
        let within = |point: DVec3| {
            let inner = spikes.iter().map(|(base, apex)| {
                let way = *apex - *base;
                let share = (point - *base).dot(way) / way.length_squared();
                point.distance(*base + way * share.clamp(0.0, 1.0))
            });
            inner.fold(f64::INFINITY, f64::min)
        };
        check(&format!("{kernel:?} {radius}"), &sum, &spikes, &within);
    }
}

#[test]
fn plates_and_cracks_thinner_than_the_tolerance_are_there() {
    let corners = [DVec3::X * 0.5, DVec3::X * 1.8, DVec3::Y * 1.4];
    let inner = |share: f64| {
        let side = corners[1].lerp(corners[2], share);
        (corners[0].lerp(side, 0.1), corners[0].lerp(side, 0.95))
    };
    let lines: Vec<(DVec3, DVec3)> = (1..12).map(|i| inner(f64::from(i) / 12.0)).collect();
    let plate = |strength| {
        primitive(
            Skeleton::Triangle { corners },
            Kernel::Gauss,
            0.2 * TOLERANCE,
            strength,
        )
    };
    check(
        "plate",
        &[ball(), plate(1.0)].into_iter().collect(),
        &lines,
        &|point| mesh::closest_point(&corners, point).distance(point) - 0.15 * TOLERANCE,
    );
    // A crack: what is above the threshold around it is below in it.
    let carved: Sum = [ball(), plate(-4.0)].into_iter().collect();
    let surface = meshed(&carved);
    assert_manifold("crack", &surface.mesh);
    assert_embedded("crack", &surface.mesh);
    let near = Distances::new(&surface.mesh);
    let mut random = Random::new(3);
    let mut points = 0;
    for _ in 0..count(400) {
        let (base, apex) = random.pick(&lines);
        let from = base.lerp(apex, random.unit());
        let is_in_it = from.length() < 0.9 && carved.jet(from).value < THRESHOLD;
        if let Some(point) = is_in_it
            .then(|| around(&carved, from, &mut random))
            .flatten()
        {
            points += 1;
            let off = near.to(point);
            assert!(off <= TOLERANCE, "{point}: {off}");
        }
    }
    assert!(points > count(30), "{points}");
}
