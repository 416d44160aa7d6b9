//! Small model through each format, and what a person is told of broken ones.

use crate::common::{Model, binary_ply, glb, png_of, tetrahedron};
use glam::DVec3;
use mesh::{Heights, TriangleMesh, heights, limits, read, read_with_remarks, terra};

/// The corners of each triangle: what a mesh is, however it is stored.
fn faces(mesh: &TriangleMesh) -> Vec<[DVec3; 3]> {
    mesh.triangles
        .iter()
        .map(|t| t.map(|i| mesh.positions[i as usize]))
        .collect()
}

fn normals(mesh: &TriangleMesh) -> Vec<[DVec3; 3]> {
    let normals = mesh.normals.as_ref().expect("normals");
    assert_eq!(normals.len(), mesh.positions.len());
    mesh.triangles
        .iter()
        .map(|t| t.map(|i| normals[i as usize]))
        .collect()
}

fn message(name: &str, bytes: impl AsRef<[u8]>) -> String {
    read(name, bytes.as_ref())
        .expect_err("an error")
        .to_string()
}

#[test]
fn every_format_gives_the_same_model() {
    let Model {
        positions,
        triangles,
        normals: wanted,
    } = tetrahedron();
    let expected: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|i| positions[i])).collect();
    let expected_normals: Vec<[DVec3; 3]> =
        triangles.iter().map(|t| t.map(|i| wanted[i])).collect();
    let model = tetrahedron();
    for (name, bytes, has_normals) in [
        ("a.obj", model.obj(true), true),
        ("a.OBJ", model.obj(false), false),
        ("a.stl", model.ascii_stl(), false),
        ("a.stl", model.binary_stl(), false),
        ("a.ply", model.ascii_ply(), true),
        ("a.ply", binary_ply(&model, false), true),
        ("a.ply", binary_ply(&model, true), true),
        ("a.glb", glb(&model), true),
        ("named like something else.obj", glb(&model), true),
    ] {
        let mesh = read(name, &bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(faces(&mesh), expected, "{name}");
        assert_eq!(mesh.normals.is_some(), has_normals, "{name}");
        if has_normals {
            for (a, b) in normals(&mesh).iter().zip(&expected_normals) {
                for (a, b) in a.iter().zip(b) {
                    assert!(a.distance(*b) < 1e-6, "{name}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn obj_has_many_ways_to_say_a_face() {
    let text = "# a square, and half of it\r\nv 0 0 0\r\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\n\
                vt 0 0\no name\nf 1 2 3 4\nf -4/1 \\\n -3/1 -1/1 # the end\n";
    let mesh = read("x.obj", text.as_bytes()).unwrap();
    let [a, b, c, d] =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    assert_eq!(faces(&mesh), [[a, b, c], [a, c, d], [a, b, d]]);
    assert_eq!(mesh.positions.len(), 4, "corners are shared");
    assert_eq!(mesh.normals, None);
    // One corner with two normals is two corners.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 3//2 2//2 1//2";
    assert_eq!(read("x.obj", text.as_bytes()).unwrap().positions.len(), 6);
}

#[test]
fn glb_nodes_place_their_meshes() {
    let model = tetrahedron();
    let nodes = r#"[{"children":[1,2],"scale":[2,2,2]},
        {"mesh":0,"translation":[1,2,3],"rotation":[0,0,1,0]},
        {"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}]"#;
    let mesh = read("x.glb", &model.glb_with(nodes, "")).unwrap();
    let count = model.triangles.len();
    assert_eq!(mesh.triangles.len(), 2 * count);
    let corner = model.positions[model.triangles[0][1]];
    let turned = DVec3::new(-corner.x, -corner.y, corner.z);
    let all = faces(&mesh);
    assert!(all[0][1].distance((turned + DVec3::new(1.0, 2.0, 3.0)) * 2.0) < 1e-12);
    let mirrored = DVec3::new(5.0 - corner.x, corner.y, corner.z) * 2.0;
    // The mirror image is turned round, so that its outside stays outside.
    assert!(all[count][2].distance(mirrored) < 1e-12);
    let volume =
        |faces: &[[DVec3; 3]]| -> f64 { faces.iter().map(|[a, b, c]| a.cross(*b).dot(*c)).sum() };
    let [first, second] = [volume(&all[..count]), volume(&all[count..])];
    assert!(first > 0.0 && (first - second).abs() < 1e-9);
}

#[test]
fn errors_name_their_place_in_the_file() {
    let model = tetrahedron();
    assert!(message("x.obj", "v 0 0 0\nv 1 0\n").starts_with("line 2:"));
    assert!(message("x.obj", "v 0 0 0\nf 1 2 3").contains("`2` is none of the 1 `v`"));
    assert!(message("x.obj", "v 0 0 0\nf 0 1 1").starts_with("line 2:"));
    assert!(message("x.obj", "v 0 0 0\nv 1 1 1\nf 1 2").contains("at least three"));
    assert!(message("x.obj", "").contains("no triangles"));
    assert!(message("x.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3").contains("has an area"));
    assert!(message("x.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3").starts_with("line 1:"));
    assert!(message("x.jpg", "").contains(".obj"));
    assert!(message("x.stl", "").contains("too short"));
    assert!(message("x.stl", "solid\nvertex 1 2\n").starts_with("line 2:"));
    let stl = model.binary_stl();
    assert!(message("x.stl", &stl[..stl.len() - 1]).contains("cut off"));
    assert!(message("x.ply", "ply\nformat ascii 1.0\nelement vertex 1\n").contains("end_header"));
    let ply = String::from_utf8(model.ascii_ply()).unwrap();
    assert!(
        message("x.ply", ply.replace("property float x", "property flat x")).contains("`flat`")
    );
    assert!(message("x.ply", ply.replace("ascii", "morse")).contains("format"));
    let cut = &ply[..ply.len() - 4];
    assert!(
        message("x.ply", cut).contains("`face` 3 (from 0)"),
        "{}",
        message("x.ply", cut)
    );
    let glb = glb(&model);
    assert!(message("x.glb", &glb[..glb.len() - 1]).contains("cut off"));
    let needs = |name: &str| model.glb_with(r#"[{"mesh":0}]"#, name);
    let draco = r#""extensionsRequired":["KHR_draco_mesh_compression"],"#;
    assert!(message("x.glb", needs(draco)).contains("KHR_draco_mesh_compression"));
    let harmless = r#""extensionsRequired":["KHR_materials_unlit"],"#;
    assert!(read("x.glb", &needs(harmless)).is_ok());
    let circle = r#"[{"children":[1]},{"children":[0],"mesh":0}]"#;
    assert!(message("x.glb", model.glb_with(circle, "")).contains("two places"));
    let nowhere = r#"[{"mesh":7}]"#;
    assert!(message("x.glb", model.glb_with(nowhere, "")).contains("mesh 7"));
}

#[test]
fn counts_are_not_believed() {
    let begin = trials::WorkClock::start();
    // Sixteen EiB of vertices, faces, and rows without anything in them.
    for count in ["1000000", "18446744073709551615"] {
        for element in ["vertex", "face", "thing"] {
            for property in [
                "",
                "property float x\n",
                "property list uint uint vertex_index\n",
            ] {
                for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
                    let text = format!(
                        "ply\nformat {format} 1.0\nelement {element} {count}\n\
                         {property}end_header\n\u{1}\u{2}\u{3}"
                    );
                    message("x.ply", text);
                }
            }
        }
    }
    let mut stl = vec![0; 84];
    stl[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    message("x.stl", stl);
    // A list as long as a length can say, and one that is not even a number.
    let heading = "ply\nformat binary_little_endian 1.0\nelement face 1\n\
                   property list uint uchar vertex_index\nend_header\n";
    let mut list = heading.as_bytes().to_vec();
    list.extend([255; 300]);
    message("x.ply", list);
    let heading = "ply\nformat ascii 1.0\nelement face 1\n\
                   property list float int vertex_index\nend_header\nnan 1 2 3";
    message("x.ply", heading);
    assert!(begin.elapsed().as_secs() < 5, "{:?}", begin.elapsed());
}

#[test]
fn limits_hold() {
    message("x.obj", vec![b'\n'; limits::MAX_BYTES + 1]);
    let line = "v 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let most = format!("{line}{}", "f 1 2 3\n".repeat(limits::MAX_TRIANGLES));
    let (mesh, remarks) = read_with_remarks("x.obj", most.as_bytes()).unwrap();
    assert_eq!(mesh.triangles.len(), 1);
    let doubles = limits::MAX_TRIANGLES - 1;
    assert!(remarks[0].starts_with(&format!("{doubles} triangles that are there twice")));
    assert!(message("x.obj", format!("{most}f 1 2 3\n")).contains("200000 triangles"));
    // A fan is many triangles in one line.
    let fan = format!("{line}f {}", "1 2 3 ".repeat(limits::MAX_TRIANGLES));
    assert!(message("x.obj", fan).contains("200000 triangles"));
    let points = "v 1 0 0\n".repeat(limits::MAX_VERTICES + 1);
    assert!(message("x.obj", points).contains("more than 600000"));
    // Many nodes that show one mesh of many empty parts.
    let model = tetrahedron();
    let nodes = vec![r#"{"mesh":0}"#; 60_000].join(",");
    let begin = trials::WorkClock::start();
    message("x.glb", model.glb_with(&format!("[{nodes}]"), ""));
    assert!(begin.elapsed().as_secs() < 5, "{:?}", begin.elapsed());
}

#[test]
fn pictures_become_heights() {
    use png::{BitDepth::*, ColorType::*};
    let grey = |bytes: &[u8]| heights(&png_of(2, 2, Grayscale, Eight, bytes)).unwrap();
    let h = grey(&[0, 51, 102, 255]);
    assert_eq!([h.width(), h.height()], [2, 2]);
    let all = [h.at(0, 0), h.at(1, 0), h.at(0, 1), h.at(1, 1)];
    assert_eq!(all, [0.0, 0.2, 0.4, 1.0]);
    let fine = heights(&png_of(1, 1, Grayscale, Sixteen, &[0x80, 0x00])).unwrap();
    assert_eq!(fine.at(0, 0), 32768.0 / 65535.0);
    let red = heights(&png_of(1, 1, Rgba, Eight, &[255, 0, 0, 0])).unwrap();
    assert!((red.at(0, 0) - 0.2126).abs() < 1e-6);
    let bits = heights(&png_of(8, 1, Grayscale, One, &[0b1010_0000])).unwrap();
    assert_eq!((bits.at(0, 0), bits.at(1, 0)), (1.0, 0.0));
    let whole = png_of(2, 2, Grayscale, Eight, &[1, 2, 3, 4]);
    assert!(heights(b"GIF89a").is_err());
    for cut in 0..whole.len() - 12 {
        assert!(heights(&whole[..cut]).is_err(), "{cut}");
    }
    // A heading that promises four thousand million pixels.
    let mut vast = png_of(2, 2, Rgba, Sixteen, &[0; 32]);
    vast[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    assert!(heights(&vast).is_err());
}

#[test]
fn a_height_field_is_where_its_heights_are() {
    // A slope along x and y: flat, so that normals are known.
    let (width, height) = (5, 4);
    let value = |x: usize, y: usize| 0.1 * x as f32 + 0.2 * (height - 1 - y) as f32;
    let values = (0..height).flat_map(|y| (0..width).map(move |x| value(x, y)));
    let heights = Heights::new(width, values.collect()).unwrap();
    let size = DVec3::new(8.0, 6.0, 10.0);
    let mesh = terra(&heights, size).unwrap();
    assert_eq!(mesh.triangles.len(), 2 * 4 * 3);
    let slope = DVec3::new(-1.0 / 2.0, -2.0 / 2.0, 1.0).normalize();
    for (p, n) in mesh.positions.iter().zip(mesh.normals.as_ref().unwrap()) {
        assert!((p.z - (p.x / 2.0 + p.y)).abs() < 1e-6, "{p}");
        assert!(n.distance(slope) < 1e-6, "{n}");
    }
    for [a, b, c] in faces(&mesh) {
        assert!((b - a).cross(c - a).normalize().distance(slope) < 1e-6);
    }
    let area: f64 = faces(&mesh)
        .iter()
        .map(|[a, b, c]| (*b - *a).cross(*c - *a).z / 2.0)
        .sum();
    assert!((area - 48.0).abs() < 1e-9);
    // The picture stands upright: its upper left corner is at x = 0 and the largest y.
    assert!(mesh.positions[0].distance(DVec3::new(0.0, 6.0, 6.0)) < 1e-6);

    assert!(terra(&heights, DVec3::new(1.0, 0.0, 1.0)).is_err());
    assert!(terra(&heights, DVec3::splat(f64::NAN)).is_err());
    assert!(terra(&Heights::new(3, vec![0.0; 3]).unwrap(), DVec3::ONE).is_err());
    assert!(Heights::new(0, vec![]).is_none() && Heights::new(2, vec![0.5; 3]).is_none());
    assert!(Heights::new(1, vec![f32::NAN]).is_none());
}

#[test]
fn a_large_picture_is_averaged() {
    for (width, height) in [
        (1000, 700),
        (257, 257),
        (100_000, 2),
        (3, 50_000),
        (258, 257),
    ] {
        let heights = Heights::new(
            width,
            (0..width * height)
                .map(|i| (i % width) as f32 / (width - 1) as f32)
                .collect(),
        )
        .unwrap();
        let mesh = terra(&heights, DVec3::ONE).unwrap();
        let count = mesh.triangles.len();
        assert!(count <= limits::MAX_TERRA, "{width} × {height}: {count}");
        assert!(
            count as f64 > 0.6 * limits::MAX_TERRA as f64,
            "{width} × {height}: {count}"
        );
        // Away from the left and the right edge, where half of the neighbours are missing.
        for p in mesh.positions.iter().filter(|p| (p.x - 0.5).abs() < 0.45) {
            assert!((p.z - p.x).abs() < 0.01, "{width} × {height}: {p}");
        }
    }
}
