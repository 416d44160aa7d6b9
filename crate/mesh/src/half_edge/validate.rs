//! Checking all invariants.

use super::connectivity::HalfEdgeMesh;
use super::id::NONE;
use core::fmt;

/// An invariant that does not hold, and the number of the element where it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The condition that does not hold.
    pub invariant: &'static str,
    /// Number of the vertex, half-edge or face.
    pub element: usize,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: not so at {}", self.invariant, self.element)
    }
}

impl core::error::Error for Violation {}

/// Whether a slot exists and is used.
fn is_used(slots: &[u32], i: u32) -> bool {
    slots.get(i as usize).is_some_and(|s| *s != NONE)
}

/// Returns an error unless all elements pass.
fn all(
    invariant: &'static str,
    mut elements: impl Iterator<Item = usize>,
    holds: impl Fn(usize) -> bool,
) -> Result<(), Violation> {
    match elements.find(|i| !holds(*i)) {
        Some(element) => Err(Violation { invariant, element }),
        None => Ok(()),
    }
}

impl HalfEdgeMesh {
    /// Checks every invariant of the structure, in time proportional to the mesh (and to the square
    /// of the largest number of edges at a vertex).
    ///
    /// # Errors
    /// The first violation found.
    pub fn validate(&self) -> Result<(), Violation> {
        self.validate_slots()?;
        self.validate_loops()?;
        self.validate_vertices()
    }

    /// Numbers are in range, and free slots are listed once.
    fn validate_slots(&self) -> Result<(), Violation> {
        let half_edges = 0..self.next.len();
        all(
            "half-edges of a pair are both used or both free",
            half_edges.clone(),
            |h| {
                let pair = [h, h ^ 1];
                let is_free = pair.iter().all(|h| {
                    let arrays = [&self.origin, &self.next, &self.prev, &self.face];
                    arrays.iter().all(|array| array[*h] == NONE)
                });
                is_free
                    || pair
                        .iter()
                        .all(|h| is_used(&self.outgoing, self.origin[*h]))
            },
        )?;
        all(
            "next and previous are used half-edges",
            half_edges.clone(),
            |h| {
                self.origin[h] == NONE
                    || (is_used(&self.origin, self.next[h]) && is_used(&self.origin, self.prev[h]))
            },
        )?;
        all("the face of a half-edge is used", half_edges, |h| {
            self.face[h] == NONE || is_used(&self.face_first, self.face[h])
        })?;
        for (invariant, slots, free, step) in [
            (
                "free vertices are listed once",
                &self.outgoing,
                &self.free_vertices,
                1,
            ),
            (
                "free edges are listed once",
                &self.origin,
                &self.free_edges,
                2,
            ),
            (
                "free faces are listed once",
                &self.face_first,
                &self.free_faces,
                1,
            ),
        ] {
            let mut listed = free.clone();
            listed.sort_unstable();
            let unused = (0..slots.len()).step_by(step).filter(|i| slots[*i] == NONE);
            if !unused.eq(listed.iter().map(|i| *i as usize)) {
                return Err(Violation {
                    invariant,
                    element: free.len(),
                });
            }
        }
        all("positions are finite", 0..self.positions.len(), |v| {
            self.positions[v].is_finite()
        })
    }

    /// Loops close, have one face and no vertex twice.
    fn validate_loops(&self) -> Result<(), Violation> {
        let half_edges = || self.half_edges().map(|h| h.index());
        all(
            "previous of next is the half-edge itself",
            half_edges(),
            |h| self.prev[self.next[h] as usize] as usize == h,
        )?;
        all("the next half-edge leaves the target", half_edges(), |h| {
            self.origin[self.next[h] as usize] == self.origin[h ^ 1]
        })?;
        all("a loop has one face", half_edges(), |h| {
            self.face[self.next[h] as usize] == self.face[h]
        })?;
        all("an edge has a face", half_edges(), |h| {
            self.face[h] != NONE || self.face[h ^ 1] != NONE
        })?;
        all("an edge joins two vertices", half_edges(), |h| {
            self.origin[h] != self.origin[h ^ 1]
        })?;
        // Each half-edge is in the loop of its face's first.
        let mut seen = vec![false; self.next.len()];
        let mut last_seen = vec![NONE; self.positions.len()];
        let faces = self.faces().map(|f| (self.face_first[f.index()], f.0));
        let loops: Vec<(u32, u32)> = faces.collect();
        for (number, (first, face)) in loops.into_iter().enumerate() {
            if self.face.get(first as usize) != Some(&face) {
                return Err(Violation {
                    invariant: "the first half-edge of a face belongs to it",
                    element: face as usize,
                });
            }
            self.validate_loop(first, number as u32, &mut seen, &mut last_seen)?;
        }
        all(
            "a half-edge is in the loop of its face",
            half_edges(),
            |h| self.face[h] == NONE || seen[h],
        )?;
        let mut number = self.face_first.len() as u32;
        for h in half_edges() {
            if !seen[h] {
                self.validate_loop(h as u32, number, &mut seen, &mut last_seen)?;
                number += 1;
            }
        }
        Ok(())
    }

    /// Checks that a loop has three vertices or more, and none twice.
    fn validate_loop(
        &self,
        first: u32,
        number: u32,
        seen: &mut [bool],
        last_seen: &mut [u32],
    ) -> Result<(), Violation> {
        let mut count = 0;
        for h in self.around(first) {
            let vertex = self.origin[h as usize] as usize;
            let is_repeated = last_seen[vertex] == number;
            if is_repeated || seen[h as usize] {
                return Err(Violation {
                    invariant: "a face or hole has no vertex twice",
                    element: h as usize,
                });
            }
            last_seen[vertex] = number;
            seen[h as usize] = true;
            count += 1;
        }
        if count < 3 {
            return Err(Violation {
                invariant: "a face or hole has three vertices or more",
                element: first as usize,
            });
        }
        Ok(())
    }

    /// The half-edges that leave a vertex are one fan, and lead to different vertices.
    fn validate_vertices(&self) -> Result<(), Violation> {
        let mut leaving = vec![0_u32; self.positions.len()];
        for h in self.half_edges() {
            leaving[self.origin[h.index()] as usize] += 1;
        }
        for v in self.vertices().map(|v| v.0) {
            let at = |invariant| Violation {
                invariant,
                element: v as usize,
            };
            let first = self.outgoing[v as usize] as usize;
            if self.origin.get(first) != Some(&v) {
                return Err(at("the outgoing half-edge leaves its vertex"));
            }
            let mut neighbors: Vec<u32> = self.neighbors_of(v).collect();
            if neighbors.len() != leaving[v as usize] as usize {
                return Err(at("all half-edges that leave a vertex are reached"));
            }
            let bare = self
                .around_vertex(v)
                .filter(|h| self.face[*h as usize] == NONE)
                .count();
            if bare > 1 {
                return Err(at("the boundary passes a vertex once"));
            }
            if bare == 1 && self.face[first] != NONE {
                return Err(at("the outgoing half-edge is the boundary's"));
            }
            neighbors.sort_unstable();
            if neighbors.windows(2).any(|pair| pair[0] == pair[1]) {
                return Err(at("two vertices are joined by one edge"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::half_edge::soup::PolygonSoup;
    use glam::DVec3;

    /// Returns a pyramid without its base, beside free slots.
    fn pyramid() -> HalfEdgeMesh {
        let corners = [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0], [0, 0, 1]];
        let positions = corners.map(|p| DVec3::from(p.map(f64::from)));
        let mut soup = PolygonSoup::new(positions.to_vec());
        for face in [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] {
            soup.add_face(&face);
        }
        let mut mesh = HalfEdgeMesh::from_polygons(&soup).unwrap();
        let h = mesh.half_edges().next().unwrap();
        let middle = mesh.split_edge(h, DVec3::X).unwrap();
        let h = mesh.outgoing(middle);
        mesh.collapse_edge(h, DVec3::Y).unwrap();
        mesh
    }

    /// Every single number that is changed is noticed, where it makes a difference.
    #[test]
    fn damage_is_noticed() {
        let sound = pyramid();
        assert_eq!(sound.validate(), Ok(()));
        let arrays: [fn(&mut HalfEdgeMesh) -> &mut Vec<u32>; 9] = [
            |m| &mut m.next,
            |m| &mut m.prev,
            |m| &mut m.origin,
            |m| &mut m.face,
            |m| &mut m.outgoing,
            |m| &mut m.face_first,
            |m| &mut m.free_vertices,
            |m| &mut m.free_edges,
            |m| &mut m.free_faces,
        ];
        let mut noticed = 0;
        for (number, array) in arrays.iter().enumerate() {
            let length = array(&mut sound.clone()).len();
            for i in 0..length {
                for value in (0..20).chain([NONE]) {
                    let mut damaged = sound.clone();
                    let old = core::mem::replace(&mut array(&mut damaged)[i], value);
                    // Any half-edge of a face, or of an inner vertex, may be its first.
                    let is_other_first = match number {
                        4 => {
                            sound.origin.get(value as usize) == Some(&(i as u32))
                                && sound.face[old as usize] != NONE
                        }
                        5 => sound.face.get(value as usize) == Some(&(i as u32)),
                        _ => false,
                    };
                    if value != old && !is_other_first {
                        assert!(damaged.validate().is_err(), "array {number}, {i}: {value}");
                        noticed += 1;
                    }
                }
            }
        }
        assert!(noticed > 1000);
        let mut damaged = sound.clone();
        damaged.positions[1].y = f64::NAN;
        assert_eq!(
            damaged.validate().unwrap_err().to_string(),
            "positions are finite: not so at 1"
        );
    }
}
