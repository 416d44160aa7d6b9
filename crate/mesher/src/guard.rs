//! Keeps edits from making a mesh cut itself, where proofs of triangles may fail.
//!
//! The mesh of marching tetrahedra does not cut itself. If no edit makes a triangle that meets
//! another one, as an exact test says, no later mesh does. The test is only made near guarded
//! vertices: elsewhere [proofs](crate::certify) do the same for less.

use crate::boxes::Boxes;
use glam::DVec3;
use mesh::{Aabb, FaceId, HalfEdgeMesh, TriangleMesh, VertexId, self_intersections};

/// Rings of neighbours around vertices where proofs may fail that are guarded, too.
const RINGS: usize = 2;

/// The triangles whose edits are kept from making a mesh cut itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guarded {
    /// None: for tests.
    #[cfg(test)]
    Nowhere,
    /// Those whose proofs may fail.
    Unproved,
    /// All.
    Everywhere,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Number of the vertex: triangles may meet in common ones.
    pub number: u32,
    /// Position.
    pub position: DVec3,
}

/// The guarded vertices of a mesh, and the faces at them by place.
#[derive(Debug)]
pub struct Guard {
    is_guarded: Vec<bool>,
    boxes: Boxes,
}

impl Guard {
    /// Guards the chosen vertices, and those near them.
    pub fn new(mesh: &HalfEdgeMesh, is_chosen: impl Fn(VertexId) -> bool) -> Self {
        let mut is_guarded = vec![false; mesh.vertex_slots()];
        let mut ring: Vec<VertexId> = mesh.vertices().filter(|v| is_chosen(*v)).collect();
        for v in &ring {
            is_guarded[v.index()] = true;
        }
        for _ in 0..RINGS {
            let mut next = Vec::new();
            for n in ring.iter().flat_map(|v| mesh.neighbors(*v)) {
                if !is_guarded[n.index()] {
                    is_guarded[n.index()] = true;
                    next.push(n);
                }
            }
            ring = next;
        }
        let mut guard = Self {
            is_guarded,
            boxes: Boxes::default(),
        };
        let faces = mesh.faces().filter(|f| guard.has(mesh, *f));
        let faces = faces.map(|f| (f.index() as u32, bounds(mesh, f)));
        guard.boxes = Boxes::new(faces.collect());
        guard
    }

    /// Whether edits near a vertex are tested.
    pub fn is_guarded(&self, v: VertexId) -> bool {
        self.is_guarded[v.index()]
    }

    /// Guards a vertex, or ends that.
    pub fn set_guarded(&mut self, v: VertexId, is_guarded: bool) {
        if self.is_guarded.len() <= v.index() {
            self.is_guarded.resize(v.index() + 1, false);
        }
        self.is_guarded[v.index()] = is_guarded;
    }

    fn has(&self, mesh: &HalfEdgeMesh, f: FaceId) -> bool {
        mesh.face_vertices(f).any(|v| self.is_guarded[v.index()])
    }

    /// Forgets a face.
    pub fn remove(&mut self, f: FaceId) {
        self.boxes.remove(f.index() as u32);
    }

    /// Takes note of a face that has changed.
    pub fn set(&mut self, mesh: &HalfEdgeMesh, f: FaceId) {
        if self.has(mesh, f) {
            self.boxes.set(f.index() as u32, bounds(mesh, f));
        } else {
            self.remove(f);
        }
    }

    /// Whether none of some triangles is flat, or meets another one or a face that stays, but in
    /// common vertices and edges.
    pub fn is_free(&self, mesh: &HalfEdgeMesh, triangles: &[[Corner; 3]], gone: &[FaceId]) -> bool {
        let mut near = Vec::new();
        for (i, triangle) in triangles.iter().enumerate() {
            let others = triangles[..i].iter();
            if is_flat(triangle) || others.into_iter().any(|other| meet(triangle, other)) {
                return false;
            }
            near.clear();
            self.boxes.touching(&box_of(triangle), &mut near);
            near.retain(|i| !gone.contains(&FaceId(*i)));
            let meets = |i: &u32| {
                let mut corners = mesh.face_vertices(FaceId(*i)).map(|v| Corner {
                    number: v.index() as u32,
                    position: mesh.position(v),
                });
                let [a, b, c] = [(); 3].map(|()| corners.next());
                match (a, b, c) {
                    (Some(a), Some(b), Some(c)) => meet(triangle, &[a, b, c]),
                    _ => false,
                }
            };
            if near.iter().any(meets) {
                return false;
            }
        }
        true
    }
}

fn box_of(triangle: &[Corner; 3]) -> Aabb {
    Aabb::of_points(triangle.map(|corner| corner.position))
}

/// Whether two triangles have a common point beside the vertices and the edge that they share.
fn meet(one: &[Corner; 3], other: &[Corner; 3]) -> bool {
    if !box_of(one).overlaps(&box_of(other)) || is_beside(one, other) || is_beside(other, one) {
        return false;
    }
    self_intersections(&meshed(&[*one, *other]), 1).map_or(true, |found| !found.pairs.is_empty())
}

fn is_flat(triangle: &[Corner; 3]) -> bool {
    self_intersections(&meshed(&[*triangle]), 1).map_or(true, |found| !found.flat.is_empty())
}

/// A mesh of some triangles.
fn meshed(triangles: &[[Corner; 3]]) -> TriangleMesh {
    let all = triangles.as_flattened();
    let place = |corner: &Corner| all.iter().position(|other| other.number == corner.number);
    let place = |corner: Corner| place(&corner).unwrap_or(0) as u32;
    TriangleMesh::new(
        all.iter().map(|corner| corner.position).collect(),
        triangles.iter().map(|t| t.map(place)).collect(),
    )
}

/// Whether the corners of one triangle that are not those of another are on one side of its plane,
/// with no doubt left by rounding: then they meet in common vertices and edges only.
fn is_beside(one: &[Corner; 3], plane: &[Corner; 3]) -> bool {
    let [a, b, c] = plane.map(|corner| corner.position);
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let rounding = ROUNDING * u.length() * v.length();
    let is_shared = |corner: &Corner| plane.iter().any(|other| other.number == corner.number);
    // Two triangles with the same corners are one.
    let [mut above, mut below] = [!one.iter().all(is_shared); 2];
    for corner in one.iter().filter(|corner| !is_shared(corner)) {
        let w = corner.position - a;
        let (height, doubt) = (normal.dot(w), rounding * w.length());
        // Not so for NaN.
        above &= height > doubt;
        below &= height < -doubt;
    }
    above || below
}

/// Bound on the relative error of a volume that is computed of three differences: more than the 20
/// roundings of the computation.
const ROUNDING: f64 = 1e-14;

fn bounds(mesh: &HalfEdgeMesh, f: FaceId) -> Aabb {
    Aabb::of_points(mesh.face_vertices(f).map(|v| mesh.position(v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_meet_others_are_refused() {
        // Two tetrahedra, the top of the lower one below the bottom of the upper one.
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let positions = corners
            .into_iter()
            .chain(corners.map(|p| p + DVec3::Z * 1.1));
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let above = triangles.map(|t| t.map(|i| i + 4));
        let mesh = TriangleMesh::new(positions.collect(), [triangles, above].concat());
        let mesh = HalfEdgeMesh::from_triangles(&mesh).unwrap();
        let guard = Guard::new(&mesh, |_| true);
        let top = VertexId(3);
        let gone: Vec<FaceId> = mesh.vertex_faces(top).collect();
        let moved = |height: f64| -> Vec<[Corner; 3]> {
            let corner = |v: VertexId| Corner {
                number: v.index() as u32,
                position: if v == top {
                    DVec3::new(0.2, 0.2, height)
                } else {
                    mesh.position(v)
                },
            };
            let faces = gone.iter().map(|f| {
                let corners: Vec<Corner> = mesh.face_vertices(*f).map(corner).collect();
                [corners[0], corners[1], corners[2]]
            });
            faces.collect()
        };
        assert!(guard.is_free(&mesh, &moved(1.0), &gone));
        assert!(!guard.is_free(&mesh, &moved(1.1), &gone), "it touches");
        assert!(!guard.is_free(&mesh, &moved(1.2), &gone), "it cuts");
        assert!(
            guard.is_free(&mesh, &moved(-1.0), &gone),
            "turned inside out"
        );
        assert!(!guard.is_free(&mesh, &moved(0.0), &gone), "flat");
        // Unguarded faces are not looked at.
        let none = Guard::new(&mesh, |_| false);
        assert!(none.is_free(&mesh, &moved(1.2), &gone));
    }
}
