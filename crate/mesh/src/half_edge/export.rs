//! Conversion of the half-edge mesh to lists.

use super::connectivity::HalfEdgeMesh;
use super::id::{EditError, NONE};
use super::soup::PolygonSoup;
use crate::triangle_mesh::TriangleMesh;

impl HalfEdgeMesh {
    /// The faces as polygons. Vertices are numbered in the order of their handles.
    #[must_use]
    pub fn to_polygons(&self) -> PolygonSoup {
        let (positions, numbers) = self.number_vertices();
        let mut soup = PolygonSoup::new(positions);
        let mut face = Vec::new();
        for f in self.faces() {
            face.clear();
            face.extend(self.face_vertices(f).map(|v| numbers[v.index()]));
            soup.add_face(&face);
        }
        soup
    }

    /// The faces as triangles; those with more vertices are cut as by
    /// [`HalfEdgeMesh::triangulate`], so that the result is a manifold, too. Vertices are numbered
    /// in the order of their handles, added centres last.
    ///
    /// # Errors
    /// If cutting them makes the mesh too large.
    pub fn to_triangles(&self) -> Result<TriangleMesh, EditError> {
        if self.faces().any(|f| self.face_degree(f) > 3) {
            let mut cut = self.compact();
            cut.triangulate()?;
            return cut.to_triangles();
        }
        let (positions, numbers) = self.number_vertices();
        let triangles = self.faces().map(|f| {
            let first = self.face_first[f.index()] as usize;
            [first, self.next[first] as usize, self.prev[first] as usize]
                .map(|h| numbers[self.origin[h] as usize])
        });
        Ok(TriangleMesh::new(positions, triangles.collect()))
    }

    /// Returns a copy without free slots. Elements keep their order.
    #[must_use]
    pub fn compact(&self) -> Self {
        let (positions, vertices) = self.number_vertices();
        let faces = numbers(&self.face_first);
        // Pairs stay pairs: both halves are used or free.
        let half_edges = numbers(&self.origin);
        let renumber = |old: &[u32], numbers: &[u32]| -> Vec<u32> {
            let used = old.iter().zip(&self.origin).filter(|(_, v)| **v != NONE);
            used.map(|(i, _)| numbers.get(*i as usize).copied().unwrap_or(NONE))
                .collect()
        };
        let first = |old: &[u32]| -> Vec<u32> {
            let used = old.iter().filter(|h| **h != NONE);
            used.map(|h| half_edges[*h as usize]).collect()
        };
        Self {
            positions,
            outgoing: first(&self.outgoing),
            next: renumber(&self.next, &half_edges),
            prev: renumber(&self.prev, &half_edges),
            origin: renumber(&self.origin, &vertices),
            face: renumber(&self.face, &faces),
            face_first: first(&self.face_first),
            ..Self::default()
        }
    }

    /// The positions of all vertices, and the place of each slot's vertex among them.
    fn number_vertices(&self) -> (Vec<glam::DVec3>, Vec<u32>) {
        let positions = self.vertices().map(|v| self.position(v)).collect();
        (positions, numbers(&self.outgoing))
    }
}

/// The place of each used slot among the used ones.
fn numbers(slots: &[u32]) -> Vec<u32> {
    let mut next = 0;
    slots
        .iter()
        .map(|slot| {
            if *slot == NONE {
                return NONE;
            }
            next += 1;
            next - 1
        })
        .collect()
}
