//! Polygons as lists of vertices, before anything is known of how they fit together.

use crate::triangle_mesh::TriangleMesh;
use glam::DVec3;

/// Polygons given by their vertices, counter-clockwise seen from outside.
///
/// ```
/// use glam::DVec3;
/// use mesh::PolygonSoup;
///
/// let mut soup = PolygonSoup::new(vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y]);
/// soup.add_face(&[0, 1, 2, 3]);
/// assert_eq!(soup.faces().next(), Some(&[0, 1, 2, 3][..]));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonSoup {
    /// Vertex positions.
    pub positions: Vec<DVec3>,
    corners: Vec<u32>,
    /// Index into `corners` at which each face ends.
    ends: Vec<usize>,
}

impl PolygonSoup {
    /// Returns a soup without faces.
    #[must_use]
    pub fn new(positions: Vec<DVec3>) -> Self {
        Self {
            positions,
            corners: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// Adds a polygon: indices into the positions.
    pub fn add_face(&mut self, vertices: &[u32]) {
        self.corners.extend_from_slice(vertices);
        self.ends.push(self.corners.len());
    }

    /// Number of polygons.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.ends.len()
    }

    /// The vertices of each polygon.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        let mut start = 0;
        self.ends.iter().map(move |end| {
            let face = &self.corners[start..*end];
            start = *end;
            face
        })
    }
}

impl From<&TriangleMesh> for PolygonSoup {
    fn from(mesh: &TriangleMesh) -> Self {
        Self {
            positions: mesh.positions.clone(),
            corners: mesh.triangles.as_flattened().to_vec(),
            ends: (1..=mesh.triangles.len()).map(|i| 3 * i).collect(),
        }
    }
}
