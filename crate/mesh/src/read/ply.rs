//! PLY: meshes in tables.
//!
//! Of the element `vertex` the properties x, y, z, nx, ny, nz and red, green, blue are read, of
//! `face` the list `vertex_indices` (or `vertex_index`), and the same of `tristrips`, where -1
//! begins another strip.

use crate::color::decode;
use crate::error::{Error, fail};
use crate::formats::ply::{Element, Row, elements, visit};
use crate::limits::{MAX_BYTES, MAX_TRIANGLES, MAX_VERTICES};
use crate::triangle_mesh::TriangleMesh;
use glam::DVec3;

/// Reads the vertices of a PLY file, which needs no faces.
///
/// # Errors
/// Fails as [`crate::read`] does, but not for want of triangles.
pub fn read_points(bytes: &[u8]) -> Result<Vec<DVec3>, Error> {
    if bytes.len() > MAX_BYTES {
        return fail("this file is too large");
    }
    Ok(read(bytes)?.positions)
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    for element in elements(bytes)? {
        let most = match element.name {
            "vertex" => MAX_VERTICES,
            "face" => MAX_TRIANGLES,
            _ => continue,
        };
        if element.count > most as u64 {
            return fail(format!(
                "this file has {} of `{}`, more than the {most} that are taken",
                element.count, element.name
            ));
        }
    }
    let mut mesh = TriangleMesh::default();
    visit(bytes, |element, row| match element.name {
        "vertex" => add_vertex(element, row, &mut mesh),
        "face" | "tristrips" => add_faces(element, row, &mut mesh),
        _ => Ok(()),
    })?;
    Ok(mesh)
}

/// Adds a vertex, with its normal and colour if it has any.
fn add_vertex(element: &Element<'_>, row: &Row, mesh: &mut TriangleMesh) -> Result<(), Error> {
    let triple = |names: [&str; 3]| {
        let [Some(x), Some(y), Some(z)] = names.map(|name| element.column(&[name])) else {
            return None;
        };
        Some([x, y, z])
    };
    let vector = |columns: [usize; 3]| DVec3::from(columns.map(|column| row.values[column]));
    let position = triple(["x", "y", "z"]).map_or(DVec3::NAN, vector);
    if position.is_nan() {
        return Err(element.wrong(row.index, "it has no x, y and z that are numbers"));
    }
    mesh.add_vertex(position)?;
    if let Some(columns) = triple(["nx", "ny", "nz"]) {
        mesh.normals.get_or_insert_default().push(vector(columns));
    }
    if let Some(columns) = triple(["red", "green", "blue"]) {
        let linear = columns.map(|column| {
            let share = element.properties[column].kind.share(row.values[column]);
            decode(share.clamp(0.0, 1.0))
        });
        mesh.colors.get_or_insert_default().push(linear);
    }
    Ok(())
}

/// Adds the triangles of a face, or of strips of them.
fn add_faces(element: &Element<'_>, row: &Row, mesh: &mut TriangleMesh) -> Result<(), Error> {
    let is_strip = element.name == "tristrips";
    for (property, list) in element.properties.iter().zip(&row.lists) {
        if !matches!(property.name, "vertex_indices" | "vertex_index") {
            continue;
        }
        let strips = list.split(|corner| is_strip && *corner == -1.0);
        for strip in strips {
            let is_corner =
                |value: &f64| (0.0..f64::from(u32::MAX)).contains(value) && *value == value.trunc();
            if !strip.iter().all(is_corner) {
                return Err(element.wrong(row.index, "a corner is no whole number from 0"));
            }
            for (i, corners) in strip.windows(3).enumerate() {
                let [a, b, c] = [corners[0], corners[1], corners[2]].map(|x| x as u32);
                mesh.add_triangle(match (is_strip, i % 2) {
                    (false, _) => [strip[0] as u32, b, c],
                    (true, 0) => [a, b, c],
                    // Every second triangle of a strip runs the other way.
                    (true, _) => [b, a, c],
                })?;
            }
        }
    }
    Ok(())
}
