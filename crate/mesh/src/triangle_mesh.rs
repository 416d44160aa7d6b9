//! Triangle meshes: positions, triangles between them, and what a file may say beside.

use crate::error::{Error, fail};
use crate::limits::{MAX_COORDINATE, MAX_TRIANGLES, MAX_VERTICES};
use core::ops::Range;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

/// Triangles that share vertices by index.
///
/// ```
/// use glam::DVec3;
/// use mesh::TriangleMesh;
///
/// let mesh = TriangleMesh::new(
///     vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
///     vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
/// );
/// assert_eq!(mesh.corners(3), [DVec3::X, DVec3::Y, DVec3::Z]);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// Vertex positions. Those of a mesh that was read are finite.
    pub positions: Vec<DVec3>,
    /// Vertex normals, one for each position, of any length. A normal of length 0 stands for the
    /// triangle's own. `None` if the triangles are flat.
    pub normals: Option<Vec<DVec3>>,
    /// Vertex colours, one for each position: linear RGB with Rec. 709's primaries, 0 … 1.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Indices into `positions`, three for each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Ranges of triangles that belong together, in ascending order and without overlap. Triangles
    /// outside all of them belong to no group.
    pub groups: Vec<Group>,
}

/// Named range of a mesh's triangles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Name; may be empty.
    pub name: String,
    /// Material of all triangles of the group.
    pub material: Option<Material>,
    /// Indices into [`TriangleMesh::triangles`].
    pub triangles: Range<u32>,
}

/// Surface material: what GLB, 3MF and MTL can all say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Name; may be empty.
    pub name: String,
    /// Base colour: linear RGB with Rec. 709's primaries, 0 … 1.
    pub color: [f32; 3],
    /// Perceptual roughness of glTF's microfacet model, 0 (mirror) … 1 (matt).
    pub roughness: f32,
}

impl Default for Material {
    /// White and matt, without a name.
    fn default() -> Self {
        Self {
            name: String::new(),
            color: [1.0; 3],
            roughness: 1.0,
        }
    }
}

impl TriangleMesh {
    /// Returns a mesh without normals, colours and groups.
    #[must_use]
    pub fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            positions,
            triangles,
            ..Self::default()
        }
    }

    /// Positions of the three vertices of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle, or it has a vertex that does not exist.
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    /// Adds a vertex.
    pub(crate) fn add_vertex(&mut self, position: DVec3) -> Result<u32, Error> {
        if self.positions.len() == MAX_VERTICES {
            return fail(format!("more than {MAX_VERTICES} corners"));
        }
        self.positions.push(position);
        Ok(self.positions.len() as u32 - 1)
    }

    /// Adds a triangle; its vertices may still be to come.
    pub(crate) fn add_triangle(&mut self, vertices: [u32; 3]) -> Result<(), Error> {
        if self.triangles.len() == MAX_TRIANGLES {
            return fail(format!(
                "more than {MAX_TRIANGLES} triangles; simplify the mesh first"
            ));
        }
        self.triangles.push(vertices);
        Ok(())
    }

    /// Checks indices and positions, and removes triangles without area and those that are there
    /// twice. Returns sentences about what was removed, too.
    pub(crate) fn check(mut self) -> Result<(Self, Vec<String>), Error> {
        let count = self.positions.len();
        let last = self.triangles.iter().flatten().max();
        if let Some(last) = last.filter(|i| **i as usize >= count) {
            return fail(format!(
                "a triangle has corner {last} (from 0), but there are {count} corners"
            ));
        }
        // A mesh far from everything would come out as nothing.
        if let Some(i) = self
            .positions
            .iter()
            .position(|p| !p.is_finite() || p.abs().max_element() > MAX_COORDINATE)
        {
            return fail(format!(
                "the coordinates of corner {i} (from 0) are not all within ±{MAX_COORDINATE:e}"
            ));
        }
        let count_of_triangles = self.triangles.len();
        let mut remarks = Vec::new();
        let flat = self.keep_triangles(|[a, b, c]| {
            let (ab, ac) = (b - a, c - a);
            ab.cross(ac).length() > 1e-12 * ab.length() * ac.length()
        });
        if flat > 0 {
            remarks.push(format!("{flat} triangles without an area are left out"));
        }
        let mut seen = HashSet::with_capacity(self.triangles.len());
        let doubles = self.keep_triangles(|corners| seen.insert(key(corners)));
        if doubles > 0 {
            remarks.push(format!(
                "{doubles} triangles that are there twice are left out"
            ));
        }
        if self.triangles.is_empty() {
            return fail(match count_of_triangles {
                0 => String::from("there are no triangles in this file"),
                _ => String::from("no triangle in this file has an area"),
            });
        }
        match &mut self.normals {
            Some(normals) if normals.len() == count => {
                for normal in normals.iter_mut().filter(|n| !n.is_finite()) {
                    *normal = DVec3::ZERO;
                }
            }
            other => *other = None,
        }
        match &mut self.colors {
            Some(colors) if colors.len() == count => {
                for channel in colors.iter_mut().flatten() {
                    *channel = if channel.is_nan() {
                        0.0
                    } else {
                        channel.clamp(0.0, 1.0)
                    };
                }
            }
            other => *other = None,
        }
        Ok((self, remarks))
    }

    /// Keeps the triangles whose corners pass a test, moves the ranges of the groups, and returns
    /// the number of others.
    fn keep_triangles(&mut self, mut passes: impl FnMut([DVec3; 3]) -> bool) -> usize {
        // How many triangles remain of the first i.
        let mut remaining = vec![0];
        let mut count = 0;
        for i in 0..self.triangles.len() {
            count += u32::from(passes(self.corners(i)));
            remaining.push(count);
        }
        let before = self.triangles.len();
        if count as usize == before {
            return 0;
        }
        for group in &mut self.groups {
            let Range { start, end } = group.triangles;
            group.triangles = remaining[start as usize]..remaining[end as usize];
        }
        self.groups.retain(|group| !group.triangles.is_empty());
        let mut triangle = 0;
        self.triangles.retain(|_| {
            triangle += 1;
            remaining[triangle] > remaining[triangle - 1]
        });
        before - self.triangles.len()
    }
}

/// Returns numbers that are the same for triangles with the same corners that face the same side.
fn key(corners: [DVec3; 3]) -> [[u64; 3]; 3] {
    // A zero has no sign.
    let bits = corners.map(|corner| (corner + DVec3::ZERO).to_array().map(f64::to_bits));
    let [a, b, c] = bits;
    [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .min()
        .unwrap_or(bits)
}
