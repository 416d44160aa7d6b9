//! The collapse of an edge.

use super::connectivity::{HalfEdgeMesh, need_finite};
use super::id::{EditError, HalfEdgeId, NONE, VertexId};
use glam::DVec3;

impl HalfEdgeMesh {
    /// Removes an edge and the vertex that `h` leaves: its other edges then end at the target of
    /// `h`, which moves to a position. Triangles beside the edge disappear.
    ///
    /// # Errors
    /// If there is no such half-edge, the position is not finite, or the result would be no simple
    /// mesh (the link condition, for faces of any size).
    pub fn collapse_edge(&mut self, h: HalfEdgeId, position: DVec3) -> Result<(), EditError> {
        self.can_collapse(h)?;
        need_finite(position)?;
        let (h, t) = (h.0, h.0 ^ 1);
        let (u, v) = (self.origin[h as usize], self.origin[t as usize]);
        let leaving: Vec<u32> = self.around_vertex(u).collect();
        for out in leaving {
            self.origin[out as usize] = v;
        }
        let mut kept = NONE;
        let sides = [h, t].map(|side| {
            let (before, after) = (self.prev[side as usize], self.next[side as usize]);
            self.link(before, after);
            let face = self.face[side as usize];
            if face != NONE {
                self.face_first[face as usize] = after;
            }
            (face, before, after)
        });
        self.remove_edge(h);
        self.remove_vertex(u);
        for (face, before, after) in sides {
            // The former triangle has two sides left, from v and back.
            kept = after;
            if face != NONE && self.next[after as usize] == before {
                self.remove_face(face);
                self.merge_two_sides(after, before);
                let apex = self.origin[before as usize];
                self.set_outgoing(apex, before);
                kept = before ^ 1;
            }
        }
        self.set_outgoing(v, kept);
        self.positions[v as usize] = position;
        Ok(())
    }

    /// Makes one edge from a loop of two half-edges, there and back: `back` takes the place of the
    /// twin of `there`, whose edge is removed.
    pub(super) fn merge_two_sides(&mut self, there: u32, back: u32) {
        let outer = there ^ 1;
        let (before, after) = (self.prev[outer as usize], self.next[outer as usize]);
        self.link(before, back);
        self.link(back, after);
        let face = self.face[outer as usize];
        self.face[back as usize] = face;
        if face != NONE {
            self.face_first[face as usize] = back;
        }
        self.remove_edge(there);
    }

    /// Checks whether [`HalfEdgeMesh::collapse_edge`] keeps a simple mesh.
    ///
    /// # Errors
    /// The reason if it does not.
    pub fn can_collapse(&self, h: HalfEdgeId) -> Result<(), EditError> {
        self.need(self.has_half_edge(h))?;
        let (h, t) = (h.0, h.0 ^ 1);
        let (u, v) = (self.origin[h as usize], self.origin[t as usize]);

        let on_boundary = [h, t].map(|side| self.face[side as usize] == NONE);
        let are_ends_on_boundary = [u, v].map(|end| self.is_boundary_vertex(VertexId(end)));
        if are_ends_on_boundary == [true; 2] && on_boundary == [false; 2] {
            return Err(EditError::Pinch);
        }

        for (side, is_boundary) in [h, t].into_iter().zip(on_boundary) {
            if is_boundary && self.is_triangle(side) {
                return Err(EditError::DoubleEdge);
            }
        }
        // The third vertex of the triangle on each side.
        let apexes = [h, t].map(|side| {
            let is_apex = self.face[side as usize] != NONE && self.is_triangle(side);
            is_apex.then(|| self.origin[self.prev[side as usize] as usize])
        });
        if apexes[0].is_some() && apexes[0] == apexes[1] {
            return Err(EditError::DegenerateFace);
        }
        let joined_with_v: Vec<u32> = self.neighbors_of(v).collect();
        for w in self.neighbors_of(u) {
            if joined_with_v.contains(&w) && !apexes.contains(&Some(w)) {
                return Err(EditError::DoubleEdge);
            }
        }
        // Other faces that have both vertices would have one twice.
        let beside = [h, t].map(|side| self.face[side as usize]);
        for out in self.around_vertex(u) {
            let face = self.face[out as usize];
            let is_beside = face == NONE || beside.contains(&face);
            if !is_beside && self.around(out).any(|h| self.origin[h as usize] == v) {
                return Err(EditError::DegenerateFace);
            }
        }
        // Two triangles between the same three vertices would remain.
        if apexes.iter().all(Option::is_some)
            && [u, v].iter().all(|end| {
                self.around_vertex(*end).take(4).count() == 3
                    && self
                        .around_vertex(*end)
                        .all(|h| self.face[h as usize] != NONE && self.is_triangle(h))
            })
        {
            return Err(EditError::DegenerateFace);
        }
        Ok(())
    }
}
