//! Edits that add vertices, edges and faces, and the flip of an edge.

use super::connectivity::{HalfEdgeMesh, need_finite};
use super::id::{EditError, FaceId, HalfEdgeId, NONE, VertexId};
use glam::DVec3;

impl HalfEdgeMesh {
    /// Puts a vertex on an edge, and so into the faces on both sides. `h` then leads to the new
    /// vertex, and `next(h)` from there to the old target.
    ///
    /// # Errors
    /// If there is no such half-edge, the position is not finite, or the mesh is full.
    pub fn split_edge(&mut self, h: HalfEdgeId, position: DVec3) -> Result<VertexId, EditError> {
        self.need(self.has_half_edge(h))?;
        need_finite(position)?;
        self.need_room(1)?;
        let (h, t) = (h.0, h.0 ^ 1);
        let v = self.origin[t as usize];
        let m = self.new_vertex(position);
        let n = self.new_edge(m, v);
        let (after, before) = (self.next[h as usize], self.prev[t as usize]);
        self.link(n, after);
        self.link(h, n);
        self.link(before, n ^ 1);
        self.link(n ^ 1, t);
        self.origin[t as usize] = m;
        self.face[n as usize] = self.face[h as usize];
        self.face[n as usize ^ 1] = self.face[t as usize];
        if self.outgoing[v as usize] == t {
            self.outgoing[v as usize] = n ^ 1;
        }
        self.outgoing[m as usize] = if self.face[t as usize] == NONE { t } else { n };
        Ok(VertexId(m))
    }

    /// Puts a vertex on an edge, and joins it with the opposite vertices of the triangles on both
    /// sides, which become two each. Faces with more vertices only get one more.
    ///
    /// # Errors
    /// Fails as [`HalfEdgeMesh::split_edge`] does, and if both triangles have the same opposite
    /// vertex.
    pub fn bisect_edge(&mut self, h: HalfEdgeId, position: DVec3) -> Result<VertexId, EditError> {
        self.need(self.has_half_edge(h))?;
        self.need_room(3)?;
        let sides =
            [h.0, h.0 ^ 1].map(|side| self.face[side as usize] != NONE && self.is_triangle(side));
        let [left, right] =
            [h.index(), h.index() ^ 1].map(|side| self.origin[self.prev[side] as usize]);
        if sides == [true; 2] && left == right {
            return Err(EditError::DoubleEdge);
        }
        let m = self.split_edge(h, position)?;
        // Half-edges that leave the new vertex, left and right.
        let leaving = [self.next(h), self.twin(h)];
        for (is_triangle, leaving) in sides.into_iter().zip(leaving) {
            if is_triangle {
                let opposite = self.next(self.next(leaving));
                self.split_face(leaving, opposite)?;
            }
        }
        Ok(m)
    }

    /// Divides a face by an edge from the origin of `a` to the origin of `b`, two of its
    /// half-edges. The face keeps `a`; the new face, which is returned, gets `b`.
    ///
    /// # Errors
    /// If the half-edges do not exist or are not of one face, if an edge joins their origins
    /// already, or if the mesh is full.
    pub fn split_face(&mut self, a: HalfEdgeId, b: HalfEdgeId) -> Result<FaceId, EditError> {
        self.need(self.has_half_edge(a) && self.has_half_edge(b))?;
        let (a, b) = (a.0, b.0);
        let f = self.face[a as usize];
        if f == NONE || f != self.face[b as usize] {
            return Err(EditError::WrongSide);
        }
        let (from, to) = (self.origin[a as usize], self.origin[b as usize]);
        if from == to || self.are_joined(from, to) {
            return Err(EditError::DoubleEdge);
        }
        self.need_room(1)?;
        let n = self.new_edge(from, to);
        let (before_a, before_b) = (self.prev[a as usize], self.prev[b as usize]);
        self.link(before_b, n ^ 1);
        self.link(n ^ 1, a);
        self.link(before_a, n);
        self.link(n, b);
        self.face[n as usize ^ 1] = f;
        self.face_first[f as usize] = a;
        Ok(FaceId(self.new_face(b)))
    }

    /// Puts a vertex into a face and joins it with all its vertices: n triangles instead of the
    /// face.
    ///
    /// # Errors
    /// If there is no such face, the position is not finite, or the mesh is full.
    pub fn poke_face(&mut self, f: FaceId, position: DVec3) -> Result<VertexId, EditError> {
        self.need(self.has_face(f))?;
        need_finite(position)?;
        let sides: Vec<u32> = self.around(self.face_first[f.index()]).collect();
        self.need_room(sides.len())?;
        let center = self.new_vertex(position);
        // An edge from each vertex to the centre.
        let spokes: Vec<u32> = sides
            .iter()
            .map(|h| self.new_edge(self.origin[*h as usize], center))
            .collect();
        for (i, h) in sides.iter().enumerate() {
            let following = spokes[(i + 1) % spokes.len()];
            self.link(*h, following);
            self.link(following, spokes[i] ^ 1);
            self.link(spokes[i] ^ 1, *h);
        }
        self.outgoing[center as usize] = spokes[0] ^ 1;
        self.remove_face(f.0);
        for h in sides {
            self.new_face(h);
        }
        Ok(VertexId(center))
    }

    /// Closes a hole by one face: the loop of a boundary half-edge.
    ///
    /// # Errors
    /// If there is no such half-edge, or it has a face.
    pub fn close_hole(&mut self, h: HalfEdgeId) -> Result<FaceId, EditError> {
        self.need(self.has_half_edge(h))?;
        if self.face[h.index()] != NONE {
            return Err(EditError::WrongSide);
        }
        Ok(FaceId(self.new_face(h.0)))
    }

    /// Closes a hole by triangles around a new vertex in the middle of its vertices.
    ///
    /// # Errors
    /// If there is no such half-edge, it has a face, or the mesh is full.
    pub fn fill_hole(&mut self, h: HalfEdgeId) -> Result<VertexId, EditError> {
        self.need(self.has_half_edge(h))?;
        if self.face[h.index()] != NONE {
            return Err(EditError::WrongSide);
        }
        let center = self.loop_center(h);
        self.need_room(self.loop_half_edges(h).count())?;
        let face = self.close_hole(h)?;
        self.poke_face(face, center)
    }

    /// The mean of the vertices of a face or a hole.
    #[must_use]
    pub fn loop_center(&self, h: HalfEdgeId) -> DVec3 {
        let count = self.loop_half_edges(h).count() as f64;
        self.loop_half_edges(h)
            .map(|h| self.position(self.origin(h)) / count)
            .sum()
    }

    /// Replaces the edge between two triangles by the other diagonal of their quadrilateral.
    ///
    /// # Errors
    /// If there is no such half-edge, it is not between two triangles, or an edge joins the
    /// opposite vertices already.
    pub fn flip_edge(&mut self, h: HalfEdgeId) -> Result<(), EditError> {
        self.need(self.has_half_edge(h))?;
        let (h, t) = (h.0, h.0 ^ 1);
        let (f, g) = (self.face[h as usize], self.face[t as usize]);
        if f == NONE || g == NONE || !self.is_triangle(h) || !self.is_triangle(t) {
            return Err(EditError::NoTriangle);
        }
        let (n, p) = (self.next[h as usize], self.prev[h as usize]);
        let (tn, tp) = (self.next[t as usize], self.prev[t as usize]);
        let (u, v) = (self.origin[h as usize], self.origin[t as usize]);
        let (w, x) = (self.origin[p as usize], self.origin[tp as usize]);
        if w == x || self.are_joined(w, x) {
            return Err(EditError::DoubleEdge);
        }
        self.origin[h as usize] = x;
        self.origin[t as usize] = w;
        for (a, b) in [(h, p), (p, tn), (tn, h), (t, tp), (tp, n), (n, t)] {
            self.link(a, b);
        }
        self.face[tn as usize] = f;
        self.face[n as usize] = g;
        self.face_first[f as usize] = h;
        self.face_first[g as usize] = t;
        if self.outgoing[u as usize] == h {
            self.outgoing[u as usize] = tn;
        }
        if self.outgoing[v as usize] == t {
            self.outgoing[v as usize] = n;
        }
        Ok(())
    }
}
