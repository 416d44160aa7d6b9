//! Shapes, pixel by pixel, against the reference: silhouettes, normals and what hides what.

use crate::common::gpu::{Gpu, gpus};
use crate::common::reference::{self, Met};
use crate::common::scenes::{arc, by_index, by_normal, index_of, look, rotation};
use core::f64::consts::TAU;
use glam::{DMat3, DQuat, DVec3};
use scene::{Camera, Quadric, Scene, Shape};
use std::slice;
use trials::Random;

const SIZE: [u32; 2] = [56, 42];

/// Traces the reference picture, by rays through the middle of every pixel.
fn reference_picture(scene: &Scene) -> Vec<Option<Met>> {
    let projection = scene.camera.projection(SIZE[0], SIZE[1]);
    let mut all = Vec::new();
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let direction = projection.direction(
                (f64::from(x) + 0.5) / f64::from(SIZE[0]),
                (f64::from(y) + 0.5) / f64::from(SIZE[1]),
            );
            all.push(reference::first(scene, projection.eye, direction));
        }
    }
    all
}

/// Whether a pixel and its eight neighbours agree on something.
fn uniform<T: PartialEq>(x: u32, y: u32, of: impl Fn(u32, u32) -> T) -> bool {
    let here = of(x, y);
    let rows = y.saturating_sub(1)..=(y + 1).min(SIZE[1] - 1);
    rows.into_iter().all(|j| {
        let columns = x.saturating_sub(1)..=(x + 1).min(SIZE[0] - 1);
        columns.into_iter().all(|i| of(i, j) == here)
    })
}

/// Draws shapes, compares every pixel, and counts those which show something.
fn compare_pixels(gpu: &Gpu, what: &str, shapes: &[Shape], camera: Camera) -> u32 {
    let scene = by_index(shapes, camera);
    let expected = reference_picture(&scene);
    let at = |x: u32, y: u32| expected[(y * SIZE[0] + x) as usize];
    let index = |x: u32, y: u32| at(x, y).map(|met| met.element);
    let picture = gpu.draw(&scene, SIZE);
    let shades = [1.0, -1.0].map(|sign| gpu.draw(&by_normal(shapes, camera, sign), SIZE));

    let mut wrong = Vec::new();
    let mut edge_wrong = 0;
    let mut edges = 0;
    let mut hits = 0;
    let mut turned = Vec::new();
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let drawn = index_of(picture.at(x, y));
            let same = drawn == index(x, y);
            hits += u32::from(drawn.is_some());
            if uniform(x, y, index) {
                if !same {
                    wrong.push((x, y, drawn, at(x, y)));
                }
            } else {
                edges += 1;
                edge_wrong += u32::from(!same);
            }
            if let Some(met) = at(x, y)
                && same
            {
                let [plus, minus] = [&shades[0], &shades[1]].map(|p| DVec3::from(p.at(x, y)));
                let normal = plus - minus;
                // Kinks of the surface are where neighbours differ much; there one pixel's ray
                // may fall on this side or that.
                let smooth = uniform(x, y, |i, j| {
                    at(i, j).is_some_and(|other| other.normal.dot(met.normal) > 0.9)
                });
                if smooth && normal.distance(met.normal) > 0.02 {
                    turned.push((x, y, normal, met.normal));
                }
            }
        }
    }
    let name = &gpu.name;
    // The cells of a quadric are flat, so its outlines are off by a small part of a pixel; where
    // two of them nearly touch, a pixel that is uniform in the reference may see between them, and
    // at the rim of its box the normals of a sliver's corners lie far apart.
    let has_cells = shapes.iter().any(|s| matches!(s, Shape::Quadric(_)));
    let (few, share) = if has_cells { (2, 0.04) } else { (0, 0.02) };
    assert!(
        wrong.len() <= few,
        "{what} on {name}: {} wrong, {:?}",
        wrong.len(),
        &wrong[..wrong.len().min(5)]
    );
    assert!(
        f64::from(edge_wrong) <= share * f64::from(edges) + 1.0,
        "{what} on {name}: {edge_wrong} of {edges} edge pixels differ"
    );
    assert!(
        turned.len() <= few,
        "{what} on {name}: {} normals, {:?}",
        turned.len(),
        &turned[..turned.len().min(5)]
    );
    hits
}

/// Compares every pixel of shapes in a view in which something must be seen.
fn compare(gpu: &Gpu, what: &str, shapes: &[Shape], camera: Camera) {
    let hits = compare_pixels(gpu, what, shapes, camera);
    assert!(hits > 0, "{what} on {}: nothing drawn", gpu.name);
}

/// Compares on every device, from near, from far, from the side and obliquely.
fn compare_around(what: &str, shape: Shape, center: DVec3, size: f64) {
    for gpu in gpus() {
        for (view, way, fov) in [
            ("front", DVec3::new(0.0, 0.0, 3.0), 45.0),
            ("side", DVec3::new(3.0, 0.0, 0.0), 45.0),
            ("oblique", DVec3::new(1.9, 1.3, 2.1), 40.0),
            ("below", DVec3::new(-0.4, -3.0, 0.3), 45.0),
            ("far", DVec3::new(300.0, -200.0, 500.0), 0.25),
            ("near, wide", DVec3::new(0.7, 1.0, 1.1), 120.0),
        ] {
            let camera = Camera {
                eye: center + way * size,
                target: center,
                up: DVec3::new(0.1, 1.0, 0.2),
                fov,
                // Any camera may be shifted.
                shift: [0.3, -0.2],
                ..Camera::default()
            };
            compare(
                gpu,
                &format!("{what}, {view}"),
                slice::from_ref(&shape),
                camera,
            );
        }
    }
}

fn sphere(center: [f64; 3], radius: f64) -> Shape {
    Shape::sphere(center.into(), radius)
}

fn cylinder(base: [f64; 3], apex: [f64; 3], radius: f64) -> Shape {
    Shape::cylinder(base.into(), apex.into(), radius)
}

fn triangle(corners: [[f64; 3]; 3], radius: f64) -> Shape {
    Shape::triangle(corners.map(DVec3::from), radius)
}

#[test]
fn spheres() {
    compare_around("sphere", sphere([0.2, -0.1, 0.3], 1.0), DVec3::ZERO, 1.0);
}

#[test]
fn cylinders() {
    let rod = cylinder([-0.8, -0.5, 0.1], [0.9, 0.6, -0.2], 0.3);
    compare_around("rod", rod, DVec3::ZERO, 1.0);
    let coin = cylinder([0.0, -0.1, 0.0], [0.02, 0.1, 0.01], 1.0);
    compare_around("coin", coin, DVec3::ZERO, 1.0);
    let upright = cylinder([0.0, 0.0, -0.7], [0.0, 0.0, 0.7], 0.5);
    compare_around("along the view", upright, DVec3::ZERO, 1.0);
}

#[test]
fn arcs_of_every_angle() {
    for angle in [
        0.3,
        1.0,
        core::f64::consts::FRAC_PI_2,
        2.5,
        3.2,
        4.5,
        6.0,
        6.3,
    ] {
        let angle = f64::min(angle, core::f64::consts::TAU);
        let shape = arc(DVec3::ZERO, rotation(), 0.8, angle, 0.25);
        compare_around(&format!("arc of {angle}"), shape, DVec3::ZERO, 1.0);
    }
}

#[test]
fn arcs_thin_fat_flat_and_self_crossing() {
    let thin = arc(DVec3::ZERO, DQuat::IDENTITY, 1.0, 4.0, 0.03);
    compare_around("thin", thin, DVec3::ZERO, 1.0);
    let fat = arc(DVec3::ZERO, rotation(), 0.5, 5.0, 0.49);
    compare_around("fat", fat, DVec3::ZERO, 1.0);
    let spindle = arc(DVec3::ZERO, rotation(), 0.4, 4.0, 0.7);
    compare_around("spindle", spindle, DVec3::ZERO, 1.0);
    let closed_spindle = arc(DVec3::ZERO, rotation(), 0.4, core::f64::consts::TAU, 0.7);
    compare_around("closed spindle", closed_spindle, DVec3::ZERO, 1.0);
    // Nearly straight: a piece 2 long of a circle of radius 500.
    let center = rotation() * DVec3::new(-500.0, 0.0, 0.0);
    let rotation = rotation() * DQuat::from_rotation_z(-0.002);
    let bent = arc(center, rotation, 500.0, 0.004, 0.2);
    for gpu in gpus() {
        compare(
            gpu,
            "nearly straight",
            slice::from_ref(&bent),
            look([0.5, 1.0, 3.0], [0.0, 0.0, 0.0], 45.0),
        );
    }
}

#[test]
fn triangles() {
    let corners = [[-0.9, -0.6, 0.2], [0.8, -0.4, -0.3], [0.1, 0.9, 0.1]];
    compare_around("flat", triangle(corners, 0.0), DVec3::ZERO, 1.0);
    compare_around("prism", triangle(corners, 0.2), DVec3::ZERO, 1.0);
    let sliver = [[-0.9, -0.6, 0.2], [0.8, 0.4, -0.3], [0.4, 0.3, -0.1]];
    compare_around("sliver", triangle(sliver, 0.1), DVec3::ZERO, 1.0);
}

fn cone(ends: [[f64; 3]; 2], radii: [f64; 2]) -> Shape {
    Shape::cone(ends[0].into(), radii[0], ends[1].into(), radii[1])
}

#[test]
fn cones() {
    let ends = [[-0.8, -0.5, 0.1], [0.9, 0.6, -0.2]];
    compare_around("blunt cone", cone(ends, [0.5, 0.2]), DVec3::ZERO, 1.0);
    compare_around("hat", cone(ends, [0.0, 0.6]), DVec3::ZERO, 1.0);
    compare_around("needle", cone(ends, [0.04, 0.0]), DVec3::ZERO, 1.0);
    let flat = [[0.0, -0.1, 0.0], [0.02, 0.1, 0.01]];
    compare_around("plate", cone(flat, [1.0, 0.3]), DVec3::ZERO, 1.0);
    let upright = [[0.0, 0.0, -0.7], [0.0, 0.0, 0.7]];
    compare_around(
        "along the view",
        cone(upright, [0.6, 0.1]),
        DVec3::ZERO,
        1.0,
    );
}

#[test]
fn pipes() {
    let pipe = Shape::pipe(DVec3::new(-0.8, -0.5, 0.1), DVec3::new(0.9, 0.6, -0.2), 0.4);
    compare_around("pipe", pipe, DVec3::ZERO, 1.0);
    let upright = Shape::pipe(DVec3::NEG_Z * 0.5, DVec3::Z * 0.5, 0.7);
    compare_around("along the view", upright, DVec3::ZERO, 1.0);
}

#[test]
fn boxes() {
    let rotation = rotation();
    for (what, axes) in [
        ("cube", [DVec3::X, DVec3::Y, DVec3::Z]),
        ("board", [DVec3::X, DVec3::Y * 0.4, DVec3::Z * 0.05]),
        (
            "sheared",
            [
                DVec3::X,
                DVec3::new(0.4, 0.6, 0.0),
                DVec3::new(0.1, -0.2, 0.5),
            ],
        ),
    ] {
        let axes = axes.map(|axis| rotation * axis * 0.7);
        let center = DVec3::new(0.1, 0.0, -0.1);
        compare_around(what, Shape::cuboid(center, axes), DVec3::ZERO, 1.0);
    }
}

#[test]
fn patches() {
    let corners = [[-0.9, -0.6, 0.2], [0.8, -0.4, -0.3], [0.1, 0.9, 0.1]].map(DVec3::from);
    let round = corners.map(|corner| corner + DVec3::new(0.1, 0.2, 1.0));
    let flat = [DVec3::new(0.1, -0.1, 1.0) * 7.0; 3];
    // Bent outwards far enough that some would face away.
    let bent = corners.map(|corner| corner * 3.0 + DVec3::Z);
    for (what, normals) in [("round", round), ("flat", flat)] {
        compare_around(what, Shape::patch(corners, normals), DVec3::ZERO, 1.0);
    }
    for gpu in gpus() {
        let shape = Shape::patch(corners, bent);
        let camera = look([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], 45.0);
        compare(gpu, "bent", slice::from_ref(&shape), camera);
    }
}

#[test]
fn quadrics() {
    fn cut(square: DMat3, linear: DVec3, constant: f64) -> Shape {
        let half = DVec3::new(0.9, 1.0, 0.8);
        let mut quadric = Quadric::new(square, linear, constant, -half, half).expect("a quadric");
        quadric.axes = quadric.axes.map(|axis| rotation() * axis);
        Shape::Quadric(Box::new(quadric))
    }
    fn diagonal(x: f64, y: f64, z: f64) -> DMat3 {
        DMat3::from_diagonal(DVec3::new(x, y, z))
    }
    for (what, shape) in [
        ("ellipsoid", cut(diagonal(2.0, 1.3, 3.0), DVec3::ZERO, -1.0)),
        ("cut ball", cut(diagonal(1.0, 1.0, 1.0), DVec3::ZERO, -1.2)),
        ("bowl", cut(diagonal(1.0, 1.0, 0.0), DVec3::Z * -0.5, -0.5)),
        ("waist", cut(diagonal(1.0, 1.0, -0.7), DVec3::ZERO, -0.2)),
        ("plane", cut(DMat3::ZERO, DVec3::new(0.3, 0.2, 1.0), 0.1)),
    ] {
        compare_around(what, shape, DVec3::ZERO, 1.0);
    }
}

#[test]
fn planes() {
    for gpu in gpus() {
        for radius in [0.0, 0.4] {
            let floor = Shape::plane(
                DVec3::new(5.0, -1.0, 7.0),
                DVec3::new(0.1, 1.0, 0.05).normalize(),
                radius,
            );
            let ball = sphere([0.0, -0.8, 0.0], 1.0);
            for (view, eye) in [
                ("above", [1.0, 2.0, 5.0]),
                ("below", [1.0, -4.0, 5.0]),
                ("inside", [0.5, -0.9, 3.0]),
            ] {
                compare(
                    gpu,
                    &format!("plane {radius}, {view}"),
                    &[floor.clone(), ball.clone()],
                    look(eye, [0.0, -0.5, 0.0], 60.0),
                );
            }
        }
    }
}

#[test]
fn eyes_inside_see_the_inside() {
    let ring = arc(
        DVec3::ZERO,
        DQuat::IDENTITY,
        1.0,
        core::f64::consts::TAU,
        0.3,
    );
    let open = arc(DVec3::ZERO, DQuat::IDENTITY, 1.0, 4.0, 0.3);
    let corners = [[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [0.0, 3.0, 0.0]];
    for gpu in gpus() {
        for (what, shape) in [
            ("sphere", sphere([0.8, 0.1, 0.2], 0.6)),
            ("cylinder", cylinder([0.0; 3], [2.0, 0.3, 0.1], 0.4)),
            ("ring", ring.clone()),
            ("open ring", open.clone()),
            ("prism", triangle(corners, 0.5)),
        ] {
            for target in [[0.0, 0.0, 5.0], [1.0, 2.0, 0.0], [-1.0, -0.2, 0.0]] {
                let camera = look([1.0, 0.1, 0.05], target, 90.0);
                compare(
                    gpu,
                    &format!("inside a {what}"),
                    slice::from_ref(&shape),
                    camera,
                );
            }
        }
    }
}

#[test]
fn eyes_in_the_box_but_outside_the_shape() {
    // In the hole of a ring, and beside a slanted rod.
    let ring = arc(DVec3::ZERO, rotation(), 1.0, 5.5, 0.2);
    let rod = cylinder([-1.0; 3], [1.0; 3], 0.1);
    for gpu in gpus() {
        let mut hits = [0; 2];
        for target in [[0.0, 0.0, 5.0], [1.0, 2.0, 0.0], [-1.0, -0.2, 0.1]] {
            let camera = look([0.1, 0.05, -0.1], target, 100.0);
            hits[0] += compare_pixels(gpu, "in the hole", slice::from_ref(&ring), camera);
            let camera = look([0.5, -0.5, 0.3], target, 100.0);
            hits[1] += compare_pixels(gpu, "beside the rod", slice::from_ref(&rod), camera);
        }
        assert!(hits.iter().all(|&count| count > 50), "{hits:?}");
    }
}

#[test]
fn edge_on_things_are_thin_but_there() {
    let card = triangle([[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 0.0, 1.0]], 0.05);
    let coin = cylinder([0.0, -0.05, 0.0], [0.0, 0.05, 0.0], 1.0);
    let ring = arc(
        DVec3::ZERO,
        DQuat::from_rotation_x(core::f64::consts::FRAC_PI_2),
        1.0,
        6.0,
        0.05,
    );
    for gpu in gpus() {
        for (what, shape) in [("card", &card), ("coin", &coin), ("ring", &ring)] {
            let camera = look([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0);
            compare(
                gpu,
                &format!("{what}, edge on"),
                slice::from_ref(shape),
                camera,
            );
        }
    }
}

#[test]
fn shapes_hide_each_other_where_they_meet() {
    // Sixteen shapes of all kinds through each other.
    let mut shapes = Vec::new();
    let mut random = Random::new(7);
    for i in 0..16 {
        let [p, q, r] = [(); 3].map(|()| random.vector(1.0).to_array());
        let size = random.range(0.2, 0.3);
        shapes.push(match i % 4 {
            0 => sphere(p, 2.0 * size),
            1 => cylinder(p, q, size),
            2 => {
                let rotation = DQuat::from_xyzw(q[0], q[1], q[2], r[0]).normalize();
                arc(p.into(), rotation, 0.8, 1.0 + 4.0 * r[1].abs(), size)
            }
            _ => triangle([p, q, r], 0.3 * size),
        });
    }
    for gpu in gpus() {
        for eye in [[0.0, 0.0, 5.0], [4.0, 2.0, -1.0], [0.3, -0.2, 0.1]] {
            let camera = look(eye, [0.05, 0.0, 0.0], 50.0);
            compare(gpu, "a heap", &shapes, camera);
        }
    }
}

#[test]
fn tiny_and_huge_worlds_look_the_same() {
    let offset = DVec3::new(3.0, -2.0, 1.0);
    for scale in [1e-9, 1e-3, 1e6, 1e12] {
        let at = |x: f64, y: f64, z: f64| ((DVec3::new(x, y, z) + offset) * scale).to_array();
        let shapes = [
            sphere(at(0.3, 0.2, 0.1), 0.5 * scale),
            cylinder(at(-1.0, -0.5, 0.0), at(1.0, 0.3, 0.2), 0.2 * scale),
            arc(offset * scale, rotation(), 0.8 * scale, 4.0, 0.2 * scale),
            triangle(
                [at(-1.0, 0.0, 0.5), at(1.0, 0.2, -0.5), at(0.0, 1.0, 0.0)],
                0.05 * scale,
            ),
        ];
        let camera = look(at(0.5, 1.0, 4.0), at(0.0, 0.0, 0.0), 40.0);
        for gpu in gpus() {
            compare(gpu, &format!("world of {scale}"), &shapes, camera);
        }
    }
}

#[test]
fn a_grain_far_from_the_middle_of_a_large_scene_is_sharp() {
    // The scene is 2000 across, the grains 0.001: f32 positions would be off by half a grain.
    let far = 999.8761;
    let shapes = [
        sphere([-1000.0, 0.0, 0.0], 1.0),
        sphere([far, 0.0, 0.0], 1e-3),
        cylinder([far, -0.0015, 0.0], [far + 0.001, 0.0015, 0.0008], 3e-4),
        arc(DVec3::new(far, 0.0, 0.0), rotation(), 1.2e-3, 4.0, 2e-4),
    ];
    let camera = look([far + 0.002, 0.001, 0.006], [far, 0.0, 0.0], 40.0);
    for gpu in gpus() {
        compare(gpu, "grain", &shapes, camera);
    }
}

/// A ball of patches, of which no ray passes between two.
#[test]
fn a_mesh_of_patches_has_no_gaps() {
    fn at(i: u32, j: u32) -> DVec3 {
        let (a, b) = (f64::from(i) * TAU / 48.0, f64::from(j) * TAU / 80.0 - 0.3);
        let (sine, cosine) = libm::sincos(a);
        let (low, high) = libm::sincos(b);
        DVec3::new(cosine * high, sine * high, low)
    }
    // More than the half of the ball that is seen, in one colour.
    let mut shapes = Vec::new();
    for i in 0..48 {
        for j in 0..24 {
            for (a, b, c) in [((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))] {
                let corners = [a, b, c].map(|(x, y)| at(i + x, j + y));
                shapes.push(Shape::patch(corners, corners));
            }
        }
    }
    for gpu in gpus() {
        for (distance, fov) in [(3.0, 20.0), (300.0, 0.2), (3000.0, 0.02)] {
            let way = rotation() * DVec3::Z;
            let way = way.with_z(way.z.abs() + 1.0).normalize();
            let camera = Camera {
                eye: way * distance,
                target: DVec3::Z * 0.3,
                up: DVec3::Y,
                fov,
                shift: [-0.2, 0.1],
                ..Camera::default()
            };
            let mut scene = by_index(&shapes, camera);
            for element in &mut scene.elements {
                element.finish = 0;
            }
            let picture = gpu.draw(&scene, [120, 90]);
            let missed = (0..90)
                .flat_map(|y| (0..120).map(move |x| (x, y)))
                .filter(|&(x, y)| index_of(picture.at(x, y)).is_none());
            assert_eq!(missed.collect::<Vec<_>>(), [], "{distance} on {}", gpu.name);
        }
    }
}
