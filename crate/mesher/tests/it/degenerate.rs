//! Scenes without a surface, or with one that is not regular: what is said of them.

use crate::judges::assert_manifold;
use field::{
    Ball, BlobScale, Enclosure, Implicit, Jet, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD,
};
use glam::DVec3;
use mesh::Topology;
use mesher::{
    MeshError, Model, Options, Progress, Tolerance, Wishes, box_of, mesh_scene, polygonize,
};
use scene::{Body, Element, Flesh, Scene, Shape};
use std::ops::ControlFlow;
use wide::f32x8;

fn meshed(scene: &Scene, wishes: &Wishes) -> Result<Model, MeshError> {
    let mut report = |_| ControlFlow::Continue(());
    mesh_scene(scene, wishes, &mut Progress::new(&mut report))
}

fn coarse() -> Wishes {
    Wishes {
        tolerance: Tolerance::Relative(0.01),
        ..Wishes::default()
    }
}

fn soft(shapes: impl IntoIterator<Item = Shape>) -> Scene {
    let mut scene = Scene::default();
    scene.flesh.push(Flesh {
        blobbiness: Some(2.0),
        radius: 0.3,
        ..Flesh::default()
    });
    scene
        .elements
        .extend(shapes.into_iter().map(|shape| Element {
            flesh: Some(0),
            ..Element::new(shape)
        }));
    scene
}

fn sphere(center: DVec3, radius: f64) -> Shape {
    Shape::sphere(center, radius)
}

fn plane(radius: f64) -> Shape {
    Shape::plane(DVec3::ZERO, DVec3::Y, radius)
}

#[test]
fn nothing_and_planes_alone_are_told_in_words() {
    let nothing = meshed(&soft([]), &coarse()).unwrap_err();
    assert!(nothing.to_string().contains("no surface"), "{nothing}");
    for scene in [soft([plane(0.3)]), {
        let mut scene = Scene::default();
        scene.elements.push(Element::new(plane(0.0)));
        scene
    }] {
        let error = meshed(&scene, &coarse()).unwrap_err();
        assert_eq!(error, MeshError::Unbounded);
        assert!(error.to_string().contains("box"), "{error}");
    }
    // Something finite beside says how far to go.
    let model = meshed(&soft([plane(0.3), sphere(DVec3::Y, 0.5)]), &coarse()).unwrap();
    assert!(
        model.notes.iter().any(|note| note.contains("cut off")),
        "{:?}",
        model.notes
    );
    assert_manifold("slab", &model.parts[0].mesh);
}

#[test]
fn boxes_too_large_for_the_tolerance_are_told_in_words() {
    let scene = soft([plane(0.3), sphere(DVec3::Y, 0.5)]);
    for (tolerance, word) in [
        // Of the box, so that nothing finite would be seen.
        (Tolerance::Relative(1e-3), "smaller box"),
        // Of the model, so that there would be too many triangles.
        (Tolerance::Absolute(0.01), "box very large"),
    ] {
        let wishes = Wishes {
            tolerance,
            box_scale: 1e9,
            max_triangles: 20_000,
            ..Wishes::default()
        };
        let error = meshed(&scene, &wishes).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn soft_shell_whose_turns_touch_is_united() {
    // Balls along a spiral, as the command `shell` lays them: each turn just touches the one
    // inside.
    let (growth, touch) = (1.7_f64, 0.7 / 2.7);
    let balls = (0..=36).map(|i| {
        let turns = f64::from(i) / 18.0;
        let out = libm::pow(growth, -turns);
        let (sine, cosine) = libm::sincos(core::f64::consts::TAU * turns);
        sphere(DVec3::new(out * cosine, -out * sine, 0.0), out * touch)
    });
    let mut scene = soft(balls);
    scene.flesh[0].radius = 0.0;
    let wishes = Wishes {
        union: true,
        ..coarse()
    };
    let model = meshed(&scene, &wishes).unwrap();
    assert_eq!(model.parts.len(), 1);
    assert_manifold("shell", &model.parts[0].mesh);
}

#[test]
fn hard_planes_are_cut_and_slabs_are_closed() {
    for (radius, is_closed) in [(0.0, false), (0.2, true)] {
        let mut scene = Scene::default();
        scene.elements.push(Element::new(plane(radius)));
        scene
            .elements
            .push(Element::new(sphere(DVec3::Y * 0.5, 1.0)));
        scene.elements[0].body = 0;
        scene.bodies.push(Body::default());
        scene.elements[1].body = scene.bodies.len() as u32 - 1;
        let model = meshed(&scene, &coarse()).unwrap();
        assert!(
            model.parts.iter().all(|part| part.is_closed) == is_closed,
            "{radius}"
        );
        for part in model.parts.iter().filter(|part| part.is_closed) {
            assert_manifold(&part.name, &part.mesh);
        }
    }
}

#[test]
fn polygons_with_corners_on_their_sides_make_closed_prisms() {
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let outer = vec![
        corner(0.0, 0.0),
        corner(1.0, 0.0),
        corner(2.0, 0.0),
        corner(2.0, 2.0),
        corner(1.0, 2.0),
        corner(0.0, 2.0),
        corner(0.0, 1.0),
    ];
    let hole = vec![
        corner(0.5, 0.5),
        corner(1.0, 0.5),
        corner(1.5, 0.5),
        corner(1.0, 1.5),
    ];
    let mut scene = Scene::default();
    scene
        .elements
        .push(Element::new(Shape::polygon(vec![outer, hole], 0.1)));
    let model = meshed(&scene, &coarse()).unwrap();
    let part = &model.parts[0];
    assert!(part.is_closed);
    assert_manifold("prism", &part.mesh);
    assert_eq!(Topology::of(&part.mesh).unwrap().genera, [1]);
    assert!((part.mesh.signed_volume() - (4.0 - 0.5) * 0.2).abs() < 1e-12);
}

#[test]
fn surfaces_that_touch_are_told() {
    let shaping = Shaping {
        kernel: Kernel::Gauss,
        radius: 1.0,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let pair = |apart: f64| -> Sum {
        let ball = |x: f64| {
            let center = DVec3::new(x, 0.1, 0.2);
            Primitive::new(Skeleton::Point { center }, &shaping, None)
        };
        [ball(-apart), ball(apart)].into_iter().flatten().collect()
    };
    // The distance at which both meet in a point, to the last bit.
    let (mut near, mut far) = (0.5, 3.0);
    while f64::midpoint(near, far) > near && f64::midpoint(near, far) < far {
        let middle = f64::midpoint(near, far);
        let value = pair(middle).jet(DVec3::new(0.0, 0.1, 0.2)).value;
        *(if value > THRESHOLD {
            &mut near
        } else {
            &mut far
        }) = middle;
    }
    let sum = pair(near);
    let mut report = |_| ControlFlow::Continue(());
    let domain = box_of(sum.support().unwrap());
    let options = Options::new(0.01);
    let surface = polygonize(&sum, &domain, &options, &mut Progress::new(&mut report)).unwrap();
    assert_manifold("touching", &surface.mesh);
    assert!(
        !surface.undecided.is_empty(),
        "nothing can be proved at the point of contact"
    );
    let off = |p: &DVec3| p.distance(DVec3::new(0.0, 0.1, 0.2));
    assert!(
        surface.undecided.iter().all(|p| off(p) < 0.1),
        "{:?}",
        surface.undecided
    );
    // A hair apart or together it is proved.
    for (apart, shells) in [(near * 0.99, 1), (far * 1.01, 2)] {
        let sum = pair(apart);
        let surface = polygonize(&sum, &domain, &options, &mut Progress::new(&mut report)).unwrap();
        assert!(
            surface.undecided.is_empty() && surface.unproved == 0,
            "{apart}"
        );
        assert_eq!(Topology::of(&surface.mesh).unwrap().genera.len(), shells);
    }
}

#[test]
fn union_joins_bodies() {
    let mut scene = soft([sphere(DVec3::ZERO, 1.0), sphere(DVec3::X * 1.2, 1.0)]);
    let second = Body {
        name: "second".into(),
    };
    scene.bodies.push(second);
    scene.elements[1].body = 1;
    let apart = meshed(&scene, &coarse()).unwrap();
    assert_eq!(apart.parts.len(), 2);
    let wishes = Wishes {
        union: true,
        ..coarse()
    };
    let joined = meshed(&scene, &wishes).unwrap();
    assert_eq!(joined.parts.len(), 1);
    assert_manifold("union", &joined.parts[0].mesh);
    // Two balls less the lens that both share.
    let (d, r) = (1.2, 1.0_f64);
    let lens = core::f64::consts::PI * (4.0 * r + d) * (2.0 * r - d) * (2.0 * r - d) / 12.0;
    let expected = 2.0 * 4.0 / 3.0 * core::f64::consts::PI - lens;
    let volume = joined.parts[0].mesh.signed_volume();
    // Each point of the mesh may be off by the tolerance.
    let room = apart.tolerance * joined.parts[0].mesh.area();
    assert!(
        (volume - expected).abs() < room && room < 0.2 * expected,
        "{volume} {expected} {room}"
    );

    let wishes = Wishes {
        body: Some("second".into()),
        ..coarse()
    };
    let one = meshed(&scene, &wishes).unwrap();
    assert_eq!(one.parts.len(), 1);
    assert_eq!(one.parts[0].name, "second");
}

#[test]
fn cavities_stay_in_unions_and_outer_drops_them() {
    // A ball that another one carves from within, and a third one beside.
    let mut scene = soft([
        sphere(DVec3::ZERO, 1.0),
        sphere(DVec3::ZERO, 0.5),
        sphere(DVec3::X * 1.5, 0.8),
    ]);
    scene.flesh[0].kernel = Some(Kernel::Gauss);
    scene.flesh.push(Flesh {
        strength: -1.0,
        ..scene.flesh[0].clone()
    });
    scene.elements[1].flesh = Some(1);
    scene.elements[2].body = 1;
    scene.bodies.push(Body::default());
    let shells = |union: bool, outer: bool| {
        let wishes = Wishes {
            union,
            outer,
            ..coarse()
        };
        let model = meshed(&scene, &wishes).unwrap();
        let part = &model.parts[0];
        assert_manifold(&part.name, &part.mesh);
        let genera = Topology::of(&part.mesh).unwrap().genera;
        (genera, part.mesh.signed_volume())
    };
    let (hollow, volume) = shells(false, false);
    assert_eq!(hollow, [0, 0]);
    let (full, larger) = shells(false, true);
    assert_eq!(full, [0]);
    let cavity = larger - volume;
    assert!(cavity > 0.01, "{cavity}");
    let (joined, volume) = shells(true, false);
    assert_eq!(joined, [0, 0], "the cavity is still there");
    let (full, larger) = shells(true, true);
    assert_eq!(full, [0]);
    assert!(
        (larger - volume - cavity).abs() < 1e-6,
        "{larger} {volume} {cavity}"
    );
}

/// A function that waves by next to nothing about its threshold throughout a ball, and of which no
/// more is known than that.
#[derive(Debug)]
struct Level;

const WAVE: f64 = 1e-4;

impl Implicit for Level {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        let beyond = (point.length() - 1.0).max(0.0);
        let (sin, cos) = libm::sincos(40.0 * point.x);
        let wave = DVec3::X * (40.0 * WAVE * cos);
        let fall = if beyond > 0.0 {
            -point.normalize()
        } else {
            DVec3::ZERO
        };
        Jet {
            value: THRESHOLD * (1.0 + WAVE * sin - beyond),
            gradient: (THRESHOLD * (wave + fall)).to_array(),
        }
    }

    fn jet32(&self, _: [f32; 3]) -> Jet<f32> {
        unreachable!("meshes are made in double precision")
    }

    fn jet8(&self, _: [f32x8; 3]) -> Jet<f32x8> {
        unreachable!("meshes are made in double precision")
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let distance = ball.center.length();
        let value = |d: f64| THRESHOLD * (1.0 - (d - 1.0).max(0.0));
        Enclosure {
            value: [
                value(distance + ball.radius) - 2.0 * WAVE * THRESHOLD,
                value(distance - ball.radius) + 2.0 * WAVE * THRESHOLD,
            ],
            slope: 1.1 * THRESHOLD,
            curvature: f64::INFINITY,
        }
    }

    fn shares(&self, _: DVec3, _: &mut Vec<(u32, f64)>) {}

    fn support(&self) -> Option<Ball> {
        Some(Ball {
            center: DVec3::ZERO,
            radius: 1.0,
        })
    }
}

#[test]
fn a_region_at_the_threshold_is_told() {
    let options = Options {
        max_triangles: 20_000,
        ..Options::new(0.01)
    };
    let domain = box_of(Level.support().unwrap());
    let mut report = |_| ControlFlow::Continue(());
    let error = polygonize(&Level, &domain, &options, &mut Progress::new(&mut report))
        .map(|mesh| mesh.mesh.triangles.len())
        .unwrap_err();
    let MeshError::Flat { near } = error else {
        panic!("{error}")
    };
    assert!(DVec3::from_array(near).length() < 1.1, "{near:?}");
    assert!(error.to_string().contains("lie on each other"), "{error}");
}
