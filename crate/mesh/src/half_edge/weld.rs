//! Joining two boundary edges to one.

use super::connectivity::HalfEdgeMesh;
use super::id::{EditError, HalfEdgeId, NONE};

impl HalfEdgeMesh {
    /// Joins two boundary half-edges in opposite directions to one edge between their faces. The
    /// target of `b` becomes the origin of `a`, the origin of `b` the target of `a`, which keep
    /// their numbers and positions. A notch of two edges that would be left beside is closed, too.
    ///
    /// # Errors
    /// If a half-edge does not exist or has a face, or the result would be no simple mesh.
    pub fn weld(&mut self, a: HalfEdgeId, b: HalfEdgeId) -> Result<(), EditError> {
        self.need(self.has_half_edge(a) && self.has_half_edge(b))?;
        let (a, b) = (a.0, b.0);
        if a == b || self.face[a as usize] != NONE || self.face[b as usize] != NONE {
            return Err(EditError::WrongSide);
        }
        let (u, v) = (self.origin[a as usize], self.origin[a as usize ^ 1]);
        let (x, y) = (self.origin[b as usize], self.origin[b as usize ^ 1]);
        // Boundary paths from v to x and from y to u of exactly two half-edges: notches.
        let notches = [(a, b), (b, a)].map(|(from, to)| {
            let first = self.next[from as usize];
            (first != to && self.next[first as usize] == self.prev[to as usize])
                .then(|| [first, self.prev[to as usize]])
                .filter(|[first, second]| first != second)
        });
        let tips = notches.map(|notch| notch.map(|[first, _]| self.origin[first as usize ^ 1]));
        self.can_merge([v, x], [u, y], tips[0])?;
        self.can_merge([u, y], [v, x], tips[1])?;

        for (kept, removed) in [(v, x), (u, y)] {
            let leaving: Vec<u32> = self.around_vertex(removed).collect();
            if kept != removed {
                for h in leaving {
                    self.origin[h as usize] = kept;
                }
            }
        }
        let (after_a, before_a) = (self.next[a as usize], self.prev[a as usize]);
        let (after_b, before_b) = (self.next[b as usize], self.prev[b as usize]);
        if after_a != b {
            self.link(before_b, after_a);
        }
        if after_b != a {
            self.link(before_a, after_b);
        }
        for (kept, removed) in [(v, x), (u, y)] {
            if kept != removed {
                self.remove_vertex(removed);
            }
        }
        self.join_sides(a, b);
        for [first, second] in notches.into_iter().flatten() {
            let tip = self.origin[second as usize];
            self.join_sides(first, second);
            self.set_outgoing(tip, first ^ 1);
        }
        self.set_outgoing(u, a);
        self.set_outgoing(v, a ^ 1);
        Ok(())
    }

    /// Makes a bare half-edge take the place of the twin of another, whose edge is removed.
    fn join_sides(&mut self, kept: u32, removed: u32) {
        let inner = removed ^ 1;
        let (before, after) = (self.prev[inner as usize], self.next[inner as usize]);
        let face = self.face[inner as usize];
        self.link(before, kept);
        self.link(kept, after);
        self.face[kept as usize] = face;
        self.face_first[face as usize] = kept;
        self.remove_edge(removed);
    }

    /// Checks whether two ends of welded edges may become one vertex. The other ends become one,
    /// too; `tip` is the middle of a notch that is closed.
    fn can_merge(
        &self,
        [one, other]: [u32; 2],
        far: [u32; 2],
        tip: Option<u32>,
    ) -> Result<(), EditError> {
        if one == other {
            return Ok(());
        }
        let [near_one, near_other] = [one, other].map(|v| -> Vec<u32> {
            self.neighbors_of(v)
                .map(|n| if n == far[1] { far[0] } else { n })
                .collect()
        });
        // The far end is a neighbour of each by the edge that is welded, and must not be by
        // another.
        for near in [&near_one, &near_other] {
            if near.iter().filter(|v| **v == far[0]).count() > 1 {
                return Err(EditError::DoubleEdge);
            }
        }
        let is_shared = near_one
            .iter()
            .any(|v| *v != far[0] && Some(*v) != tip && near_other.contains(v));
        if near_one.contains(&other) || is_shared {
            return Err(EditError::DoubleEdge);
        }
        for out in self.around_vertex(one) {
            let has_face = self.face[out as usize] != NONE;
            if has_face && self.around(out).any(|h| self.origin[h as usize] == other) {
                return Err(EditError::DegenerateFace);
            }
        }
        Ok(())
    }
}
