//! An exact test for self-intersections.
//!
//! Every decision is the sign of a determinant that is computed exactly (Shewchuk's adaptive
//! predicates), so that the answer is a proof for the given coordinates, not a matter of tolerance.

use crate::bvh::Bvh;
use crate::error::{Error, fail};
use crate::triangle_mesh::TriangleMesh;
use core::ops::ControlFlow;
use glam::DVec3;
use robust::{Coord, Coord3D};

/// Pairs of triangles with overlapping boxes that are looked at before the test gives up.
const MAX_CANDIDATES: u64 = 400_000_000;
/// Coordinates other than 0 must be within these, so that no product of three under- or overflows:
/// 2⁻²⁵⁰ and 2²⁵⁰.
const RANGE: [f64; 2] = [5.5e-76, 1.8e75];

/// Result of [`self_intersections`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Intersections {
    /// Pairs of triangles with a common point that is no common vertex or edge; the lower number
    /// first, in ascending order.
    pub pairs: Vec<[u32; 2]>,
    /// Triangles whose corners are on one line; they are in no pair.
    pub flat: Vec<u32>,
    /// `true` if all pairs were looked at: then a mesh without pairs and flat triangles is free of
    /// self-intersections.
    pub is_complete: bool,
}

impl Intersections {
    /// `true` if it is proved that the mesh does not touch or cut itself anywhere.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.is_complete && self.pairs.is_empty() && self.flat.is_empty()
    }
}

/// Finds triangles that cut, touch or overlap each other. Triangles that share vertices by index
/// may meet in those and in the edge between them, nowhere else. Stops when `most` pairs are found,
/// or 400 million pairs have overlapping boxes.
///
/// ```
/// use glam::DVec3;
/// use mesh::{TriangleMesh, self_intersections};
///
/// let mut mesh = TriangleMesh::new(
///     vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
///     vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
/// );
/// assert!(self_intersections(&mesh, 100)?.is_free());
///
/// // The top pushed through the bottom of another tetrahedron.
/// let shifted: Vec<DVec3> = mesh.positions.iter().map(|p| *p + 0.25).collect();
/// mesh.positions.extend(shifted);
/// let copy: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|i| i + 4)).collect();
/// mesh.triangles.extend(copy);
/// assert!(!self_intersections(&mesh, 100)?.pairs.is_empty());
/// # Ok::<(), mesh::Error>(())
/// ```
///
/// # Errors
/// If a triangle has a vertex that does not exist, or a coordinate is not finite, or neither 0 nor
/// within 5.5e-76 … 1.8e75 in size.
pub fn self_intersections(mesh: &TriangleMesh, most: usize) -> Result<Intersections, Error> {
    search(mesh, most, MAX_CANDIDATES)
}

fn search(mesh: &TriangleMesh, most: usize, candidates: u64) -> Result<Intersections, Error> {
    if let Some(i) = mesh.positions.iter().position(|p| {
        !p.to_array()
            .iter()
            .all(|x| *x == 0.0 || (RANGE[0]..=RANGE[1]).contains(&x.abs()))
    }) {
        return fail(format!(
            "vertex {i} (from 0) is at {}, where exact arithmetic has no room",
            mesh.positions[i]
        ));
    }
    let count = mesh.positions.len();
    if let Some(v) = mesh
        .triangles
        .iter()
        .flatten()
        .find(|v| **v as usize >= count)
    {
        return fail(format!("a triangle has vertex {v} (from 0) of {count}"));
    }
    let planes: Vec<Option<Plane>> = (0..mesh.triangles.len())
        .map(|i| Plane::of(&mesh.corners(i)))
        .collect();
    let flat = (0..).zip(&planes).filter(|(_, plane)| plane.is_none());
    let mut found = Intersections {
        flat: flat.map(|(i, _)| i).collect(),
        is_complete: true,
        ..Intersections::default()
    };
    let mut looked = 0;
    Bvh::new(&mesh.triangle_boxes()).pairs(|i, j| {
        looked += 1;
        if looked > candidates || found.pairs.len() == most {
            found.is_complete = false;
            return ControlFlow::Break(());
        }
        let one = Facet::of(mesh, &planes, i);
        let other = Facet::of(mesh, &planes, j);
        if let (Some(one), Some(other)) = (one, other)
            && one.meets(&other)
        {
            found.pairs.push([i, j]);
        }
        ControlFlow::Continue(())
    });
    found.pairs.sort_unstable();
    Ok(found)
}

/// Plane of coordinates onto which a triangle has an image with an area: the axis left out.
#[derive(Clone, Copy)]
struct Plane(usize);

impl Plane {
    /// `None` if the corners are on one line.
    fn of([a, b, c]: &[DVec3; 3]) -> Option<Self> {
        // The largest image first, which is quickest to tell.
        let normal = (*b - *a).cross(*c - *a).abs();
        let first = normal.max_position();
        [first, (first + 1) % 3, (first + 2) % 3]
            .map(Self)
            .into_iter()
            .find(|plane| plane.turn(*a, *b, *c) != 0)
    }

    /// The sign of the area of the image of a triangle.
    fn turn(self, a: DVec3, b: DVec3, c: DVec3) -> i8 {
        let [a, b, c] = [a, b, c].map(|p| Coord {
            x: p[(self.0 + 1) % 3],
            y: p[(self.0 + 2) % 3],
        });
        sign(robust::orient2d(a, b, c))
    }

    /// `true` if the image of a point is in the image of a triangle, sides included.
    fn contains(self, [a, b, c]: &[DVec3; 3], p: DVec3) -> bool {
        let turns = [
            self.turn(*a, *b, p),
            self.turn(*b, *c, p),
            self.turn(*c, *a, p),
        ];
        turns.iter().all(|t| *t >= 0) || turns.iter().all(|t| *t <= 0)
    }

    /// `true` if the images of two closed segments have a common point.
    fn segments_meet(self, [p, q]: [DVec3; 2], [a, b]: [DVec3; 2]) -> bool {
        let [pa, pb] = [self.turn(p, q, a), self.turn(p, q, b)];
        let [ap, aq] = [self.turn(a, b, p), self.turn(a, b, q)];
        if pa != 0 || pb != 0 || ap != 0 || aq != 0 {
            return pa * pb <= 0 && ap * aq <= 0;
        }
        // All on one line: their ranges overlap.
        [(self.0 + 1) % 3, (self.0 + 2) % 3].iter().all(|axis| {
            p[*axis].min(q[*axis]) <= a[*axis].max(b[*axis])
                && a[*axis].min(b[*axis]) <= p[*axis].max(q[*axis])
        })
    }
}

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

/// The side of the plane through three points that a fourth is on; 0 on the plane.
fn side([a, b, c]: [DVec3; 3], p: DVec3) -> i8 {
    let [a, b, c, p] = [a, b, c, p].map(|p| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    });
    sign(robust::orient3d(a, b, c, p))
}

/// Triangle with an area.
struct Facet {
    vertices: [u32; 3],
    corners: [DVec3; 3],
    plane: Plane,
}

impl Facet {
    fn of(mesh: &TriangleMesh, planes: &[Option<Plane>], i: u32) -> Option<Self> {
        planes[i as usize].map(|plane| Self {
            vertices: mesh.triangles[i as usize],
            corners: mesh.corners(i as usize),
            plane,
        })
    }

    /// `true` if the triangles have a common point beside the vertices and the edge that they
    /// share.
    fn meets(&self, other: &Self) -> bool {
        let shared: Vec<usize> = (0..3)
            .filter(|i| other.vertices.contains(&self.vertices[*i]))
            .collect();
        match shared[..] {
            [] => (0..3).any(|i| {
                let [own, others] = [self, other].map(|t| [t.corners[i], t.corners[(i + 1) % 3]]);
                self.meets_segment(others) || other.meets_segment(own)
            }),
            // From the shared vertex the way to any other common point goes on to one of the
            // opposite sides, within the other triangle.
            [i] => {
                let vertex = self.vertices[i];
                let [own, others] = [self, other].map(|t| {
                    let at = t.vertices.iter().position(|v| *v == vertex).unwrap_or(0);
                    [t.corners[(at + 1) % 3], t.corners[(at + 2) % 3]]
                });
                self.meets_segment(others) || other.meets_segment(own)
            }
            // Two triangles at an edge overlap only if they lie in one plane, on one side of it.
            [i, j] => {
                let own = self.corners[3 - i - j];
                let far = (0..3).find(|k| !self.vertices.contains(&other.vertices[*k]));
                let Some(far) = far.map(|k| other.corners[k]) else {
                    return true;
                };
                let [a, b] = [self.corners[i], self.corners[j]];
                side(self.corners, far) == 0
                    && self.plane.turn(a, b, own) == self.plane.turn(a, b, far)
            }
            _ => true,
        }
    }

    /// `true` if a closed segment and the closed triangle have a common point.
    fn meets_segment(&self, [p, q]: [DVec3; 2]) -> bool {
        let [at_p, at_q] = [p, q].map(|x| side(self.corners, x));
        let [a, b, c] = self.corners;
        if at_p == 0 && at_q == 0 {
            let sides = [[a, b], [b, c], [c, a]];
            return self.plane.contains(&self.corners, p)
                || self.plane.contains(&self.corners, q)
                || sides
                    .iter()
                    .any(|side| self.plane.segments_meet([p, q], *side));
        }
        if at_p * at_q > 0 {
            return false;
        }
        // The line meets the plane in one point of the segment; is it within the triangle?
        let turns = [side([p, q, a], b), side([p, q, b], c), side([p, q, c], a)];
        turns.iter().all(|t| *t >= 0) || turns.iter().all(|t| *t <= 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_search_says_when_it_gives_up() {
        // Triangles that all cut each other.
        let positions: Vec<DVec3> = (0..30)
            .flat_map(|i| {
                let angle = f64::from(i);
                let across = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
                [across - DVec3::Z, across * -1.0 - DVec3::Z, DVec3::Z * 2.0]
            })
            .collect();
        let triangles = (0..30).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = TriangleMesh::new(positions, triangles);
        let all = search(&mesh, 1000, u64::MAX).unwrap();
        assert_eq!((all.pairs.len(), all.is_complete), (435, true));
        let some = search(&mesh, 10, u64::MAX).unwrap();
        assert_eq!((some.pairs.len(), some.is_complete), (10, false));
        let few = search(&mesh, 1000, 50).unwrap();
        assert!(!few.is_complete && !few.is_free() && few.pairs.len() <= 50);
    }
}
