//! The arrays of a half-edge mesh, and ways from one element to the next.

use super::id::{EditError, FaceId, HalfEdgeId, NONE, VertexId};
use crate::limits::MAX_HALF_EDGES;
use glam::DVec3;

/// Polygon mesh whose edges know their neighbours: a 2-manifold with or without boundary,
/// consistently oriented, of faces with any number of vertices.
///
/// Each edge is a pair of half-edges in opposite directions, numbered h and h ^ 1. A half-edge
/// belongs to the face on its left, or to none: then it is a boundary half-edge, and those of a
/// hole form a loop just as those of a face do. Of two vertices at most one edge joins them, a face
/// has no vertex twice, and the faces at a vertex form one fan; every edit keeps that, or is
/// refused.
///
/// All data are in arrays of 32-bit numbers, about 66 bytes for each triangle and 0.5 vertices.
/// Numbers of removed elements are used again, last removed first, so that the same edits give the
/// same numbers everywhere.
///
/// ```
/// use glam::DVec3;
/// use mesh::{HalfEdgeMesh, PolygonSoup};
///
/// let mut soup = PolygonSoup::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
/// for triangle in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
///     soup.add_face(&triangle);
/// }
/// let mut mesh = HalfEdgeMesh::from_polygons(&soup)?;
/// assert!(mesh.is_closed());
///
/// let face = mesh.faces().next().unwrap();
/// let around: Vec<_> = mesh.face_half_edges(face).map(|h| mesh.origin(h).0).collect();
/// assert_eq!(around, [0, 2, 1]);
///
/// // A fifth vertex in the middle of an edge.
/// let edge = mesh.face_half_edges(face).next().unwrap();
/// let middle = 0.5 * (mesh.position(mesh.origin(edge)) + mesh.position(mesh.target(edge)));
/// let vertex = mesh.split_edge(edge, middle)?;
/// assert_eq!(mesh.degree(vertex), 2);
/// assert_eq!(mesh.euler_characteristic(), 2);
/// mesh.validate()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HalfEdgeMesh {
    pub(super) positions: Vec<DVec3>,
    /// Half-edge that leaves each vertex: the boundary one if there is one; `NONE` for a free slot.
    pub(super) outgoing: Vec<u32>,
    pub(super) next: Vec<u32>,
    pub(super) prev: Vec<u32>,
    /// The vertex that each half-edge leaves; `NONE` for a free slot.
    pub(super) origin: Vec<u32>,
    /// The face on the left of each half-edge; `NONE` on the boundary.
    pub(super) face: Vec<u32>,
    /// Half-edge of each face; `NONE` for a free slot.
    pub(super) face_first: Vec<u32>,
    pub(super) free_vertices: Vec<u32>,
    /// Even half-edges of free pairs.
    pub(super) free_edges: Vec<u32>,
    pub(super) free_faces: Vec<u32>,
}

impl HalfEdgeMesh {
    /// Number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.positions.len() - self.free_vertices.len()
    }

    /// Number of edges (pairs of half-edges).
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.next.len() / 2 - self.free_edges.len()
    }

    /// Number of faces.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.face_first.len() - self.free_faces.len()
    }

    /// Number of slots for vertices, one more than the largest number of a vertex: the length of
    /// arrays that are kept beside the mesh.
    #[must_use]
    pub fn vertex_slots(&self) -> usize {
        self.positions.len()
    }

    /// Number of slots for faces, one more than the largest number of a face.
    #[must_use]
    pub fn face_slots(&self) -> usize {
        self.face_first.len()
    }

    /// Number of slots for half-edges, one more than the largest number of a half-edge.
    #[must_use]
    pub fn half_edge_slots(&self) -> usize {
        self.next.len()
    }

    /// Iterates over the vertices in ascending order.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> {
        numbers_in_use(&self.outgoing).map(VertexId)
    }

    /// Iterates over the faces in ascending order.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> {
        numbers_in_use(&self.face_first).map(FaceId)
    }

    /// Iterates over the half-edges in ascending order.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> {
        numbers_in_use(&self.origin).map(HalfEdgeId)
    }

    /// Iterates over the edges in ascending order; of each, its even half-edge is given.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdgeId> {
        self.half_edges().step_by(2)
    }

    /// `true` if the vertex is in the mesh.
    #[must_use]
    pub fn has_vertex(&self, v: VertexId) -> bool {
        self.outgoing.get(v.index()).is_some_and(|h| *h != NONE)
    }

    /// `true` if the half-edge is in the mesh.
    #[must_use]
    pub fn has_half_edge(&self, h: HalfEdgeId) -> bool {
        self.origin.get(h.index()).is_some_and(|v| *v != NONE)
    }

    /// `true` if the face is in the mesh.
    #[must_use]
    pub fn has_face(&self, f: FaceId) -> bool {
        self.face_first.get(f.index()).is_some_and(|h| *h != NONE)
    }

    /// Position of a vertex.
    ///
    /// # Panics
    /// This and the ways from an element to the next panic if a number is beyond the slots.
    #[must_use]
    pub fn position(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }

    /// Moves a vertex.
    ///
    /// # Errors
    /// If there is no such vertex, or the position is not finite.
    pub fn set_position(&mut self, v: VertexId, position: DVec3) -> Result<(), EditError> {
        self.need(self.has_vertex(v))?;
        need_finite(position)?;
        self.positions[v.index()] = position;
        Ok(())
    }

    /// The half-edge in the opposite direction.
    #[must_use]
    pub fn twin(&self, h: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(h.0 ^ 1)
    }

    /// The next half-edge around the face or the hole.
    #[must_use]
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(self.next[h.index()])
    }

    /// The half-edge before this one around the face or the hole.
    #[must_use]
    pub fn previous(&self, h: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(self.prev[h.index()])
    }

    /// The vertex that a half-edge leaves.
    #[must_use]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        VertexId(self.origin[h.index()])
    }

    /// The vertex that a half-edge leads to.
    #[must_use]
    pub fn target(&self, h: HalfEdgeId) -> VertexId {
        VertexId(self.origin[h.index() ^ 1])
    }

    /// The face on the left of a half-edge; `None` on the boundary.
    #[must_use]
    pub fn face(&self, h: HalfEdgeId) -> Option<FaceId> {
        let face = self.face[h.index()];
        (face != NONE).then_some(FaceId(face))
    }

    /// Returns a half-edge that leaves a vertex: the boundary half-edge if there is one.
    #[must_use]
    pub fn outgoing(&self, v: VertexId) -> HalfEdgeId {
        HalfEdgeId(self.outgoing[v.index()])
    }

    /// `true` if the boundary passes the vertex.
    #[must_use]
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.face[self.outgoing[v.index()] as usize] == NONE
    }

    /// `true` if the half-edge or its twin has no face.
    #[must_use]
    pub fn is_boundary_edge(&self, h: HalfEdgeId) -> bool {
        self.face[h.index()] == NONE || self.face[h.index() ^ 1] == NONE
    }

    /// `true` if no edge is on a boundary.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.half_edges().all(|h| self.face[h.index()] != NONE)
    }

    /// The half-edges that leave a vertex, clockwise seen from outside.
    pub fn vertex_half_edges(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> {
        self.around_vertex(v.0).map(HalfEdgeId)
    }

    /// The vertices that an edge joins with a vertex, clockwise seen from outside.
    pub fn neighbors(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.neighbors_of(v.0).map(VertexId)
    }

    /// The faces at a vertex, clockwise seen from outside.
    pub fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        self.vertex_half_edges(v).filter_map(|h| self.face(h))
    }

    /// The half-edges around a face, counter-clockwise seen from outside.
    pub fn face_half_edges(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> {
        self.around(self.face_first[f.index()]).map(HalfEdgeId)
    }

    /// The vertices around a face, counter-clockwise seen from outside.
    pub fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.face_half_edges(f).map(|h| self.origin(h))
    }

    /// The half-edges around the face or the hole that a half-edge belongs to, from it on.
    pub fn loop_half_edges(&self, h: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> {
        self.around(h.0).map(HalfEdgeId)
    }

    /// Number of edges at a vertex.
    #[must_use]
    pub fn degree(&self, v: VertexId) -> usize {
        self.around_vertex(v.0).count()
    }

    /// Number of vertices of a face.
    #[must_use]
    pub fn face_degree(&self, f: FaceId) -> usize {
        self.face_half_edges(f).count()
    }

    /// The half-edge from a vertex to another, if an edge joins them.
    #[must_use]
    pub fn find_half_edge(&self, from: VertexId, to: VertexId) -> Option<HalfEdgeId> {
        self.vertex_half_edges(from).find(|h| self.target(*h) == to)
    }

    pub(super) fn around(&self, first: u32) -> impl Iterator<Item = u32> + use<'_> {
        cycle(first, |h| self.next[h as usize])
    }

    pub(super) fn around_vertex(&self, v: u32) -> impl Iterator<Item = u32> + use<'_> {
        cycle(self.outgoing[v as usize], |h| self.next[h as usize ^ 1])
    }

    pub(super) fn neighbors_of(&self, v: u32) -> impl Iterator<Item = u32> + use<'_> {
        self.around_vertex(v).map(|h| self.origin[h as usize ^ 1])
    }

    pub(super) fn are_joined(&self, a: u32, b: u32) -> bool {
        self.neighbors_of(a).any(|v| v == b)
    }

    pub(super) fn is_triangle(&self, h: u32) -> bool {
        self.around(h).take(4).count() == 3
    }

    pub(super) fn need(&self, is_there: bool) -> Result<(), EditError> {
        if is_there {
            Ok(())
        } else {
            Err(EditError::Missing)
        }
    }

    /// Makes `b` follow `a` in its loop.
    pub(super) fn link(&mut self, a: u32, b: u32) {
        self.next[a as usize] = b;
        self.prev[b as usize] = a;
    }

    /// Chooses the outgoing half-edge of a vertex anew, from one that leaves it.
    pub(super) fn set_outgoing(&mut self, v: u32, h: u32) {
        self.outgoing[v as usize] = h;
        let boundary = self
            .around_vertex(v)
            .find(|h| self.face[*h as usize] == NONE);
        if let Some(boundary) = boundary {
            self.outgoing[v as usize] = boundary;
        }
    }

    /// Refuses an edit that adds `edges` edges if there is no room.
    pub(super) fn need_room(&self, edges: usize) -> Result<(), EditError> {
        let free = 2 * self.free_edges.len();
        if self.next.len() + (2 * edges).saturating_sub(free) > MAX_HALF_EDGES {
            return Err(EditError::Full);
        }
        Ok(())
    }

    /// Adds a vertex without edges; the caller sets its outgoing half-edge.
    pub(super) fn new_vertex(&mut self, position: DVec3) -> u32 {
        if let Some(v) = self.free_vertices.pop() {
            self.positions[v as usize] = position;
            return v;
        }
        self.positions.push(position);
        self.outgoing.push(NONE);
        self.positions.len() as u32 - 1
    }

    /// Adds a pair of half-edges that are in no loop; returns the one that leaves `from`.
    pub(super) fn new_edge(&mut self, from: u32, to: u32) -> u32 {
        if let Some(h) = self.free_edges.pop() {
            self.origin[h as usize] = from;
            self.origin[h as usize ^ 1] = to;
            return h;
        }
        let h = self.next.len() as u32;
        for vertex in [from, to] {
            self.origin.push(vertex);
            self.next.push(NONE);
            self.prev.push(NONE);
            self.face.push(NONE);
        }
        h
    }

    /// Makes a face of the loop of a half-edge, and sets it on the loop's half-edges.
    pub(super) fn new_face(&mut self, first: u32) -> u32 {
        let f = match self.free_faces.pop() {
            Some(f) => f,
            None => {
                self.face_first.push(NONE);
                self.face_first.len() as u32 - 1
            }
        };
        self.face_first[f as usize] = first;
        let mut h = first;
        loop {
            self.face[h as usize] = f;
            h = self.next[h as usize];
            if h == first {
                return f;
            }
        }
    }

    pub(super) fn remove_vertex(&mut self, v: u32) {
        self.outgoing[v as usize] = NONE;
        self.positions[v as usize] = DVec3::ZERO;
        self.free_vertices.push(v);
    }

    pub(super) fn remove_edge(&mut self, h: u32) {
        let even = h & !1;
        for h in [even, even + 1] {
            for array in [
                &mut self.origin,
                &mut self.next,
                &mut self.prev,
                &mut self.face,
            ] {
                array[h as usize] = NONE;
            }
        }
        self.free_edges.push(even);
    }

    pub(super) fn remove_face(&mut self, f: u32) {
        self.face_first[f as usize] = NONE;
        self.free_faces.push(f);
    }
}

/// Refuses positions that are not finite.
pub(super) fn need_finite(position: DVec3) -> Result<(), EditError> {
    if position.is_finite() {
        Ok(())
    } else {
        Err(EditError::NotFinite)
    }
}

/// The numbers of used slots.
fn numbers_in_use(slots: &[u32]) -> impl Iterator<Item = u32> {
    let numbered = slots.iter().zip(0..);
    numbered.filter(|(slot, _)| **slot != NONE).map(|(_, i)| i)
}

/// The elements of a cycle, from the first on.
fn cycle(first: u32, step: impl Fn(u32) -> u32) -> impl Iterator<Item = u32> {
    core::iter::successors(Some(first), move |h| {
        let h = step(*h);
        (h != first).then_some(h)
    })
}
