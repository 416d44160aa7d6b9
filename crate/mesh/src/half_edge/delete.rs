//! Removing faces.

use super::connectivity::HalfEdgeMesh;
use super::id::{EditError, FaceId, NONE, VertexId};

/// Vertex that became two, as the faces that were left around it met nowhere but there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexCopy {
    /// The vertex there was.
    pub original: VertexId,
    /// New vertex at the same position, with some of its edges.
    pub copy: VertexId,
}

impl HalfEdgeMesh {
    /// Removes faces, and with them edges and vertices without a face. A vertex at which
    /// several fans of faces are left becomes one vertex for each; these copies are returned.
    ///
    /// # Errors
    /// If a face does not exist or is named twice; then none is removed.
    pub fn delete_faces(&mut self, faces: &[FaceId]) -> Result<Vec<VertexCopy>, EditError> {
        let mut sorted: Vec<FaceId> = faces.to_vec();
        sorted.sort_unstable();
        let is_repeated = sorted.windows(2).any(|pair| pair[0] == pair[1]);
        self.need(!is_repeated && faces.iter().all(|f| self.has_face(*f)))?;
        let mut sides: Vec<u32> = Vec::new();
        for f in faces {
            sides.extend(self.around(self.face_first[f.index()]));
            self.remove_face(f.0);
        }
        for h in &sides {
            self.face[*h as usize] = NONE;
        }
        let mut touched: Vec<u32> = sides.iter().map(|h| self.origin[*h as usize]).collect();
        touched.sort_unstable();
        touched.dedup();
        for h in sides {
            // An edge between two removed faces appears twice.
            let is_there = self.origin[h as usize] != NONE;
            if is_there && self.face[h as usize ^ 1] == NONE {
                self.remove_bare_edge(h);
            }
        }
        let mut copies = Vec::new();
        for v in touched {
            if self.outgoing[v as usize] != NONE {
                self.separate_fans(v, &mut copies);
            }
        }
        Ok(copies)
    }

    /// Removes an edge without faces; also a vertex whose last edge it was.
    fn remove_bare_edge(&mut self, h: u32) {
        for h in [h, h ^ 1] {
            let t = h ^ 1;
            // At the origin: from before h to after its twin.
            let v = self.origin[h as usize];
            let (before, after) = (self.prev[h as usize], self.next[t as usize]);
            if after == h {
                self.remove_vertex(v);
            } else {
                self.link(before, after);
                self.outgoing[v as usize] = after;
            }
        }
        self.remove_edge(h);
    }

    /// Gives each fan of faces at a vertex a vertex of its own: the vertex keeps the first.
    fn separate_fans(&mut self, v: u32, copies: &mut Vec<VertexCopy>) {
        // Every fan begins with a boundary half-edge that leaves the vertex and ends with one that
        // arrives.
        let leaving: Vec<u32> = self.around_vertex(v).collect();
        let Some(start) = leaving.iter().position(|h| self.face[*h as usize] == NONE) else {
            return;
        };
        let from_boundary = [&leaving[start..], &leaving[..start]].concat();
        let fans = from_boundary.chunk_by(|_, h| self.face[*h as usize] != NONE);
        let fans: Vec<Vec<u32>> = fans.map(<[u32]>::to_vec).collect();
        for (i, fan) in fans.iter().enumerate() {
            let (first, last) = (fan[0], fan[fan.len() - 1]);
            let owner = match i {
                0 => v,
                _ => self.new_vertex(self.positions[v as usize]),
            };
            self.link(last ^ 1, first);
            self.outgoing[owner as usize] = first;
            if i > 0 {
                for h in fan {
                    self.origin[*h as usize] = owner;
                }
                copies.push(VertexCopy {
                    original: VertexId(v),
                    copy: VertexId(owner),
                });
            }
        }
    }
}
