//! Painted triangles: one material with colours at the vertices, in every format that has such.

use crate::judges::assert_manifold;
use glam::DVec3;
use mesh::{Export, Format, Part};
use mesher::{Model, Progress, Wishes, mesh_scene};
use scene::{Element, Finish, Paint, Rgb, Scene, Shape};
use std::ops::ControlFlow;

const CORNERS: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// Diffuse colour of the finish, which the colours at the corners multiply.
const BASE: Rgb = [1.0, 0.5, 0.25];
const COLORS: [Rgb; 4] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.5],
    [0.25, 0.25, 1.0],
    [1.0, 1.0, 1.0],
];

fn finish(name: &str, diffuse: Rgb) -> Finish {
    Finish {
        name: name.into(),
        diffuse,
        ..Finish::default()
    }
}

/// A painted tetrahedron, each face of which has a tint of its own, as triangles or patches.
fn scene(face: &dyn Fn([DVec3; 3]) -> Shape) -> Scene {
    let mut scene = Scene {
        finishes: vec![finish("base", BASE)],
        ..Scene::default()
    };
    for (i, corners) in FACES.into_iter().enumerate() {
        let tint = scene.finishes.len() as u32;
        scene.finishes.push(finish("tint", [0.1 * i as f32; 3]));
        scene.elements.push(Element {
            finish: tint,
            paint: Some(Box::new(Paint {
                finish: 0,
                corners: corners.map(|i| COLORS[i]),
            })),
            ..Element::new(face(corners.map(|i| CORNERS[i])))
        });
    }
    scene
}

fn triangle(corners: [DVec3; 3]) -> Shape {
    Shape::triangle(corners, 0.0)
}

fn meshed(scene: &Scene) -> Model {
    let mut go_on = |_| ControlFlow::Continue(());
    mesh_scene(scene, &Wishes::default(), &mut Progress::new(&mut go_on)).unwrap()
}

/// The colour of a corner in a mesh: linear, up to rounding to a byte of sRGB.
fn assert_painted(name: &str, mesh: &mesh::TriangleMesh, unit: f64) {
    let colors = mesh
        .colors
        .as_ref()
        .unwrap_or_else(|| panic!("{name}: no colours"));
    for (position, color) in mesh.positions.iter().zip(colors) {
        let near = |i: &usize| (CORNERS[*i] * unit).distance(*position) < 1e-4 * unit;
        let corner = (0..4)
            .find(near)
            .unwrap_or_else(|| panic!("{name}: {position}"));
        for k in 0..3 {
            let expected = BASE[k] * COLORS[corner][k];
            assert!(
                (color[k] - expected).abs() < 5e-3,
                "{name}: {corner} {color:?}"
            );
        }
    }
}

#[test]
fn paint_is_vertex_colours_of_one_material_in_every_format() {
    let patch =
        |corners: [DVec3; 3]| Shape::patch(corners, corners.map(|p| (p - 0.25).normalize()));
    for (name, face) in [
        ("triangles", &triangle as &dyn Fn([DVec3; 3]) -> Shape),
        ("patches", &patch),
    ] {
        let model = meshed(&scene(face));
        assert_eq!(model.parts.len(), 1, "{name}");
        let part = &model.parts[0];
        assert!(part.is_closed, "{name}");
        assert_manifold(name, &part.mesh);
        assert_eq!(part.mesh.positions.len(), 4, "{name}");
        let groups: Vec<&str> = part.mesh.groups.iter().map(|g| g.name.as_str()).collect();
        assert_eq!(groups, ["base"], "{name}: not one for each tint");
        assert_eq!(part.mesh.groups[0].triangles, 0..4);
        assert_painted(name, &part.mesh, 1.0);
        let export = Export {
            name: name.into(),
            parts: vec![Part {
                name: part.name.clone(),
                mesh: part.mesh.clone(),
            }],
            millimetres: 10.0,
        };
        for format in [Format::Glb, Format::ThreeMf, Format::Obj, Format::Ply] {
            let written = &export.write(format).unwrap()[0];
            let read = mesh::read(&written.name, &written.bytes).unwrap();
            let unit = if format == Format::Glb { 0.01 } else { 10.0 };
            assert_painted(&written.name, &read, unit);
            assert!(
                read.groups.len() <= 1,
                "{}: {:?}",
                written.name,
                read.groups
            );
        }
    }
}

#[test]
fn thick_triangles_and_unpainted_shapes_beside_keep_their_colours() {
    let mut scene = scene(&|corners| Shape::triangle(corners, 1e-6));
    scene.finishes.push(finish("plain", [0.0, 0.0, 1.0]));
    scene.elements.truncate(1);
    scene.elements.push(Element {
        finish: scene.finishes.len() as u32 - 1,
        ..Element::new(Shape::sphere(DVec3::ONE * 5.0, 1.0))
    });
    let model = meshed(&scene);
    let part = &model.parts[0];
    assert!(part.is_closed);
    let names: Vec<&str> = part.mesh.groups.iter().map(|g| g.name.as_str()).collect();
    assert_eq!(names, ["base", "plain"]);
    let colors = part.mesh.colors.as_ref().unwrap();
    let (mut prism, mut ball) = (part.mesh.clone(), 0);
    prism.positions.truncate(6);
    prism.colors = Some(colors[..6].to_vec());
    assert_painted("prism", &prism, 1.0);
    for color in &colors[6..] {
        assert_eq!(*color, [0.0, 0.0, 1.0]);
        ball += 1;
    }
    assert!(ball > 100);

    // A finish that is not there is none to multiply.
    scene.elements.truncate(1);
    if let Some(paint) = &mut scene.elements[0].paint {
        paint.finish = 99;
    }
    let model = meshed(&scene);
    assert!(model.parts[0].mesh.colors.is_none());
    assert_eq!(model.parts[0].mesh.groups[0].name, "tint");
}
