//! Coatings of skeletons.

use crate::judges::{assert_manifold, of_mesh, on_surface};
use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use mesh::Topology;
use mesher::{Cage, Coat, CoatedBody, Coating, MeshError, Progress, coat_scene};
use scene::{Element, Flesh, Scene, Shape};
use std::ops::ControlFlow;
use trials::{Random, count};

fn shaping(radius: f64) -> Shaping {
    Shaping {
        kernel: Kernel::Gauss,
        radius,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    }
}

/// A chain of segments with its field.
fn chain(points: &[DVec3], radius: f64) -> (Sum, Vec<Cage>) {
    let lines: Vec<_> = points
        .windows(2)
        .map(|w| [(w[0], radius), (w[1], radius)])
        .collect();
    let segment = |w: &[DVec3]| {
        let skeleton = Skeleton::Segment {
            base: w[0],
            apex: w[1],
        };
        Primitive::new(skeleton, &shaping(radius), None)
    };
    (
        points.windows(2).filter_map(segment).collect(),
        Cage::around_lines(&lines),
    )
}

/// The coatings of a scene that nobody cancels.
fn coated(scene: &Scene, bound: f64, coatings: &mut Vec<Coating>) -> Vec<CoatedBody> {
    let mut report = |_| ControlFlow::Continue(());
    coat_scene(scene, bound, coatings, &mut Progress::new(&mut report)).unwrap()
}

fn check(name: &str, function: &dyn Implicit, coat: &Coat, bound: f64) {
    assert_manifold(name, &coat.mesh);
    assert!(coat.mesh.signed_volume() > 0.0, "{name}");
    // All vertices that are not buried are on the surface, as near as was asked.
    let off = |p: &DVec3| (function.jet(*p).value - THRESHOLD).abs();
    let near = coat
        .mesh
        .positions
        .iter()
        .filter(|p| off(p) <= 0.1 * bound * (1.0 + 1e-9));
    // A buried one may happen to be near another part of the surface.
    assert!(
        near.count() + coat.buried >= coat.mesh.positions.len(),
        "{name}"
    );
    // Of edges with both ends on the surface few are farther off than asked when all divisions are
    // done, and the farthest is told.
    let mut edges: Vec<[u32; 2]> = coat
        .mesh
        .triangles
        .iter()
        .flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]])
        .filter(|[a, b]| a < b)
        .collect();
    edges.sort_unstable();
    let at = |i: u32| coat.mesh.positions[i as usize];
    edges.retain(|edge| {
        edge.iter()
            .all(|i| off(&at(*i)) <= 0.1 * bound * (1.0 + 1e-9))
    });
    let excesses: Vec<f64> = edges
        .iter()
        .map(|[a, b]| off(&at(*a).midpoint(at(*b))))
        .collect();
    let largest = excesses.iter().copied().fold(0.0, f64::max);
    let many = excesses.iter().filter(|excess| **excess > bound).count();
    assert!(
        many * 50 <= edges.len() && (coat.buried > 0 || largest <= coat.excess + 1e-9),
        "{name}: {many} of {}, {largest} {}, {} buried",
        edges.len(),
        coat.excess,
        coat.buried
    );
}

/// The largest distance of sampled points of the mesh outside the surface from it: webs in bends
/// and between limbs.
fn largest_web(function: &dyn Implicit, coat: &Coat) -> f64 {
    let mut random = Random::new(3);
    let mut farthest = 0.0_f64;
    for _ in 0..count(4000) {
        let (_, point) = of_mesh(&mut random, &coat.mesh);
        let jet = function.jet(point);
        if jet.value >= THRESHOLD {
            continue;
        }
        // Uphill is the surface.
        let uphill = DVec3::from_array(jet.gradient).normalize_or_zero();
        let is_inside = |t: f64| function.jet(point + uphill * t).value >= THRESHOLD;
        let mut t = 1e-3;
        while !is_inside(t) && t < 1.0 {
            t *= 1.1;
        }
        farthest = farthest.max(t);
    }
    farthest
}

const BEND: [DVec3; 4] = [
    DVec3::new(0.0, 0.0, 0.0),
    DVec3::new(1.0, 0.0, 0.0),
    DVec3::new(1.6, 0.9, 0.0),
    DVec3::new(1.7, 1.6, 0.8),
];

#[test]
fn three_bounds_give_three_meshes_of_a_chain() {
    let (sum, cages) = chain(&BEND, 0.25);
    assert_eq!(cages.len(), 1, "joints of two segments are no ends");
    let mut before = 0;
    for bound in [0.3, 0.1, 0.02] {
        let coat = Coating::default().update(&sum, &cages, &|_| bound);
        check("chain", &sum, &coat, bound);
        assert_eq!(Topology::of(&coat.mesh).unwrap().genera, [0]);
        let count = coat.mesh.triangles.len();
        assert!(count > before, "{bound}: {count} {before}");
        before = count;
        // The distance from the surface follows the bound.
        let mut farthest = 0.0_f64;
        for i in 0..coat.mesh.triangles.len() {
            let [a, b, c] = coat.mesh.corners(i);
            let middle = (a + b + c) / 3.0;
            if let Some(found) = on_surface(&sum, middle) {
                farthest = farthest.max(found.distance(middle));
            }
        }
        assert!(farthest < 0.5 * bound, "{bound}: {farthest}");
    }
}

#[test]
fn moved_skeletons_start_from_the_last_positions() {
    let mut coating = Coating::default();
    let mut evaluations = [0, 0];
    for i in 0..20 {
        let mut points = BEND;
        points[2].z = 0.02 * f64::from(i);
        let (sum, cages) = chain(&points, 0.25);
        let kept = coating.update(&sum, &cages, &|_| 0.05);
        let fresh = Coating::default().update(&sum, &cages, &|_| 0.05);
        check("moved", &sum, &kept, 0.05);
        if i > 0 {
            evaluations[0] += kept.evaluations;
            evaluations[1] += fresh.evaluations;
        }
        // The same surface, whatever it was found from.
        let volumes = [&kept, &fresh].map(|coat| coat.mesh.signed_volume());
        assert!((volumes[0] / volumes[1] - 1.0).abs() < 0.01, "{volumes:?}");
    }
    let [kept, fresh] = evaluations;
    // At best an evaluation for each vertex, and one for the middle of each edge.
    assert!(kept * 10 < fresh * 9, "{kept} of {fresh}");
}

#[test]
fn bound_may_depend_on_the_place() {
    let (sum, cages) = chain(&BEND, 0.25);
    let near = |p: DVec3| if p.x < 0.8 { 0.01 } else { 1.0 };
    let coat = Coating::default().update(&sum, &cages, &near);
    let all = Coating::default().update(&sum, &cages, &|_| 0.01);
    assert_manifold("near", &coat.mesh);
    assert!(coat.mesh.triangles.len() * 3 < all.mesh.triangles.len() * 2);
}

#[test]
fn rings_and_branches_and_faces_are_closed() {
    let ring: Vec<DVec3> = (0..=12)
        .map(|i| {
            let (sine, cosine) = libm::sincos(core::f64::consts::TAU * f64::from(i % 12) / 12.0);
            DVec3::new(cosine, sine, 0.3 * libm::sin(3.0 * f64::from(i % 12)))
        })
        .collect();
    let (sum, cages) = chain(&ring, 0.2);
    assert_eq!(cages.len(), 1);
    let coat = Coating::default().update(&sum, &cages, &|_| 0.05);
    check("ring", &sum, &coat, 0.05);
    assert_eq!(Topology::of(&coat.mesh).unwrap().genera, [1]);

    // Three limbs at a branch are three pieces.
    let limbs: Vec<[DVec3; 2]> = [DVec3::X, DVec3::Y, DVec3::NEG_ONE]
        .map(|p| [DVec3::ZERO, p])
        .into();
    let lines: Vec<_> = limbs.iter().map(|l| l.map(|p| (p, 0.2))).collect();
    let cages = Cage::around_lines(&lines);
    assert_eq!(cages.len(), 3);
    let sum: Sum = limbs
        .iter()
        .filter_map(|[base, apex]| {
            let skeleton = Skeleton::Segment {
                base: *base,
                apex: *apex,
            };
            Primitive::new(skeleton, &shaping(0.2), None)
        })
        .collect();
    let coat = Coating::default().update(&sum, &cages, &|_| 0.05);
    check("branch", &sum, &coat, 0.05);
    assert_eq!(Topology::of(&coat.mesh).unwrap().genera, [0; 3]);

    let square = |s: f64| {
        let corner = |x: f64, y: f64| DVec3::new(s * x, s * y, 0.0);
        vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ]
    };
    let rings = vec![square(1.0), square(0.4)];
    let cage = Cage::around_face(&rings, 0.1).unwrap();
    let frame: Sum = Primitive::new(Skeleton::Polygon { rings }, &shaping(0.1), None)
        .into_iter()
        .collect();
    let coat = Coating::default().update(&frame, &[cage], &|_| 0.05);
    check("frame", &frame, &coat, 0.05);
    assert_eq!(Topology::of(&coat.mesh).unwrap().genera, [1]);
}

#[test]
fn scenes_are_coated_and_what_cannot_be_is_left_out() {
    let mut scene = Scene::default();
    scene.flesh.push(Flesh {
        blobbiness: Some(2.0),
        radius: 0.2,
        ..Flesh::default()
    });
    let soft = |shape| Element {
        flesh: Some(0),
        ..Element::new(shape)
    };
    scene
        .elements
        .push(soft(Shape::plane(DVec3::ZERO, DVec3::Y, 0.1)));
    let mut coatings = Vec::new();
    assert!(
        coated(&scene, 0.1, &mut coatings).is_empty(),
        "planes have no end"
    );
    scene.elements.clear();
    for x in [0.0, f64::NAN, f64::INFINITY] {
        scene.elements.push(soft(Shape::sphere(DVec3::X * x, 0.2)));
    }
    let bodies = coated(&scene, 0.1, &mut coatings);
    assert!(bodies.len() <= 1);
    for number in [1e-300, 1e300] {
        let _ = coated(&scene, number, &mut coatings);
    }
}

#[test]
fn no_webs_between_limbs() {
    let bend = [DVec3::ZERO, DVec3::X, DVec3::new(0.2, 0.3, 0.0)];
    let (sum, cages) = chain(&bend, 0.1);
    let coat = Coating::default().update(&sum, &cages, &|_| 0.05);
    let web = largest_web(&sum, &coat);
    assert!(web < 0.01, "hairpin: {web}");
    for (name, ends) in [
        (
            "acute",
            vec![DVec3::X, DVec3::new(0.9, 0.4, 0.0), -DVec3::X],
        ),
        (
            "three acute",
            vec![
                DVec3::X,
                DVec3::new(0.9, 0.4, 0.0),
                DVec3::new(0.9, 0.0, 0.4),
            ],
        ),
        (
            "star",
            vec![
                DVec3::X,
                DVec3::Y,
                DVec3::Z,
                -DVec3::X,
                -DVec3::Y,
                -DVec3::Z,
            ],
        ),
    ] {
        for radius in [0.05, 0.1, 0.2] {
            let limbs: Vec<[DVec3; 2]> = ends.iter().map(|p| [DVec3::ZERO, *p]).collect();
            let lines: Vec<_> = limbs.iter().map(|l| l.map(|p| (p, radius))).collect();
            let cages = Cage::around_lines(&lines);
            let sum: Sum = limbs
                .iter()
                .filter_map(|[base, apex]| {
                    let skeleton = Skeleton::Segment {
                        base: *base,
                        apex: *apex,
                    };
                    Primitive::new(skeleton, &shaping(radius), None)
                })
                .collect();
            let coat = Coating::default().update(&sum, &cages, &|_| 0.05);
            assert_manifold(name, &coat.mesh);
            let web = largest_web(&sum, &coat);
            assert!(web < 0.01, "{name} {radius}: {web}");
        }
    }
}

/// A body of cylinders at random places, of about this length and radius.
fn scattered(limbs: usize, (length, radius): (f64, f64), seed: u64) -> Scene {
    let mut scene = Scene::default();
    scene.flesh.push(Flesh {
        blobbiness: Some(2.0),
        ..Flesh::default()
    });
    let mut random = Random::new(seed);
    for _ in 0..limbs {
        let base = random.vector(1.0);
        let apex = base + length * random.vector(1.0);
        scene.elements.push(Element {
            flesh: Some(0),
            ..Element::new(Shape::cylinder(base, apex, radius))
        });
    }
    scene
}

#[test]
fn caller_may_cancel_at_any_report_and_loses_nothing() {
    let scene = scattered(100, (0.3, 0.05), 5);
    let mut coatings = Vec::new();
    let coated = |coatings: &mut Vec<Coating>, last: usize| {
        let mut fractions = Vec::new();
        let mut report = |step: mesher::Step| {
            fractions.push(step.fraction);
            if fractions.len() == last {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let bodies = coat_scene(&scene, 0.2, coatings, &mut Progress::new(&mut report));
        (bodies.map(|bodies| bodies[0].coat.clone()), fractions)
    };
    let (first, fractions) = coated(&mut coatings, 0);
    let evaluations = first.unwrap().evaluations;
    // No kernel ends, so that each evaluation takes a hundred terms: a report comes after a
    // thousand or so.
    assert!(
        fractions.len() as u64 > evaluations / 2000 && fractions.is_sorted(),
        "{} reports, {evaluations} evaluations",
        fractions.len()
    );
    let known = coatings.clone();
    for last in [1, 2, fractions.len() / 4] {
        let (result, fractions) = coated(&mut coatings, last);
        assert_eq!(result, Err(MeshError::Cancelled));
        assert_eq!(fractions.len(), last);
        assert_eq!(coatings, known, "the places of the last coating are kept");
    }
}

#[test]
fn many_scattered_limbs_are_coated_with_a_polynomial_for_the_far_ones() {
    let scene = scattered(600, (0.1, 0.01), 9);
    let bodies = coated(&scene, 0.5, &mut Vec::new());
    let coat = &bodies[0].coat;
    assert_eq!(coat.left_out, 0, "all within the bound on the work");
    let surfaces = scene.surfaces();
    check("limbs", surfaces[0].function(), coat, 0.5);
}
