//! Skeletons of subdivision curves as elements of scenes.

use field::{Implicit, Kernel};
use glam::{DAffine3, DVec3};
use scene::{Curves, Element, Flesh, Form, Function, Scene, Shape, Surface};
use skeleton::{Node, Scheme, Skeleton};
use std::sync::Arc;

fn node(x: f64, y: f64, z: f64, radius: f64) -> Node {
    Node {
        position: DVec3::new(x, y, z),
        radius,
    }
}

fn scene(nodes: Vec<Node>, curves: &[&[usize]], levels: u32, to_world: DAffine3) -> Scene {
    let skeleton = Skeleton {
        nodes,
        curves: curves.iter().map(|c| c.to_vec()).collect(),
    };
    let curves = Curves::new(skeleton, Scheme::Cubic, levels).expect("a polyline");
    let shape = Shape::Function(Box::new(Function {
        form: Form::Skeleton(Arc::new(curves)),
        to_world,
    }));
    Scene {
        flesh: vec![Flesh::default()],
        elements: vec![Element {
            flesh: Some(0),
            kernel: Kernel::Cubed,
            ..Element::new(shape)
        }],
        ..Scene::default()
    }
}

/// The function of the only body, and how many primitives it has.
fn only(scene: &Scene) -> (Vec<Surface>, usize) {
    let surfaces = scene.surfaces();
    assert_eq!(surfaces.len(), 1);
    assert!(matches!(surfaces[0], Surface::Sum(_)), "drawn the fast way");
    let count = surfaces[0].element().len();
    (surfaces, count)
}

#[test]
fn a_skeleton_is_soft_with_any_flesh() {
    let nodes = vec![node(0.0, 0.0, 0.0, 0.5), node(4.0, 0.0, 0.0, 0.5)];
    let mut scene = scene(nodes, &[&[0, 1]], 3, DAffine3::IDENTITY);
    let (surfaces, count) = only(&scene);
    assert_eq!(count, 8);
    let value = |x: f64, y: f64| surfaces[0].function().jet(DVec3::new(x, y, 0.0)).value;
    // Half a radius beside the middle of a segment of eight radii it is inside, a radius and a half
    // away outside.
    assert!(value(2.0, 0.25) > 1.0 && value(2.0, 0.75) < 1.0);
    scene.settings.soft = false;
    assert!(scene.surfaces().is_empty());
}

#[test]
fn levels_of_a_straight_curve_are_the_same_flesh() {
    // Superposition: cutting a segment leaves no bulge at the joints.
    let nodes = || vec![node(0.0, 0.0, 0.0, 0.5), node(4.0, 1.0, 0.0, 0.5)];
    let coarse = scene(nodes(), &[&[0, 1]], 0, DAffine3::IDENTITY);
    let fine = scene(nodes(), &[&[0, 1]], 5, DAffine3::IDENTITY);
    let (coarse, fine) = (only(&coarse).0, only(&fine).0);
    for i in 0..200 {
        let t = f64::from(i);
        let point = DVec3::new(t * 0.02, 0.6 * libm::sin(t), 0.5 * libm::cos(2.0 * t));
        let [a, b] = [&coarse, &fine].map(|s| s[0].function().jet(point).value);
        assert!((a - b).abs() <= 1e-10 * a, "{point}: {a} {b}");
    }
}

/// Segments of refined curves are joined to pieces of local convolution, so that it does not depend
/// on the level; and no piece goes on beyond a branch.
#[test]
fn levels_of_a_local_skeleton_have_pieces_alike() {
    let nodes = vec![
        node(-2.0, 0.0, 0.0, 0.3),
        node(0.0, 0.5, 0.0, 0.3),
        node(2.0, 0.0, 0.0, 0.3),
        node(0.5, 2.5, 0.0, 0.15),
    ];
    let made = [3, 6].map(|levels| {
        let mut scene = scene(
            nodes.clone(),
            &[&[0, 1, 2], &[1, 3]],
            levels,
            DAffine3::IDENTITY,
        );
        let Shape::Function(function) = &mut scene.elements[0].shape else {
            panic!("no function")
        };
        let curves = function.curves().expect("curves").clone().within(1.2);
        let lengths = curves.polyline().expect("a polyline").lengths.clone();
        function.form = Form::Skeleton(Arc::new(curves));
        let Shape::Function(function) = &scene.elements[0].shape else {
            panic!("no function")
        };
        let limbs = scene.limbs(&scene.elements[0], function).expect("limbs");
        assert_eq!(limbs.limbs.len(), 3);
        let shared = limbs.limbs.iter().flat_map(|limb| limb.ends);
        let branch = limbs.limbs[2].ends[0];
        assert_eq!(shared.filter(|end| *end == branch).count(), 3);
        let pieces = limbs.limbs.iter().flat_map(|limb| &limb.pieces);
        let long: f64 = pieces.clone().map(|piece| piece.length).sum();
        assert!((long - lengths.iter().sum::<f64>()).abs() < 1e-9);
        assert!(
            pieces
                .clone()
                .all(|piece| piece.length <= 0.3 && piece.radius <= 0.3 + 1e-9)
        );
        let local = scene.local(&scene.elements[0], function);
        (
            pieces.count(),
            local.expect("a skeleton").expect("a function"),
        )
    });
    let [(few, coarse), (many, fine)] = made;
    assert!(
        few >= 20 && 2 * few > many && 2 * many > few,
        "{few} {many}"
    );
    for i in 0..200 {
        let t = f64::from(i);
        let point = DVec3::new(t * 0.02 - 2.0, 0.3 + 0.3 * libm::sin(t), 0.4);
        let [a, b] = [&coarse, &fine].map(|local| local.jet(point).value);
        assert!((a - b).abs() <= 0.03 * a, "{point}: {a} {b}");
    }
}

#[test]
fn tapering_segments_meet_without_a_step() {
    let nodes = vec![
        node(-3.0, 0.0, 0.0, 0.2),
        node(-1.0, 0.5, 0.0, 0.7),
        node(1.0, -0.5, 0.0, 0.3),
        node(3.0, 0.0, 0.0, 0.5),
    ];
    let refined = scene(nodes, &[&[0, 1, 2, 3]], 4, DAffine3::IDENTITY);
    let (surfaces, _) = only(&refined);
    let Shape::Function(function) = &refined.elements[0].shape else {
        panic!("no function")
    };
    let curves = function.curves().expect("curves");
    // The surface's distance from the skeleton, at and between joints: it follows the radius
    // without a bulge at any joint.
    let distance = |foot: DVec3| {
        let (mut inside, mut outside) = (0.0, 2.0);
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            let there = foot + DVec3::Z * middle;
            if surfaces[0].function().jet(there).value > 1.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    };
    let pieces: Vec<_> = curves.pieces().collect();
    for pair in pieces.windows(2).skip(8).take(30) {
        let [[a, joint], [_, b]] = [pair[0], pair[1]];
        let ratio = |(place, radius): (DVec3, f64)| distance(place) / radius;
        let middle = |p: (DVec3, f64), q: (DVec3, f64)| (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
        let (before, at, after) = (
            ratio(middle(a, joint)),
            ratio(joint),
            ratio(middle(joint, b)),
        );
        assert!(
            (at - 0.5 * (before + after)).abs() < 0.01,
            "{before} {at} {after}"
        );
    }
}

#[test]
fn a_moved_skeleton_is_the_same_flesh_elsewhere() {
    let nodes = || {
        vec![
            node(0.0, 0.0, 0.0, 0.4),
            node(1.0, 0.5, 0.2, 0.3),
            node(2.0, 0.0, 0.0, 0.1),
            node(1.0, 2.0, 0.0, 0.2),
        ]
    };
    let map = DAffine3::from_translation(DVec3::new(3.0, -1.0, 2.0))
        * DAffine3::from_rotation_z(0.7)
        * DAffine3::from_scale(DVec3::splat(1.5));
    let curves: &[&[usize]] = &[&[0, 1, 2], &[1, 3]];
    let here = scene(nodes(), curves, 2, DAffine3::IDENTITY);
    let there = scene(nodes(), curves, 2, map);
    let (here, there) = (only(&here).0, only(&there).0);
    for i in 0..100 {
        let t = f64::from(i);
        let point = DVec3::new(0.02 * t, libm::sin(t), 0.6 * libm::cos(t));
        let a = here[0].function().jet(point).value;
        let b = there[0].function().jet(map.transform_point3(point)).value;
        assert!((a - b).abs() <= 1e-8 * a, "{a} {b}");
    }
}

#[test]
fn drafts_have_balls_at_joints_and_cones_between() {
    let nodes = vec![node(0.0, 0.0, 0.0, 0.5), node(4.0, 0.0, 0.0, 0.1)];
    let scene = scene(
        nodes,
        &[&[0, 1]],
        1,
        DAffine3::from_scale(DVec3::splat(2.0)),
    );
    let parts = scene.elements[0].shape.parts(0.0);
    assert_eq!(parts.len(), 3 + 2);
    let largest = parts.iter().map(Shape::radius).fold(0.0, f64::max);
    assert_eq!(largest, 1.0);
    let Shape::Function(function) = &scene.elements[0].shape else {
        panic!("no function")
    };
    let (low, high) = function.corners();
    assert_eq!((low, high), (DVec3::splat(-1.0), DVec3::new(8.2, 1.0, 1.0)));
}

#[test]
fn data_of_no_polyline_are_harmless() {
    let mut bad = scene(
        vec![node(0.0, 0.0, 0.0, 0.5), node(1.0, 0.0, 0.0, 0.5)],
        &[&[0, 1]],
        1,
        DAffine3::IDENTITY,
    );
    let Shape::Function(function) = &mut bad.elements[0].shape else {
        panic!("no function")
    };
    let Form::Skeleton(curves) = &function.form else {
        panic!("no skeleton")
    };
    let bytes = postcard::to_allocvec(&**curves).expect("bytes");
    let mut again: Curves = postcard::from_bytes(&bytes).expect("curves");
    assert_eq!(again, **curves);
    again.skeleton.curves = vec![vec![0, 9]];
    function.form = Form::Skeleton(Arc::new(again));
    assert!(bad.surfaces().is_empty());
    assert!(bad.elements[0].shape.parts(0.0).is_empty());
}
