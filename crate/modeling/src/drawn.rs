//! The mesh as it is drawn.

use crate::brush::Brush;
use glam::{DVec3, Vec3};
use sculpt::{Clay, Region};
use viewport::Surface;

/// The colour of clay that is not painted, as shown.
const CLAY: [f32; 3] = [0.80, 0.66, 0.56];
/// The colour that a mask turns it to.
const MASK: [f32; 3] = [0.24, 0.28, 0.36];

/// Brings a surface up to date. With `is_same_topology` only places and colours have changed.
pub fn update(surface: &mut Surface, clay: &Clay, is_same_topology: bool) {
    let mesh = clay.mesh();
    if !is_same_topology {
        surface.triangles.clear();
        surface.chosen.clear();
        surface.edges.clear();
        let mut corners = Vec::new();
        let marks = match clay.region() {
            Region::All => Vec::new(),
            Region::Faces(faces) => {
                let mut marks = vec![false; mesh.face_slots()];
                faces.iter().for_each(|f| marks[f.index()] = true);
                marks
            }
        };
        for f in mesh.faces() {
            corners.clear();
            corners.extend(mesh.face_vertices(f).map(|v| v.0));
            for i in 2..corners.len() {
                surface
                    .triangles
                    .push([corners[0], corners[i - 1], corners[i]]);
                if !marks.is_empty() {
                    surface.chosen.push(marks[f.index()]);
                }
            }
        }
        let edges = mesh.edges().map(|h| [mesh.origin(h).0, mesh.target(h).0]);
        surface.edges.extend(edges);
        surface.is_closed = mesh.is_closed();
        surface.positions.clear();
        surface.positions.resize(mesh.vertex_slots(), Vec3::ZERO);
        surface.colors.clear();
        surface.colors.resize(mesh.vertex_slots(), CLAY);
    }
    for v in mesh.vertices() {
        surface.positions[v.index()] = mesh.position(v).as_vec3();
        let own = clay.color(v);
        let color = if own == [1.0; 3] {
            CLAY
        } else {
            own.map(encode)
        };
        let mask = 0.75 * clay.mask(v);
        surface.colors[v.index()] = [0, 1, 2].map(|k| color[k] + (MASK[k] - color[k]) * mask);
    }
    surface.smooth();
}

/// A mesh ready to be drawn, in the colours of clay, paint and masks.
#[must_use]
pub fn surface_of(clay: &Clay) -> Surface {
    let mut surface = Surface::default();
    update(&mut surface, clay, false);
    surface
}

/// The sRGB value of a linear channel.
fn encode(x: f32) -> f32 {
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * libm::powf(x, 1.0 / 2.4) - 0.055
    }
}

/// The tool as it is drawn, about the origin.
pub fn tool(brush: &Brush, decimals: i32) -> Surface {
    let soup = brush.tool(decimals).polyhedron(8);
    let mut surface = Surface {
        positions: soup.positions.iter().map(|p| p.as_vec3()).collect(),
        is_closed: true,
        ..Surface::default()
    };
    for face in soup.faces() {
        for i in 2..face.len() {
            surface.triangles.push([face[0], face[i - 1], face[i]]);
        }
    }
    surface.smooth();
    surface
}

/// The box around the mesh.
pub fn bounds(clay: &Clay) -> [DVec3; 2] {
    let mesh = clay.mesh();
    let mut places = mesh.vertices().map(|v| mesh.position(v));
    let first = places.next().unwrap_or(DVec3::ZERO);
    places.fold([first; 2], |[low, high], p| [low.min(p), high.max(p)])
}
