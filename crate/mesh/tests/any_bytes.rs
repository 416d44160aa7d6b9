//! Whatever bytes come: nothing panics or hangs, and what comes out can be drawn.

mod common;

use common::{binary_ply, glb, png_of, tetrahedron};
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
            if let Some(normals) = &mesh.normals {
                assert_eq!(normals.len(), mesh.positions.len());
                assert!(normals.iter().all(|n| n.is_finite()));
            }
            assert_eq!(mesh.shapes().count(), mesh.triangles.len());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    if let Ok(heights) = mesh::heights(bytes) {
        let _ = mesh::terra(&heights, DVec3::ONE);
    }
    assert!(begin.elapsed() < PATIENCE, "{name}: {:?}", begin.elapsed());
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
        (
            "x.png",
            png_of(4, 4, png::ColorType::Rgb, png::BitDepth::Eight, &pixels),
        ),
    ]
}

/// Pieces that mean something in one of the formats.
const PIECES: [&[u8]; 24] = [
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
fn changed_files_do_no_harm() {
    let samples = samples();
    trials(|u| {
        let (name, bytes) = u.choose(&samples)?;
        let mut bytes = bytes.clone();
        mutate(u, &mut bytes)?;
        check(name, &bytes);
        Ok(())
    })
    .cases(4_000);
}

#[test]
fn random_bytes_do_no_harm() {
    trials(|u| {
        let names = ["x.obj", "x.stl", "x.ply", "x.glb", "x.png", "x"];
        let start: [&[u8]; 6] = [
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
