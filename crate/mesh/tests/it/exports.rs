//! Files that are written: through our own readers, and through readers that others wrote.

use crate::solids::{sphere, torus};
use glam::DVec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error as Judgement, MeshGL};
use mesh::{
    Export, ExportedFile, Format, Group, HalfEdgeMesh, Material, Part, TriangleMesh, limits, read,
    read_mtl,
};
use std::io::Cursor;

fn material(name: &str, color: [f32; 3], roughness: f32) -> Material {
    Material {
        name: name.into(),
        color,
        roughness,
    }
}

/// Colours that 8 bits of sRGB hold exactly.
fn exact(r: u8, g: u8, b: u8) -> [f32; 3] {
    [r, g, b].map(mesh::linear_from_srgb)
}

/// Returns a sphere with vertex colours and normals, and a torus of two materials.
fn export() -> Export {
    let mut ball = sphere(4);
    ball.normals = Some(ball.positions.clone());
    let level = |x: f64| ((x * 0.5 + 0.5) * 255.0) as u8;
    ball.colors = Some(
        ball.positions
            .iter()
            .map(|p| exact(level(p.x), level(p.y), level(p.z)))
            .collect(),
    );
    let mut ring = torus(8, 6);
    ring.positions.iter_mut().for_each(|p| *p += DVec3::Z * 3.0);
    ring.normals = Some(vec![DVec3::Z * 2.0; ring.positions.len()]);
    let group = |name: &str, material, triangles| Group {
        name: name.into(),
        material: Some(material),
        triangles,
    };
    let red = material("red <&\"> wax", exact(200, 30, 10), 0.25);
    let blue = material("blue", exact(10, 20, 250), 0.7);
    ring.groups = vec![group("ring", red, 0..40), group("ring", blue, 40..96)];
    Export {
        name: "two".into(),
        parts: vec![
            Part {
                name: "ball".into(),
                mesh: ball,
            },
            Part {
                name: "ring".into(),
                mesh: ring,
            },
        ],
        millimetres: 12.5,
    }
}

fn write(export: &Export, format: Format) -> Vec<ExportedFile> {
    export
        .write(format)
        .unwrap_or_else(|e| panic!("{format:?}: {e}"))
}

/// Corners of all triangles, as every format should have them (millimetres).
fn expectation(export: &Export) -> Vec<[DVec3; 3]> {
    let parts = export.round().unwrap();
    let all = parts
        .iter()
        .flat_map(|m| (0..m.triangles.len()).map(|i| m.corners(i)));
    all.collect()
}

#[test]
fn our_readers_read_what_is_written() {
    let export = export();
    let wanted = expectation(&export);
    let [ball, ring] = [&export.parts[0].mesh, &export.parts[1].mesh];
    for format in Format::ALL {
        let files = write(&export, format);
        let mut mesh = read(&files[0].name, &files[0].bytes).unwrap();
        assert_eq!(mesh.triangles.len(), wanted.len(), "{format:?}");
        // GLB is in metres, by a scale that our reader takes as a 32-bit number.
        let (unit, slack) = match format {
            Format::Glb => (1000.0, 1e-6),
            // Decimals that are exact as 32-bit numbers only.
            Format::Obj | Format::ThreeMf => (1.0, 1e-7),
            Format::Stl | Format::Ply => (1.0, 0.0),
        };
        for (i, corners) in wanted.iter().enumerate() {
            for (a, b) in mesh.corners(i).iter().zip(corners) {
                assert!(
                    a.distance(*b / unit) <= slack * b.length() / unit,
                    "{format:?} {a} {b}"
                );
            }
        }
        assert_eq!(
            mesh.normals.is_some(),
            !matches!(format, Format::Stl | Format::ThreeMf)
        );
        if let Some(normals) = &mesh.normals {
            let own = |i: usize| mesh.triangles[i].map(|v| normals[v as usize]);
            for i in 0..ball.triangles.len() {
                for (n, v) in own(i).iter().zip(ball.triangles[i]) {
                    assert!(n.distance(ball.positions[v as usize]) < 1e-6, "{format:?}");
                }
            }
            assert!(
                own(wanted.len() - 1)
                    .iter()
                    .all(|n| n.distance(DVec3::Z) < 1e-6)
            );
        }
        assert_eq!(mesh.colors.is_some(), format != Format::Stl, "{format:?}");
        if let Some(colors) = &mesh.colors {
            for (i, triangle) in ball.triangles.iter().enumerate() {
                for (own, given) in mesh.triangles[i].iter().zip(triangle) {
                    let [a, b] = [
                        colors[*own as usize],
                        ball.colors.as_ref().unwrap()[*given as usize],
                    ];
                    let slack = if format == Format::Obj { 3e-4 } else { 1e-6 };
                    for (x, y) in a.iter().zip(b) {
                        assert!((x - y).abs() < slack, "{format:?}: {a:?} {b:?}");
                    }
                }
            }
        }
        if let Some(library) = files.get(1) {
            assert_eq!(library.name, "two.mtl");
            mesh.set_materials(&read_mtl(&library.bytes).unwrap());
        }
        // Names and materials.
        let names: Vec<&str> = mesh.groups.iter().map(|g| g.name.as_str()).collect();
        match format {
            Format::Stl | Format::Ply => assert!(names.is_empty()),
            _ => assert_eq!(names, ["ball", "ring", "ring"], "{format:?}"),
        }
        for (group, own) in mesh.groups.iter().skip(1).zip(&ring.groups) {
            let first = ball.triangles.len() as u32;
            assert_eq!(
                group.triangles,
                own.triangles.start + first..own.triangles.end + first
            );
            let [read, given] = [group, own].map(|g| g.material.as_ref().unwrap());
            assert_eq!(read.name, given.name, "{format:?}");
            // 3MF has no roughness.
            if format != Format::ThreeMf {
                assert!(
                    (read.roughness - given.roughness).abs() < 1e-6,
                    "{format:?}"
                );
            }
            for (x, y) in read.color.iter().zip(given.color) {
                assert!(
                    (x - y).abs() < 3e-4,
                    "{format:?}: {:?} {:?}",
                    read.color,
                    given.color
                );
            }
        }
        assert_eq!(write(&export, format), files, "the same bytes every time");
    }
}

#[test]
fn stl_is_read_by_stl_io() {
    let export = export();
    let file = write(&export, Format::Stl).remove(0);
    let mesh = stl_io::read_stl(&mut Cursor::new(file.bytes)).unwrap();
    let wanted = expectation(&export);
    assert_eq!(mesh.faces.len(), wanted.len());
    for (face, corners) in mesh.faces.iter().zip(&wanted) {
        for (i, corner) in face.vertices.iter().zip(corners) {
            let v = &mesh.vertices[*i];
            assert_eq!(DVec3::from([v[0], v[1], v[2]].map(f64::from)), *corner);
        }
    }
}

#[test]
fn ply_is_read_by_ply_rs() {
    use ply_rs_bw::parser::Parser;
    use ply_rs_bw::ply::{DefaultElement, Property};
    let export = export();
    let file = write(&export, Format::Ply).remove(0);
    let ply = Parser::<DefaultElement>::new()
        .read_ply(&mut Cursor::new(file.bytes))
        .unwrap();
    let wanted = expectation(&export);
    let float = |p: &Property| match p {
        Property::Float(x) => f64::from(*x),
        other => panic!("{other:?}"),
    };
    let vertices = &ply.payload["vertex"];
    let faces = &ply.payload["face"];
    assert_eq!(faces.len(), wanted.len());
    for (face, corners) in faces.iter().zip(&wanted) {
        let Property::ListInt(indices) = &face["vertex_indices"] else {
            panic!("{face:?}")
        };
        for (i, corner) in indices.iter().zip(corners) {
            let v = &vertices[*i as usize];
            assert_eq!(
                DVec3::new(float(&v["x"]), float(&v["y"]), float(&v["z"])),
                *corner
            );
        }
    }
    // The torus has the colours of its materials.
    assert!(matches!(
        vertices[vertices.len() - 1]["blue"],
        Property::UChar(250)
    ));
}

#[test]
fn ply_has_normals_if_one_part_has() {
    let mut export = export();
    export.parts[1].mesh.normals = None;
    let files = write(&export, Format::Ply);
    let read = read(&files[0].name, &files[0].bytes).unwrap();
    let normals = read.normals.clone().unwrap();
    let first = export.parts[0].mesh.positions.len();
    for (i, n) in normals.iter().enumerate().skip(first) {
        assert!((n.length() - 1.0).abs() < 1e-6);
        // Each looks as its triangles do.
        let around = (0..read.triangles.len()).filter(|t| read.triangles[*t].contains(&(i as u32)));
        let mean: DVec3 = around
            .map(|t| {
                let [a, b, c] = read.corners(t);
                (b - a).cross(c - a)
            })
            .sum();
        assert!(n.dot(mean.normalize()) > 0.999, "{i}");
    }
    assert!(normals.len() > first);
}

#[test]
fn obj_is_read_by_tobj() {
    let export = export();
    let files = write(&export, Format::Obj);
    let options = tobj::LoadOptions {
        single_index: true,
        ..Default::default()
    };
    let (models, materials) =
        tobj::load_obj_buf(&mut Cursor::new(&files[0].bytes), &options, |_| {
            tobj::load_mtl_buf(&mut Cursor::new(&files[1].bytes))
        })
        .unwrap();
    let materials = materials.unwrap();
    let wanted = expectation(&export);
    let mut all = Vec::new();
    for model in &models {
        let at = |i: u32| {
            let p = &model.mesh.positions[3 * i as usize..][..3];
            DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
        };
        all.extend(
            model
                .mesh
                .indices
                .chunks(3)
                .map(|t| [at(t[0]), at(t[1]), at(t[2])]),
        );
    }
    assert_eq!(all, wanted);
    let names: Vec<&str> = models.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["ball", "ring", "ring"]);
    let used = &materials[models[2].mesh.material_id.unwrap()];
    assert_eq!(used.name, "blue");
    let diffuse = used.diffuse.unwrap();
    assert!((diffuse[2] - 250.0 / 255.0).abs() < 1e-3, "{diffuse:?}");
}

#[test]
fn glb_is_read_by_gltf() {
    let export = export();
    let file = write(&export, Format::Glb).remove(0);
    // Checks the whole description against the specification.
    let gltf = gltf::Gltf::from_slice(&file.bytes).unwrap();
    let blob = gltf.blob.clone().unwrap();
    let mut all = Vec::new();
    let mut roughness = Vec::new();
    for node in gltf.scenes().next().unwrap().nodes() {
        let (shift, _, scale) = node.transform().decomposed();
        assert_eq!((shift, scale), ([0.0; 3], [0.001; 3]));
        for primitive in node.mesh().unwrap().primitives() {
            let reader = primitive.reader(|_| Some(&blob));
            let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
            let bounds = primitive.bounding_box();
            for p in &positions {
                assert!((0..3).all(|k| bounds.min[k] <= p[k] && p[k] <= bounds.max[k]));
            }
            assert_eq!(reader.read_normals().unwrap().count(), positions.len());
            assert_eq!(reader.read_colors(0).is_some(), node.name() == Some("ball"));
            let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
            let corner = |i: u32| DVec3::from(positions[i as usize].map(f64::from));
            all.extend(
                indices
                    .chunks(3)
                    .map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]),
            );
            let surface = primitive.material().pbr_metallic_roughness();
            roughness.push(surface.roughness_factor());
            if node.name() == Some("ring") {
                assert_eq!(surface.metallic_factor(), 0.0);
                assert!(surface.base_color_factor()[0] < 0.6);
            }
        }
    }
    assert_eq!(all, expectation(&export));
    // Without a material glTF's own, which is rough.
    assert_eq!(roughness, [1.0, 0.25, 0.7]);
}

#[test]
fn vertex_colours_make_glb_materials_white() {
    let mut export = export();
    let ball = &mut export.parts[0].mesh;
    ball.groups.push(Group {
        name: "half".into(),
        material: Some(material("dark", [0.1; 3], 0.5)),
        triangles: 10..20,
    });
    let file = write(&export, Format::Glb).remove(0);
    let mesh = read("x.glb", &file.bytes).unwrap();
    let dark = mesh
        .groups
        .iter()
        .filter_map(|g| g.material.as_ref())
        .find(|m| m.name == "dark");
    assert_eq!(dark.unwrap().color, [1.0; 3]);
}

fn in_manifold_rust(mesh: &TriangleMesh) -> Manifold {
    let positions = mesh.positions.iter().flat_map(|p| p.to_array());
    Manifold::from_mesh_gl(&MeshGL {
        num_prop: 3,
        vert_properties: positions.map(|x| x as f32).collect(),
        tri_verts: mesh.triangles.as_flattened().to_vec(),
        ..MeshGL::default()
    })
}

/// Closed manifolds by our test are such for `manifold-rust`, too, of the same genus; and what we
/// do not, is not.
#[test]
fn manifold_rust_agrees() {
    for (mesh, genus) in [(sphere(5), 0), (torus(9, 7), 1)] {
        let manifold = in_manifold_rust(&mesh);
        assert!(matches!(manifold.status(), Judgement::NoError));
        assert_eq!(
            (manifold.genus(), manifold.num_tri()),
            (genus, mesh.triangles.len())
        );
        assert!((manifold.volume() - mesh.signed_volume()).abs() < 1e-5);
        assert!((manifold.surface_area() - mesh.area()).abs() < 1e-4);
        assert!(mesh::Topology::of(&mesh).unwrap().is_closed_manifold());
        let mut open = mesh.clone();
        open.triangles.pop();
        assert!(!matches!(
            in_manifold_rust(&open).status(),
            Judgement::NoError
        ));
        assert!(!mesh::Topology::of(&open).unwrap().is_closed_manifold());
        let mut turned = mesh.clone();
        turned.triangles[3].swap(0, 1);
        assert!(!matches!(
            in_manifold_rust(&turned).status(),
            Judgement::NoError
        ));
        assert!(!mesh::Topology::of(&turned).unwrap().is_closed_manifold());
        // Edited meshes stay what they are.
        let mut edited = HalfEdgeMesh::from_triangles(&mesh).unwrap();
        for h in edited.edges().collect::<Vec<_>>() {
            if !edited.has_half_edge(h) {
                continue;
            }
            let at = edited.position(edited.target(h));
            let _ = edited.collapse_edge(h, at);
            if edited.face_count() < 40 {
                break;
            }
        }
        let manifold = in_manifold_rust(&edited.to_triangles().unwrap());
        assert!(matches!(manifold.status(), Judgement::NoError));
        assert_eq!(manifold.genus(), genus);
    }
}

#[test]
fn meshes_that_cannot_be_written_are_errors() {
    let told = |change: &dyn Fn(&mut Export)| {
        let mut export = export();
        change(&mut export);
        let errors = Format::ALL.map(|format| export.write(format).unwrap_err().to_string());
        assert!(errors.iter().all(|e| *e == errors[0]));
        errors[0].clone()
    };
    assert!(told(&|e| e.parts.clear()).contains("no triangles"));
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(told(&|e| e.millimetres = length).contains("positive number"));
    }
    let ball = |e: &mut Export, change: fn(&mut TriangleMesh)| change(&mut e.parts[0].mesh);
    assert!(told(&|e| ball(e, |m| m.triangles[0][1] = 9999)).contains("`ball` has a triangle"));
    assert!(told(&|e| ball(e, |m| m.positions[0].x = 1e40)).contains("too far away"));
    assert!(told(&|e| ball(e, |m| m.positions[0].x = f64::NAN)).contains("too far away"));
    assert!(told(&|e| ball(e, |m| m.normals = Some(vec![]))).contains("not as many normals"));
    assert!(told(&|e| ball(e, |m| m.colors = Some(vec![]))).contains("not as many normals"));
    let ring = |e: &mut Export, change: fn(&mut TriangleMesh)| change(&mut e.parts[1].mesh);
    assert!(told(&|e| ring(e, |m| m.groups[0].triangles.end = 50)).contains("overlap"));
    assert!(told(&|e| ring(e, |m| m.groups[1].triangles.end = 500)).contains("overlap"));
    assert!(
        told(&|e| ring(e, |m: &mut TriangleMesh| m.groups[0].material =
            Some(material("", [f32::NAN; 3], 0.0))))
        .contains("no number")
    );
    assert!(
        told(&|e| ball(e, |m: &mut TriangleMesh| m.triangles =
            vec![[0, 1, 2]; limits::MAX_EXPORT_TRIANGLES]))
        .contains("larger tolerance")
    );
    let groups = |m: &mut TriangleMesh| m.groups = vec![Group::default(); limits::MAX_MATERIALS];
    assert!(told(&|e| ring(e, groups)).contains("parts and groups"));
}

/// Far from the origin all vertices stay apart in every format, and GLB's nodes move them back.
#[test]
fn what_is_far_away_keeps_its_shape() {
    let far = DVec3::new(500_000.0, 4_649_776.0, 12.0);
    let mut mesh = sphere(4);
    mesh.positions.iter_mut().for_each(|p| *p += far);
    fn part(mesh: &TriangleMesh) -> Part {
        Part {
            name: "ball".into(),
            mesh: mesh.clone(),
        }
    }
    let export = Export {
        name: "far".into(),
        parts: vec![part(&mesh)],
        millimetres: 50.0,
    };
    let shift = export.shift();
    assert!(shift.distance(far * 50.0) <= 1.0, "{shift}");
    assert!(mesh::describe_shift(shift).is_some_and(|said| said.contains("25000000 ")));
    for format in Format::ALL {
        let file = write(&export, format).remove(0);
        let back = read(&format!("far.{}", format.extension()), &file.bytes).unwrap();
        assert_eq!(back.triangles.len(), mesh.triangles.len());
        // Readers take GLB's nodes into account, which move by metres in 32 bits.
        let (unit, moved, within) = match format {
            Format::Glb => (1000.0, shift, 1e-7 * shift.length()),
            _ => (1.0, DVec3::ZERO, 0.0),
        };
        for i in 0..mesh.triangles.len() {
            let wanted = mesh.corners(i).map(|p| p * 50.0 - shift);
            for (own, wanted) in back.corners(i).iter().zip(wanted) {
                let own = *own * unit - moved;
                assert!(
                    own.distance(wanted) <= 1e-4 + within,
                    "{format:?}: {own} {wanted}"
                );
            }
        }
    }
    mesh.positions.iter_mut().for_each(|p| *p -= far);
    let near = Export {
        parts: vec![part(&mesh)],
        ..export
    };
    assert_eq!(near.shift(), DVec3::ZERO);
}

#[test]
fn names_do_no_harm() {
    let mut export = export();
    let bad = "a\nf 1 2 3 \\\r#\u{0}\u{fffe}<&>\"']]>";
    export.name = bad.into();
    export.parts[0].name = bad.into();
    export.parts[1].name = String::new();
    for group in &mut export.parts[1].mesh.groups {
        group.name = bad.repeat(100);
        group.material.as_mut().unwrap().name = "default".into();
    }
    let wanted = expectation(&export);
    for format in Format::ALL {
        let files = write(&export, format);
        let mesh = read(&format!("x.{}", format.extension()), &files[0].bytes).unwrap();
        assert_eq!(mesh.triangles.len(), wanted.len(), "{format:?}");
        if format == Format::Obj {
            let materials = read_mtl(&files[1].bytes).unwrap();
            let names: Vec<&str> = materials.iter().map(|m| m.name.as_str()).collect();
            assert_eq!(names, ["default.1", "default.2", "default"]);
        }
    }
}

#[test]
fn three_mf_is_read_by_threemf2() {
    use threemf2::package::ThreemfPackage;
    use threemf2::package::query::get_mesh_objects;
    let export = export();
    let wanted = expectation(&export);
    let file = write(&export, Format::ThreeMf).remove(0);
    let bytes = Cursor::new(file.bytes);
    let package =
        ThreemfPackage::from_reader_with_memory_optimized_deserializer(bytes, true).unwrap();
    let mut corners = Vec::new();
    let mut colored = [0, 0];
    for (i, object) in get_mesh_objects(&package).enumerate() {
        let vertices: Vec<DVec3> = object.view.vertices().map(DVec3::from_array).collect();
        for triangle in object.view.triangles() {
            corners.push(triangle.map(|v| vertices[v as usize]));
        }
        let own = object.view.triangles_data();
        colored[i] = own.filter(|data| data.iter().any(Option::is_some)).count();
    }
    assert_eq!(corners.len(), wanted.len());
    for (read, wanted) in corners.iter().zip(&wanted) {
        for (a, b) in read.iter().zip(wanted) {
            assert!(a.distance(*b) <= 1e-6 * b.length(), "{a} {b}");
        }
    }
    let counts = [0, 1].map(|i| export.parts[i].mesh.triangles.len());
    assert_eq!(colored, counts, "each triangle has its colour or material");
}
