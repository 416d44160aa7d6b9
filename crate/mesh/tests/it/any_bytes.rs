//! Random bytes: no reader panics or hangs, and meshes that are read can be drawn.

use crate::common::{binary_ply, glb, png_of, tetrahedron};
use glam::DVec3;
use std::time::Duration;
use trials::arbitrary::{Result, Unstructured};
use trials::{WorkClock, trials};

/// Far above what small files may take on a slow machine.
const PATIENCE: Duration = Duration::from_secs(5);

fn check(name: &str, bytes: &[u8]) {
    let begin = WorkClock::start();
    match mesh::read(name, bytes) {
        Ok(mesh) => {
            assert!(!mesh.triangles.is_empty());
            assert!(mesh.triangles.len() <= mesh::limits::MAX_TRIANGLES);
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            for index in mesh.triangles.iter().flatten() {
                assert!((*index as usize) < mesh.positions.len());
            }
            if let Some(colors) = &mesh.colors {
                assert_eq!(colors.len(), mesh.positions.len());
                assert!(
                    colors
                        .as_flattened()
                        .iter()
                        .all(|x| (0.0..=1.0).contains(x))
                );
            }
            let mut end = 0;
            for group in &mesh.groups {
                assert!(end <= group.triangles.start && !group.triangles.is_empty());
                end = group.triangles.end;
            }
            assert!(end as usize <= mesh.triangles.len());
            // Meshes that are read can be repaired and written.
            let built = mesh::HalfEdgeMesh::repair(&mesh::PolygonSoup::from(&mesh)).unwrap();
            built.mesh.validate().unwrap();
            let part = mesh::Part {
                name: name.into(),
                mesh: mesh.clone(),
            };
            let export = mesh::Export {
                name: name.into(),
                parts: vec![part],
                millimetres: 1.0,
            };
            for format in mesh::Format::ALL {
                for file in export.write(format).unwrap() {
                    assert!(!file.bytes.is_empty());
                }
            }
            if let Some(normals) = &mesh.normals {
                assert_eq!(normals.len(), mesh.positions.len());
                assert!(normals.iter().all(|n| n.is_finite()));
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    let _ = mesh::read_mtl(bytes);
    if let Ok(heights) = mesh::heights(bytes) {
        let _ = mesh::terra(&heights, DVec3::ONE);
    }
    assert!(begin.elapsed() < PATIENCE, "{name}: {:?}", begin.elapsed());
}

/// The tetrahedron with colours and a material.
fn write(format: mesh::Format) -> Vec<u8> {
    let model = tetrahedron();
    let triangles = model
        .triangles
        .iter()
        .map(|t| t.map(|i| i as u32))
        .collect();
    let mut mesh = mesh::TriangleMesh::new(model.positions, triangles);
    mesh.groups.push(mesh::Group {
        name: "two".into(),
        material: Some(mesh::Material::default()),
        triangles: 1..3,
    });
    let mut colored = mesh.clone();
    colored.colors = Some(vec![[1.0, 0.5, 0.0]; 4]);
    let part = |mesh| mesh::Part {
        name: "one".into(),
        mesh,
    };
    let export = mesh::Export {
        name: "x".into(),
        parts: vec![part(mesh), part(colored)],
        millimetres: 1.0,
    };
    export.write(format).unwrap().swap_remove(0).bytes
}

/// Returns a 3MF file's description, unpacked, in an archive that does not pack it: so that changes
/// reach it.
fn store(xml: &[u8]) -> Vec<u8> {
    let description = archive::Member {
        packed: true,
        ..archive::Member::new("3D/3dmodel.model", xml)
    };
    archive::write(&[description]).unwrap()
}

/// Everything that the 3MF reader knows.
const XML: &str = r##"<?xml version="1.0"?><!-- a > comment --><model unit="inch"><resources>
<basematerials id="1"><base name="a &amp; b" displaycolor="#FF8000FF"/></basematerials>
<m:colorgroup id="2"><m:color color="#102030"/><m:color color='#405060'/></m:colorgroup>
<object id="3" name="o" pid="1" pindex="0"><mesh><vertices><vertex x="0" y="0" z="0"/>
<vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices>
<triangles>
<triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3" pid="2" p1="0" p2="1" p3="0"/>
<triangle v1="0" v2="3" v3="2" pid="2" p1="1"/></triangles></mesh></object>
<object id="4"><components><component objectid="3" transform="-1 0 0 0 1 0 0 0 1 5 0 0"/>
<component objectid="3"/></components></object></resources>
<build><item objectid="4" transform="2 0 0 0 2 0 0 0 2 0 0 1"/></build></model>"##;

#[test]
fn a_3mf_description_is_understood() {
    let mesh = mesh::read("x.3mf", &store(XML.as_bytes())).unwrap();
    assert_eq!(mesh.triangles.len(), 6);
    // The mirrored one comes first; inches.
    let [a, b, c] = mesh.corners(0);
    assert!(a.distance(DVec3::new(10.0, 0.0, 1.0) * 25.4) < 1e-9);
    assert!(
        (b - a).cross(c - a).z < 0.0,
        "the mirrored outside stays outside"
    );
    assert_eq!(mesh.corners(3)[1], DVec3::new(0.0, 2.0, 1.0) * 25.4);
    let orange = mesh::linear_from_srgb(0x80);
    assert_eq!(
        mesh.groups[0].material.as_ref().unwrap().color,
        [1.0, orange, 0.0]
    );
    assert_eq!(mesh.groups[0].material.as_ref().unwrap().name, "a & b");
    let colors = mesh.colors.unwrap();
    let of = |t: usize, k: usize| colors[mesh.triangles[t][k] as usize];
    assert_eq!(of(0, 0), [1.0, orange, 0.0]);
    assert_eq!(of(4, 1), [0x40, 0x50, 0x60].map(mesh::linear_from_srgb));
    assert_eq!(of(5, 2), [0x40, 0x50, 0x60].map(mesh::linear_from_srgb));
    let told = |xml: &str| {
        mesh::read("x.3mf", &store(xml.as_bytes()))
            .unwrap_err()
            .to_string()
    };
    assert!(told(&XML.replace("v1=\"0\"", "v1=\"7\"")).contains("vertex 7"));
    assert!(told(&XML.replace("objectid=\"4\"", "objectid=\"9\"")).contains("no object 9"));
    assert!(told(&XML.replace("objectid=\"3\"", "objectid=\"4\"")).contains("before its use"));
    assert!(told(&XML.replace("inch", "mile")).contains("unit"));
    assert!(told(&XML.replace("#FF8000FF", "red")).contains("no colour"));
    assert!(told("<!DOCTYPE x [<!ENTITY a \"b\">]>").contains("document type"));
    assert!(told("<model").contains("line 1: this XML is broken"));
    assert!(told("<model>").contains("a tag does not end"));
    assert!(
        mesh::read("x.3mf", b"PK\x03\x04")
            .unwrap_err()
            .to_string()
            .contains("cut off")
    );
    // Objects of objects of objects: two to the power of forty.
    let mut many = String::from("<object id=\"1\"/>");
    for i in 1..40 {
        let part = format!("<component objectid=\"{i}\"/>");
        many += &format!("<object id=\"{}\">{part}{part}</object>", i + 1);
    }
    assert!(told(&format!("{many}<item objectid=\"40\"/>")).contains("parts"));
}

fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let model = tetrahedron();
    let pixels: Vec<u8> = (0..48).collect();
    vec![
        ("x.obj", model.obj(true)),
        ("x.stl", model.ascii_stl()),
        ("x.stl", model.binary_stl()),
        ("x.ply", model.ascii_ply()),
        ("x.ply", binary_ply(&model, false)),
        ("x.ply", binary_ply(&model, true)),
        ("x.glb", glb(&model)),
        ("x.xml", XML.as_bytes().to_vec()),
        ("x.3mf", write(mesh::Format::ThreeMf)),
        ("x.glb", write(mesh::Format::Glb)),
        ("x.obj", write(mesh::Format::Obj)),
        (
            "x.mtl",
            b"newmtl a\nKd 0.5 0.5 0.5\nNs 10\nPr 0.5\n".to_vec(),
        ),
        (
            "x.png",
            png_of(4, 4, png::ColorType::Rgb, png::BitDepth::Eight, &pixels),
        ),
    ]
}

/// Pieces that mean something in one of the formats.
const PIECES: [&[u8]; 30] = [
    b"<component objectid=\"3\"/>",
    b"<!--",
    b"<![",
    b"&#x110000;",
    b"=\"",
    b"usemtl a\n",
    b"f 1 2 3\n",
    b"v 1e308 -1e308 nan\n",
    b"f -1 -2 -3",
    b"9999999999",
    b"-1",
    b"inf",
    b"\\\n",
    b"element vertex 4294967295\n",
    b"property list uchar int ",
    b"end_header\n",
    b"facet",
    b"endfacet\n",
    b"vertex 0 0 0\n",
    b"solid\n",
    b"ply\n",
    b"glTF",
    b"\xff\xff\xff\xff",
    b"\x00\x00\x00\x00",
    b"\"count\":1e9",
    b"\"byteStride\":0",
    b"{",
    b"[",
    b"null",
    b"\"nodes\":[0]",
];

fn mutate(u: &mut Unstructured<'_>, bytes: &mut Vec<u8>) -> Result<()> {
    for _ in 0..u.int_in_range(1..=6)? {
        let at = u.int_in_range(0..=bytes.len())?;
        match u.int_in_range(0..=5)? {
            0 => bytes.truncate(at),
            1 if at < bytes.len() => bytes[at] = u.arbitrary()?,
            2 if at < bytes.len() => bytes[at] ^= 1 << u.int_in_range(0..=7)?,
            3 => {
                let end = bytes.len().min(at + u.int_in_range(0..=40)?);
                bytes.drain(at..end);
            }
            4 => {
                let piece = *u.choose(&PIECES)?;
                bytes.splice(at..at, piece.iter().copied());
            }
            _ => {
                // A part of the file again, or over something else.
                let end = bytes.len().min(at + u.int_in_range(0..=80)?);
                let part = bytes[at..end].to_vec();
                let to = u.int_in_range(0..=bytes.len())?;
                let over = bytes.len().min(to + u.int_in_range(0..=4)?);
                bytes.splice(to..over, part);
            }
        }
    }
    Ok(())
}

#[test]
fn changes_of_files_do_no_harm() {
    let samples = samples();
    trials(|u| {
        let (name, bytes) = u.choose(&samples)?;
        let mut bytes = bytes.clone();
        mutate(u, &mut bytes)?;
        if *name == "x.xml" {
            bytes = store(&bytes);
        }
        let name = if *name == "x.xml" { "x.3mf" } else { *name };
        check(name, &bytes);
        Ok(())
    })
    .cases(4_000);
}

#[test]
fn random_bytes_do_no_harm() {
    trials(|u| {
        let names = ["x.obj", "x.stl", "x.ply", "x.glb", "x.3mf", "x.png", "x"];
        let start: [&[u8]; 7] = [
            b"PK\x03\x04",
            b"",
            b"ply\n",
            b"glTF",
            b"solid ",
            b"\x89PNG\r\n\x1a\n",
            b"v 1 ",
        ];
        let name = *u.choose(&names)?;
        let mut bytes = u.choose(&start)?.to_vec();
        let length = u.len().min(2000);
        bytes.extend_from_slice(u.bytes(length)?);
        check(name, &bytes);
        Ok(())
    })
    .cases(1_000);
}

/// Every file cut off anywhere.
#[test]
fn beginnings_do_no_harm() {
    for (name, bytes) in samples() {
        for end in 0..bytes.len() {
            check(name, &bytes[..end]);
        }
    }
}
