//! STL: a list of loose triangles, as text or as numbers.
//!
//! The normals that it gives are those of the flat triangles, so they are passed over.

use super::cursor::Cursor;
use crate::error::{Error, fail};
use crate::triangle_mesh::TriangleMesh;
use glam::DVec3;

/// Bytes before the first triangle: a comment and the count.
const HEAD: usize = 84;
/// Bytes of a triangle.
const TRIANGLE: usize = 50;

pub(crate) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    // Some binary files begin with `solid` too: the size tells.
    let count = Cursor::new(bytes.get(80..).unwrap_or_default(), false)
        .take()
        .map(u32::from_le_bytes);
    let wanted = count.map(|n| HEAD as u64 + TRIANGLE as u64 * u64::from(n));
    let size = bytes.len() as u64;
    if wanted == Some(size) {
        return numbers(&bytes[HEAD..]);
    }
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let text = text.trim_ascii_start();
    let begins = text
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Text has no zeros; numbers hardly go without.
    if begins && !text.iter().take(1000).any(|byte| *byte == 0) {
        // Lines count from the file's first.
        let before = &bytes[..bytes.len() - text.len()];
        let first = before.iter().filter(|byte| **byte == b'\n').count() + 1;
        return words(&String::from_utf8_lossy(text), first);
    }
    match wanted {
        Some(wanted) if wanted < size => numbers(&bytes[HEAD..wanted as usize]),
        Some(wanted) => fail(format!(
            "this STL file is cut off: it should have {wanted} bytes and has {size}"
        )),
        None => fail("this is no STL file: it is too short, and does not begin with `solid`"),
    }
}

fn add(mesh: &mut TriangleMesh, corners: [DVec3; 3]) -> Result<(), Error> {
    let [a, b, c] = corners.map(|corner| mesh.add_vertex(corner));
    mesh.add_triangle([a?, b?, c?])
}

fn numbers(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let mut mesh = TriangleMesh::default();
    for triangle in bytes.chunks_exact(TRIANGLE) {
        // After the normal.
        let mut at = Cursor::new(&triangle[12..], false);
        let [a, b, c]: [[f64; 3]; 3] =
            core::array::from_fn(|_| core::array::from_fn(|_| at.f32().unwrap_or(f64::NAN)));
        add(&mut mesh, [a, b, c].map(DVec3::from))?;
    }
    Ok(mesh)
}

/// Reads text, in which words count, not lines.
fn words(text: &str, first: usize) -> Result<TriangleMesh, Error> {
    let mut mesh = TriangleMesh::default();
    let mut corners: Vec<DVec3> = Vec::new();
    // Numbers of the vertex that has begun, and its line.
    let mut vertex: Option<(Vec<f64>, usize)> = None;
    for (line, number) in text.lines().zip(first..) {
        // Whether words are a solid's name, which may be any, up to the end of its line.
        let mut is_name = false;
        for word in line.split_ascii_whitespace() {
            if let Some((mut numbers, begin)) = vertex.take() {
                let Ok(coordinate) = word.parse() else {
                    return fail(format!("line {begin}: a vertex needs three numbers"));
                };
                numbers.push(coordinate);
                match numbers[..] {
                    [x, y, z] => corners.push(DVec3::new(x, y, z)),
                    _ => vertex = Some((numbers, begin)),
                }
                continue;
            }
            if is_name && !word.eq_ignore_ascii_case("facet") {
                continue;
            }
            match word.to_ascii_lowercase().as_str() {
                "facet" => is_name = false,
                "solid" | "endsolid" => is_name = true,
                "vertex" if corners.len() == 3 => {
                    return fail(format!(
                        "line {number}: a facet has more than three vertices"
                    ));
                }
                "vertex" => vertex = Some((Vec::new(), number)),
                "endfacet" => {
                    let Ok(triangle) = <[DVec3; 3]>::try_from(&corners[..]) else {
                        return fail(format!(
                            "line {number}: a facet has fewer than three vertices"
                        ));
                    };
                    add(&mut mesh, triangle)?;
                    corners.clear();
                }
                _ => {}
            }
        }
    }
    if let Some((_, begin)) = vertex {
        return fail(format!("line {begin}: a vertex needs three numbers"));
    }
    if !corners.is_empty() {
        return fail("this STL file is cut off in the middle of a facet");
    }
    Ok(mesh)
}
