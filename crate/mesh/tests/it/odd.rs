//! Files that are odd but valid: each says the same box as a plain one would.

use glam::DVec3;
use mesh::{Topology, TriangleMesh, read, read_with_remarks};
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    IndexEncoding, VertexEncoding, encode_index_buffer, encode_vertex_buffer,
};
use std::fmt::Write as _;
use trials::boxes::{SIDES, triangles};

/// Corners of a box of 3 × 2 × 1.
const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [3.0, 0.0, 0.0],
    [0.0, 2.0, 0.0],
    [3.0, 2.0, 0.0],
    [0.0, 0.0, 1.0],
    [3.0, 0.0, 1.0],
    [0.0, 2.0, 1.0],
    [3.0, 2.0, 1.0],
];

/// Checks that a mesh is the box as often as said, its first corner at a place.
fn check_boxes(mesh: &TriangleMesh, count: usize, least: [f64; 3], most: [f64; 3]) {
    assert_eq!(mesh.triangles.len(), 12 * count);
    // Corners at one place are one.
    let mut welded = TriangleMesh::default();
    for i in 0..mesh.triangles.len() {
        let corners = mesh.corners(i).map(|corner| {
            let known = welded.positions.iter().position(|own| *own == corner);
            known.unwrap_or_else(|| {
                welded.positions.push(corner);
                welded.positions.len() - 1
            }) as u32
        });
        welded.triangles.push(corners);
    }
    let topology = Topology::of(&welded).unwrap();
    assert!(topology.is_closed_manifold(), "{topology:?}");
    let bounds = mesh::Aabb::of_points(mesh.positions.iter().copied());
    assert!(bounds.min.distance(DVec3::from(least)) < 1e-6, "{bounds:?}");
    assert!(bounds.max.distance(DVec3::from(most)) < 1e-6, "{bounds:?}");
    let volume: f64 = (0..mesh.triangles.len())
        .map(|i| mesh.corners(i))
        .map(|[a, b, c]| a.cross(b).dot(c) / 6.0)
        .sum();
    assert!((volume - 6.0 * count as f64).abs() < 1e-5, "{volume}");
}

fn check_box(mesh: &TriangleMesh) {
    check_boxes(mesh, 1, [0.0; 3], [3.0, 2.0, 1.0]);
}

/// Writes the box as text of an STL file.
fn stl(gap: &str, name: &str) -> String {
    let mut text = format!("solid {name}{gap}");
    for triangle in triangles() {
        let _ = write!(text, "facet normal 0 0 0{gap}outer loop{gap}");
        for corner in triangle {
            let [x, y, z] = CORNERS[corner as usize];
            let _ = write!(text, "vertex {x:e}  {y} {z:.3}{gap}");
        }
        let _ = write!(text, "endloop{gap}endfacet{gap}");
    }
    text + "endsolid " + name
}

#[test]
fn stl_is_words_not_lines() {
    for text in [
        stl("\n", "a"),
        stl("\r\n\t", "two words"),
        stl(" ", ""),
        stl(" ", "an outer loop of vertex 1 2 3"),
        stl("\n", "vertex endfacet"),
        stl(" ", "a").to_uppercase(),
        format!("\u{feff} \n{}", stl("\n", "a")),
        format!("\n\n{} ", stl("\t", "")),
        // Several solids in a file.
        stl(" ", "a").replacen("endfacet facet", "endfacet endsolid a solid b facet", 1),
        stl("\n", "a").replace("endsolid a", ""),
    ] {
        check_box(
            &read("a.stl", text.as_bytes()).unwrap_or_else(|error| panic!("{error}: {text}")),
        );
    }
    let text = format!("\u{feff}\n{}", stl("\n", "a")).replacen("vertex 3e0", "vertex 3e0 x", 1);
    let told = read("a.stl", text.as_bytes()).unwrap_err().to_string();
    assert!(
        told.starts_with("line 7: a vertex needs three numbers"),
        "{told}"
    );
    let text = stl(" ", "a");
    let told = read("a.stl", &text.as_bytes()[..100])
        .unwrap_err()
        .to_string();
    assert!(
        told.contains("cut off") || told.contains("three numbers"),
        "{told}"
    );
}

#[test]
fn strips_of_ply_are_triangles() {
    // Each side of the box is a strip of two triangles.
    let strips: Vec<String> = SIDES
        .map(|[a, b, c, d]| format!("{b} {c} {a} {d}"))
        .to_vec();
    let list = strips.join(" -1 ");
    let mut text = String::from(
        "ply\nformat ascii 1.0\nelement pad 1\nproperty list uchar float x\nproperty char y\n\
         element vertex 8\nproperty double x\nproperty double y\nproperty float z\n\
         element tristrips 1\nproperty list int int vertex_indices\nend_header\n2 7 8 9\n",
    );
    for [x, y, z] in CORNERS {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    let _ = writeln!(text, "{} {list} -1", 6 * 4 + 6);
    check_box(&read("a.ply", text.as_bytes()).unwrap());
    let told = read("a.ply", text.replace(" -1 ", " -2 ").as_bytes())
        .unwrap_err()
        .to_string();
    assert!(
        told.contains("`tristrips` 0 (from 0): a corner is no whole number"),
        "{told}"
    );
}

#[test]
fn flat_and_double_triangles_are_left_out_with_a_remark() {
    let mut text = String::from("o box\n");
    for [x, y, z] in CORNERS {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for [a, b, c] in triangles() {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    let (mesh, remarks) = read_with_remarks("a.obj", text.as_bytes()).unwrap();
    check_box(&mesh);
    assert!(remarks.is_empty());
    // Doubles may begin with another corner, or have corners of their own at the same place.
    let more = "f 4 1 3\nf 2 2 3\nf 1 1 1\nv -0 0 0\nv 0 2 0\nf 9 10 4\n";
    let (mesh, remarks) = read_with_remarks("a.obj", (text.clone() + more).as_bytes()).unwrap();
    assert_eq!(mesh.triangles.len(), 12);
    assert_eq!(mesh.groups[0].triangles, 0..12);
    assert_eq!(
        remarks,
        [
            "2 triangles without an area are left out",
            "2 triangles that are there twice are left out"
        ]
    );
    // The other side of a triangle is another one.
    let (mesh, remarks) = read_with_remarks("a.obj", (text + "f 1 4 3\n").as_bytes()).unwrap();
    assert_eq!((mesh.triangles.len(), remarks.len()), (13, 0));
}

/// Returns a GLB file of a description without its first brace, and numbers.
fn glb(description: &str, numbers: &[u8]) -> Vec<u8> {
    let mut json = format!("{{\"asset\":{{\"version\":\"2.0\"}},{description}").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut file = Vec::new();
    for word in [
        0x4654_6C67,
        2,
        (28 + json.len() + numbers.len()) as u32,
        json.len() as u32,
    ] {
        file.extend(u32::to_le_bytes(word));
    }
    file.extend(b"JSON");
    file.extend(json);
    file.extend((numbers.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(numbers);
    file
}

fn floats(numbers: impl IntoIterator<Item = f64>) -> Vec<u8> {
    let numbers = numbers.into_iter();
    numbers.flat_map(|x| (x as f32).to_le_bytes()).collect()
}

fn corner_indices() -> Vec<u8> {
    let corners = triangles().into_iter().flatten();
    corners.flat_map(|i| (i as u16).to_le_bytes()).collect()
}

/// Returns views of bytes one behind the other, as JSON, and all bytes.
fn views(lists: &[&[u8]]) -> (String, Vec<u8>) {
    let mut views = Vec::new();
    let mut bytes = Vec::new();
    for list in lists {
        views.push(format!(
            "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}",
            bytes.len(),
            list.len()
        ));
        bytes.extend(*list);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    (views.join(","), bytes)
}

/// Returns an accessor as JSON.
fn accessor(view: usize, kind: u32, count: usize, shape: &str, more: &str) -> String {
    format!(
        "{{\"bufferView\":{view},\"componentType\":{kind},\"count\":{count},\
         \"type\":\"{shape}\"{more}}}"
    )
}

const MESH: &str = "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\
 \"indices\":1}]}],\
                    \"buffers\":[{\"byteLength\":1}]";

#[test]
fn positions_of_glb_may_be_quantised() {
    // Whole numbers as they are, and shares of the largest.
    for (kind, size, is_share, scale) in [
        (5123, 2, false, 0.001),
        (5122, 2, true, 4.0),
        (5121, 1, true, 5.1),
        (5120, 1, false, 0.1),
    ] {
        let largest = [127.0, 255.0, 32_767.0, 65_535.0][(kind - 5120) as usize];
        let factor = if is_share {
            largest / scale
        } else {
            1.0 / scale
        };
        let mut numbers = Vec::new();
        for corner in CORNERS {
            for x in corner {
                let word = (x * factor).round() as i32;
                numbers.extend(&word.to_le_bytes()[..size]);
            }
            numbers.resize(numbers.len().next_multiple_of(4), 0);
        }
        let (list, bytes) = views(&[&numbers, &corner_indices()]);
        let stride = numbers.len() / 8;
        let list = list.replacen("}", &format!(",\"byteStride\":{stride}}}"), 1);
        let share = format!(",\"normalized\":{is_share}");
        let description = format!(
            "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"nodes\":[{{\"mesh\":0,\"scale\":\
             [{scale},{scale},{scale}]}}],{MESH},\"bufferViews\":[{list}],\"accessors\":[{},{}]}}",
            accessor(0, kind, 8, "VEC3", &share),
            accessor(1, 5123, 36, "SCALAR", "")
        );
        let mesh = read("a.glb", &glb(&description, &bytes)).unwrap();
        let bounds = mesh::Aabb::of_points(mesh.positions.iter().copied());
        let error = 0.6 * scale / if is_share { largest } else { 1.0 };
        assert!(
            bounds.max.distance(DVec3::new(3.0, 2.0, 1.0)) < 2.0 * error,
            "{kind} {bounds:?}"
        );
        assert_eq!(mesh.triangles.len(), 12);
    }
}

#[test]
fn instances_of_glb_are_placed() {
    // The second one is turned by a quarter about z, the third is twice as large.
    let shifts = floats([0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 10.0, 0.0]);
    let half = 0.5_f64.sqrt();
    let turns = floats([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half, 0.0, 0.0, 0.0, 1.0]);
    let scales = floats([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    let (list, bytes) = views(&[
        &floats(CORNERS.into_iter().flatten()),
        &corner_indices(),
        &shifts,
        &turns,
        &scales,
    ]);
    let description = format!(
        "\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],\"nodes\":[{{\"mesh\":0,\
         \"translation\":[0,0,1],\"extensions\":{{\"EXT_mesh_gpu_instancing\":{{\"attributes\":\
         {{\"TRANSLATION\":2,\"ROTATION\":3,\"SCALE\":4,\"_ID\":9}}}}}}}}],{MESH},\
         \"bufferViews\":[{list}],\"accessors\":[{},{},{},{},{}]}}",
        accessor(0, 5126, 8, "VEC3", ""),
        accessor(1, 5123, 36, "SCALAR", ""),
        accessor(2, 5126, 3, "VEC3", ""),
        accessor(3, 5126, 3, "VEC4", ""),
        accessor(4, 5126, 3, "VEC3", "")
    );
    let mesh = read("a.glb", &glb(&description, &bytes)).unwrap();
    assert_eq!(mesh.triangles.len(), 36);
    for (start, least, most) in [
        (0, [0.0, 0.0, 1.0], [3.0, 2.0, 2.0]),
        (8, [18.0, 0.0, 1.0], [20.0, 3.0, 2.0]),
        (16, [0.0, 10.0, 1.0], [6.0, 14.0, 3.0]),
    ] {
        let bounds = mesh::Aabb::of_points(mesh.positions[start..start + 8].iter().copied());
        assert!(bounds.min.distance(DVec3::from(least)) < 1e-5, "{bounds:?}");
        assert!(bounds.max.distance(DVec3::from(most)) < 1e-5, "{bounds:?}");
    }
    let fewer = description.replace(
        &accessor(4, 5126, 3, "VEC3", ""),
        &accessor(4, 5126, 2, "VEC3", ""),
    );
    let told = read("a.glb", &glb(&fewer, &bytes)).unwrap_err().to_string();
    assert!(
        told.contains("not as many places as turns or scales"),
        "{told}"
    );
}

#[test]
fn sparse_accessors_of_glb_are_read() {
    // Corner 7 stands elsewhere at first; then all do, at 0.
    let mut wrong = CORNERS;
    wrong[7] = [9.0, 9.0, 9.0];
    let (list, bytes) = views(&[
        &floats(wrong.into_iter().flatten()),
        &corner_indices(),
        &[7],
        &floats(CORNERS[7]),
        &[0, 1, 2, 3, 4, 5, 6, 7],
        &floats(CORNERS.into_iter().flatten()),
    ]);
    let one = ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":2,\"componentType\":5121},\
               \"values\":{\"bufferView\":3}}";
    let all = "{\"componentType\":5126,\"count\":8,\"type\":\"VEC3\",\"sparse\":{\"count\":8,\
     \"indices\":\
               {\"bufferView\":4,\"componentType\":5121},\"values\":{\"bufferView\":5}}}";
    for position in [accessor(0, 5126, 8, "VEC3", one), all.into()] {
        let description = format!(
            "\"nodes\":[{{\"mesh\":0}}],{MESH},\"bufferViews\":[{list}],\
             \"accessors\":[{position},{}]}}",
            accessor(1, 5123, 36, "SCALAR", "")
        );
        check_box(&read("a.glb", &glb(&description, &bytes)).unwrap());
        let far = description.replace("\"count\":8,\"type\"", "\"count\":7,\"type\"");
        assert!(read("a.glb", &glb(&far, &bytes)).is_err());
    }
}

#[test]
fn views_that_meshopt_packs_are_read() {
    let mut workspace = Workspace::default();
    let positions = floats(CORNERS.into_iter().flatten());
    let corners: Vec<u32> = triangles().into_iter().flatten().collect();
    let packed = encode_vertex_buffer(
        &positions,
        8,
        12,
        VertexEncoding::new(0, 0).unwrap(),
        &mut workspace,
    )
    .unwrap();
    let indices = encode_index_buffer(&corners, IndexEncoding::DEFAULT, &mut workspace).unwrap();
    let (_, bytes) = views(&[&packed, &indices]);
    let packing = [
        (packed.len(), 12, 8, "ATTRIBUTES", 0),
        (
            indices.len(),
            4,
            36,
            "TRIANGLES",
            packed.len().next_multiple_of(4),
        ),
    ];
    let list: Vec<String> = packing
        .iter()
        .map(|(length, stride, count, mode, offset)| {
            format!(
                "{{\"buffer\":0,\"byteLength\":{},\"extensions\":{{\"EXT_meshopt_compression\":\
                 {{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length},\"byteStride\":\
                 {stride},\"count\":{count},\"mode\":\"{mode}\"}}}}}}",
                stride * count
            )
        })
        .collect();
    let description = format!(
        "\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"nodes\":[{{\"mesh\":0}}],{MESH},\
         \"bufferViews\":[{}],\"accessors\":[{},{}]}}",
        list.join(","),
        accessor(0, 5126, 8, "VEC3", ""),
        accessor(1, 5125, 36, "SCALAR", "")
    );
    check_box(&read("a.glb", &glb(&description, &bytes)).unwrap());
    for (from, to, told) in [
        (
            "\"count\":36,\"mode\"",
            "\"count\":360000000,\"mode\"",
            "more than 67108864 bytes",
        ),
        ("ATTRIBUTES", "TRIANGLES", "cannot be unpacked"),
        ("TRIANGLES", "PRISMS", "cannot be unpacked"),
        (
            "\"byteOffset\":0",
            "\"byteOffset\":999",
            "reads beyond its end",
        ),
    ] {
        let broken = description.replace(from, to);
        assert_ne!(broken, description);
        let message = read("a.glb", &glb(&broken, &bytes))
            .unwrap_err()
            .to_string();
        assert!(message.contains(told), "{message}");
    }
    let mut damaged = bytes.clone();
    damaged[0] ^= 0xFF;
    assert!(read("a.glb", &glb(&description, &damaged)).is_err());
}

#[test]
fn draco_is_refused_by_its_name() {
    for required in [
        "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],",
        "",
    ] {
        let description = format!(
            "{required}\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":\
             {{\"POSITION\":0}},\"extensions\":{{\"KHR_draco_mesh_compression\":{{\
              \"bufferView\":0}}}}}}]}}],\
             \"accessors\":[{{\"componentType\":5126,\"count\":8,\"type\":\"VEC3\"}}]}}"
        );
        let told = read("a.glb", &glb(&description, &[]))
            .unwrap_err()
            .to_string();
        assert!(
            told.contains("KHR_draco_mesh_compression") && told.contains("without compression")
        );
    }
}

#[test]
fn parts_of_3mf_are_followed_and_units_meet() {
    let mut corners = String::from("<vertices>");
    for [x, y, z] in CORNERS {
        let _ = write!(corners, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    corners += "</vertices><triangles>";
    for [a, b, c] in triangles() {
        let _ = write!(corners, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
    }
    let head = "xmlns=\"http://x/core\" xmlns:p=\"http://x/production\"";
    let part = format!(
        "<model unit=\"millimeter\" {head}><resources><object id=\"9\"><mesh>{corners}</triangles>\
         </mesh></object></resources><build/></model>"
    );
    // A part in millimetres in a main part in centimetres.
    let main = format!(
        "<model unit=\"centimeter\" {head}><resources><object id=\"1\"><components><component \
         objectid=\"9\" p:path=\"/3D/part.model\"/>\
          <component objectid=\"9\" p:path=\"/3D/PART.model\" \
         transform=\"1 0 0 0 1 0 0 0 1 0.5 0 0\"/></components></object></resources><build><item \
         objectid=\"1\"/></build></model>"
    );
    let package = archive::write(&[
        archive::Member::new("3D/3dmodel.model", main.as_bytes()),
        archive::Member::new("3D/part.model", part.as_bytes()),
    ])
    .unwrap();
    let mesh = read("a.3mf", &package).unwrap();
    check_boxes(&mesh, 2, [0.0; 3], [8.0, 2.0, 1.0]);
}

#[test]
fn nodes_of_glb_may_stand_in_each_other_deeply() {
    let (list, bytes) = views(&[&floats(CORNERS.into_iter().flatten()), &corner_indices()]);
    let rest = format!(
        "{MESH},\"bufferViews\":[{list}],\"accessors\":[{},{}],\"scene\":0,\
         \"scenes\":[{{\"nodes\":[0]}}]}}",
        accessor(0, 5126, 8, "VEC3", ""),
        accessor(1, 5123, 36, "SCALAR", "")
    );
    let deep = format!("{},{rest}", nest(20_001, ""));
    let mesh = read("a.glb", &glb(&deep, &bytes)).unwrap();
    check_boxes(&mesh, 1, [0.0, 0.0, 20_000.0], [3.0, 2.0, 20_001.0]);
    for depth in [1, 3, 20_000] {
        let circle = format!("{},{rest}", nest(depth, ",\"children\":[0]"));
        let told = read("a.glb", &glb(&circle, &bytes)).unwrap_err();
        assert!(told.to_string().contains("is in two places"), "{told}");
    }
}

/// Returns nodes in each other, as JSON. Each moves what is in it by 1; the last has the mesh.
fn nest(depth: usize, last: &str) -> String {
    let mut nodes = String::new();
    for i in 1..depth {
        let _ = write!(nodes, "{{\"children\":[{i}],\"translation\":[0,0,1]}},");
    }
    format!("\"nodes\":[{nodes}{{\"mesh\":0{last}}}]")
}

#[test]
fn text_of_obj_may_be_in_any_encoding_and_have_any_ends_of_lines() {
    let mut text = String::from("# µ\n");
    for [x, y, z] in CORNERS {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for [a, b, c] in triangles() {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    let units: Vec<u16> = std::iter::once(0xFEFF).chain(text.encode_utf16()).collect();
    for bytes in [
        text.clone().into_bytes(),
        format!("\u{feff}{text}").into_bytes(),
        units.iter().flat_map(|unit| unit.to_le_bytes()).collect(),
        units.iter().flat_map(|unit| unit.to_be_bytes()).collect(),
        text.replace('\n', "\r").into_bytes(),
        text.replace('\n', "\r\n").into_bytes(),
        format!("{text}\0\0").into_bytes(),
    ] {
        check_box(&read("a.obj", &bytes).unwrap());
    }
}
