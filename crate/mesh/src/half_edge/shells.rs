//! Connected components, boundary loops, and what topology says of them.

use super::connectivity::HalfEdgeMesh;
use super::id::{FaceId, HalfEdgeId, NONE};

/// Connected component of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shell {
    /// Faces of the shell, in ascending order.
    pub faces: Vec<FaceId>,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of holes; 0 if the shell is closed.
    pub boundary_loops: usize,
}

impl Shell {
    /// Vertices − edges + faces.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces.len() as i64
    }

    /// Number of handles: (2 − holes − Euler characteristic) / 2. A sphere has 0, a torus 1.
    #[must_use]
    pub fn genus(&self) -> u64 {
        let twice = 2 - self.boundary_loops as i64 - self.euler_characteristic();
        (twice / 2) as u64
    }
}

impl HalfEdgeMesh {
    /// Vertices − edges + faces.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        self.vertex_count() as i64 - self.edge_count() as i64 + self.face_count() as i64
    }

    /// Returns a boundary half-edge of each hole, in ascending order.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<HalfEdgeId> {
        let mut seen = vec![false; self.next.len()];
        let mut loops = Vec::new();
        for h in self.half_edges() {
            if self.face[h.index()] == NONE && !seen[h.index()] {
                loops.push(h);
                for side in self.around(h.0) {
                    seen[side as usize] = true;
                }
            }
        }
        loops
    }

    /// The connected components, in the order of their lowest face.
    ///
    /// ```
    /// # use glam::DVec3;
    /// # use mesh::{HalfEdgeMesh, PolygonSoup};
    /// let mut soup = PolygonSoup::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y]);
    /// soup.add_face(&[0, 1, 2]);
    /// let shells = HalfEdgeMesh::from_polygons(&soup)?.shells();
    /// assert_eq!((shells.len(), shells[0].boundary_loops, shells[0].genus()), (1, 1, 0));
    /// # Ok::<(), mesh::Error>(())
    /// ```
    #[must_use]
    pub fn shells(&self) -> Vec<Shell> {
        let mut shell_of = vec![NONE; self.face_first.len()];
        let mut shells: Vec<Shell> = Vec::new();
        let mut open: Vec<u32> = Vec::new();
        for face in self.faces() {
            if shell_of[face.index()] != NONE {
                continue;
            }
            let number = shells.len() as u32;
            shell_of[face.index()] = number;
            open.push(face.0);
            while let Some(f) = open.pop() {
                for h in self.around(self.face_first[f as usize]) {
                    let across = self.face[h as usize ^ 1];
                    if across != NONE && shell_of[across as usize] == NONE {
                        shell_of[across as usize] = number;
                        open.push(across);
                    }
                }
            }
            shells.push(Shell {
                faces: Vec::new(),
                vertices: 0,
                edges: 0,
                boundary_loops: 0,
            });
        }
        for face in self.faces() {
            shells[shell_of[face.index()] as usize].faces.push(face);
        }
        for v in self.vertices() {
            let face = self.face_beside(self.outgoing[v.index()]);
            shells[shell_of[face] as usize].vertices += 1;
        }
        for h in self.edges() {
            shells[shell_of[self.face_beside(h.0)] as usize].edges += 1;
        }
        for h in self.boundary_loops() {
            shells[shell_of[self.face_beside(h.0)] as usize].boundary_loops += 1;
        }
        shells
    }

    /// Returns the face of a half-edge, or of its twin: one of them has a face.
    fn face_beside(&self, h: u32) -> usize {
        let face = self.face[h as usize];
        let face = if face == NONE {
            self.face[h as usize ^ 1]
        } else {
            face
        };
        face as usize
    }
}
