//! Plans of edits: where vertices go, and whether the new triangles are proved to be near the surface.

use super::state::{Edit, Improver, Plan, Unproved, sine};
use crate::certify::{Vertex, distance, project};
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, VertexId};

/// Sine of the smallest angle that collapses must leave, unless it was smaller.
const FAIR: f64 = 0.42;
/// Most edges at a vertex after a collapse.
const MOST_EDGES: usize = 9;
/// The largest distance from the mesh before them that edits which leave triangles unproved may go, in tolerances: cells hide no part of the surface that
/// is farther from that mesh than the rest.
const LOST: f64 = 0.5;

/// Square of the longest side of a triangle.
fn size([a, b, c]: &[Vertex; 3]) -> f64 {
    let side = |p: &Vertex, q: &Vertex| p.position.distance_squared(q.position);
    side(a, b).max(side(b, c)).max(side(c, a))
}

impl Improver<'_> {
    pub fn plan(&self, edit: Edit) -> Option<Plan> {
        match edit {
            Edit::Collapse(h) => self.plan_collapse(h),
            Edit::Merge(h) => self.plan_merge(h),
            Edit::Flip(h) => self.plan_flip(h),
            Edit::Split(h) => self.plan_split(h, false),
            Edit::Move(v) => self.plan_move(v),
        }
    }

    /// Whether the mesh stays a manifold without an edge.
    pub fn can_collapse(&self, h: HalfEdgeId) -> bool {
        let mesh = &self.mesh;
        let (u, v) = (mesh.origin(h), mesh.target(h));
        let common = mesh
            .neighbors(u)
            .filter(|n| mesh.find_half_edge(v, *n).is_some());
        common.count() == 2 && mesh.degree(u) + mesh.degree(v) <= MOST_EDGES + 4
    }

    /// A collapse after which more triangles are proved to be near the surface.
    pub fn plan_merge(&self, h: HalfEdgeId) -> Option<Plan> {
        let mesh = &self.mesh;
        let ends = [mesh.origin(h), mesh.target(h)];
        let beside = [mesh.face(h)?, mesh.face(mesh.twin(h))?];
        if !self.can_collapse(h) {
            return None;
        }
        let around = |v: VertexId| mesh.vertex_faces(v).filter(move |f| !beside.contains(f));
        let before = self.unproved_among(around(ends[0]).chain(around(ends[1])).chain(beside));
        let faces: Vec<FaceId> = around(ends[0]).chain(around(ends[1])).collect();
        // No flatter than they are: flat ones beside each other go one after the other.
        let least_angle = self.star_angle(ends[0]).min(self.star_angle(ends[1]));
        let least_angle = least_angle.min(1e-3);
        let target = |vertex: Vertex| {
            let corners = faces.iter().map(|f| self.corners_with(*f, &ends, vertex));
            let corners: Vec<[Vertex; 3]> = corners.collect();
            let angle = |c: &[Vertex; 3]| sine(c.map(|v| v.position));
            if corners.iter().map(angle).fold(1.0, f64::min) < least_angle {
                return None;
            }
            let faces = self.prove_more(&faces, &corners, before)?;
            let loss = self.loss(&ends, &faces, &corners)?;
            Some(Plan {
                vertex: Some(vertex),
                faces,
                loss,
            })
        };
        let [at_u, at_v] = ends.map(|v| self.vertices[v.index()]);
        if self.is_fixed[ends[1].index()] {
            return target(at_v);
        }
        let length = at_u.position.distance(at_v.position);
        let middle = 0.5 * (at_u.position + at_v.position);
        let between = project(self.space, middle, length, self.tolerance);
        let choices = [Some(at_v), Some(at_u), between];
        choices.into_iter().flatten().find_map(target)
    }

    pub fn plan_collapse(&self, h: HalfEdgeId) -> Option<Plan> {
        let mesh = &self.mesh;
        let (u, v) = (mesh.origin(h), mesh.target(h));
        if !self.can_collapse(h) {
            return None;
        }
        let [at_u, at_v] = [u, v].map(|v| self.vertices[v.index()]);
        if self.is_fixed[v.index()] {
            return self.try_collapse(h, at_v, false);
        }
        let length = at_u.position.distance(at_v.position);
        let middle = 0.5 * (at_u.position + at_v.position);
        let between = project(self.space, middle, length, self.tolerance);
        between
            .and_then(|vertex| self.try_collapse(h, vertex, true))
            .or_else(|| self.try_collapse(h, at_v, false))
            .or_else(|| self.try_collapse(h, at_u, true))
    }

    /// The collapse of an edge to a vertex; `moves` if the target of the half-edge gets another position.
    pub fn try_collapse(&self, h: HalfEdgeId, vertex: Vertex, moves: bool) -> Option<Plan> {
        let mesh = &self.mesh;
        let ends = [mesh.origin(h), mesh.target(h)];
        let beside = [mesh.face(h), mesh.face(mesh.twin(h))];
        let around = |v: VertexId| {
            mesh.vertex_faces(v)
                .filter(move |f| !beside.contains(&Some(*f)))
        };
        let mut faces: Vec<FaceId> = around(ends[0]).collect();
        let before = mesh.vertex_faces(ends[0]).chain(mesh.vertex_faces(ends[1]));
        let before = before.map(|f| self.angle(f)).fold(FAIR, f64::min);
        if moves {
            faces.extend(around(ends[1]));
        }
        let corners: Vec<[Vertex; 3]> = faces
            .iter()
            .map(|f| self.corners_with(*f, &ends, vertex))
            .collect();
        let plan = self.prove(&faces, &corners, before, self.tolerance)?;
        Some(Plan {
            vertex: Some(vertex),
            faces: plan,
            loss: 0.0,
        })
    }

    /// Distances of triangles from the surface; `None` if one is not good.
    pub fn prove(
        &self,
        faces: &[FaceId],
        corners: &[[Vertex; 3]],
        least_angle: f64,
        tolerance: f64,
    ) -> Option<Vec<(FaceId, f32)>> {
        let is_likely = |corners| self.is_likely(corners, least_angle, tolerance);
        if !corners.iter().all(is_likely) {
            return None;
        }
        // Large ones fail first, and one is enough.
        let mut order: Vec<(f64, usize)> = (0..).zip(corners).map(|(i, c)| (-size(c), i)).collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut proved = vec![(FaceId(0), 0.0); faces.len()];
        for (_, i) in order {
            let distance = distance(self.space, corners[i].each_ref(), tolerance)?;
            proved[i] = (faces[i], distance as f32);
        }
        Some(proved)
    }

    /// Distances of triangles from the surface, infinite where none is proved; `None` if they are no better than before: fewer
    /// may not be proved at all, or as few and fewer not to be within the tolerance.
    pub fn prove_more(
        &self,
        faces: &[FaceId],
        corners: &[[Vertex; 3]],
        before: Unproved,
    ) -> Option<Vec<(FaceId, f32)>> {
        let mut now = Unproved::default();
        let mut proved = Vec::with_capacity(faces.len());
        for (f, corners) in faces.iter().zip(corners) {
            let distance = distance(self.space, corners.each_ref(), self.coarse);
            let distance = distance.map_or(f32::INFINITY, |d| d as f32);
            now.add(distance, self.tolerance);
            if now >= before {
                return None;
            }
            proved.push((*f, distance));
        }
        Some(proved)
    }

    /// The loss of a vertex in the place of others, with its new faces: none if all are proved, `None` if it is too large, or if one of them
    /// looks inwards. Without it many
    /// small edits where nothing is proved could remove whole parts of the surface.
    pub fn loss(
        &self,
        replaced: &[VertexId],
        faces: &[(FaceId, f32)],
        corners: &[[Vertex; 3]],
    ) -> Option<f64> {
        let is_far = |(_, distance): &(FaceId, f32)| *distance > self.tolerance as f32;
        if !faces.iter().any(is_far) {
            return Some(0.0);
        }
        let looks_in = |corners: &[Vertex; 3]| {
            let [a, b, c] = corners.map(|vertex| vertex.position);
            let out: DVec3 = corners.iter().map(Vertex::normal).sum();
            (b - a).cross(c - a).dot(out) <= 0.0
        };
        if corners.iter().any(looks_in) {
            return None;
        }
        let lost = |v: &VertexId| {
            let position = self.mesh.position(*v);
            let distances = corners.iter().map(|corners| {
                let corners = corners.map(|vertex| vertex.position);
                mesh::closest_point(&corners, position).distance(position)
            });
            self.losses[v.index()] + distances.fold(f64::INFINITY, f64::min)
        };
        let loss = replaced.iter().map(lost).fold(0.0, f64::max);
        (loss <= LOST * self.tolerance).then_some(loss)
    }

    /// Whether a triangle has a chance to be proved, and no angle is below the least one.
    pub fn is_likely(&self, corners: &[Vertex; 3], least_angle: f64, tolerance: f64) -> bool {
        let [a, b, c] = corners.map(|v| v.position);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            return false;
        };
        let looks_out = |v: &Vertex| -v.gradient.dot(normal) > 0.3 * v.gradient.length();
        let sag = |i: usize, j: usize| {
            let (one, other) = (&corners[i], &corners[j]);
            let turn = (one.normal() - other.normal()).dot(one.position - other.position);
            turn.abs() / 8.0
        };
        sine([a, b, c]) >= least_angle
            && corners.iter().all(looks_out)
            && [(0, 1), (1, 2), (2, 0)]
                .iter()
                .all(|(i, j)| sag(*i, *j) <= 1.2 * tolerance)
    }

    pub fn flip_gain(&self, h: HalfEdgeId) -> Option<f64> {
        let [a, b, c, d] = self.diamond(h);
        let is_fixed = |v: &VertexId| self.is_fixed[v.index()];
        if [a, b, c].iter().all(is_fixed) || [a, b, d].iter().all(is_fixed) {
            return None;
        }
        let [p, q, r, s] = [a, b, c, d].map(|v| self.mesh.position(v));
        let before = sine([p, q, r]).min(sine([q, p, s]));
        let after = sine([s, r, p]).min(sine([r, s, q]));
        (after > before + 0.02).then_some(after - before)
    }

    pub fn plan_flip(&self, h: HalfEdgeId) -> Option<Plan> {
        let mesh = &self.mesh;
        let diamond = self.diamond(h);
        let [p, q, r, s] = diamond.map(|v| self.vertices[v.index()]);
        if mesh.find_half_edge(diamond[2], diamond[3]).is_some() {
            return None;
        }
        let faces = [mesh.face(h)?, mesh.face(mesh.twin(h))?];
        let corners = [[s, r, p], [r, s, q]];
        let before = self.unproved_among(faces.into_iter());
        let mut proved = if before == Unproved::default() {
            self.prove(&faces, &corners, 0.0, self.tolerance)?
        } else {
            self.prove_more(&faces, &corners, before)?
        };
        // Either may get either number.
        let farthest = proved
            .iter()
            .map(|(_, distance)| *distance)
            .fold(0.0, f32::max);
        proved
            .iter_mut()
            .for_each(|(_, distance)| *distance = farthest);
        Some(Plan {
            vertex: None,
            faces: proved,
            loss: 0.0,
        })
    }

    /// A division of two triangles into four; `helps` if fewer have to be unproved afterwards.
    pub fn plan_split(&self, h: HalfEdgeId, helps: bool) -> Option<Plan> {
        let mesh = &self.mesh;
        let [p, q, r, s] = self.diamond(h).map(|v| self.vertices[v.index()]);
        let middle = 0.5 * (p.position + q.position);
        let reach = 0.5 * p.position.distance(q.position);
        let m = project(self.space, middle, reach, self.tolerance)?;
        let (left, right) = (mesh.face(h)?, mesh.face(mesh.twin(h))?);
        let corners = [[p, m, r], [m, q, r], [q, m, s], [m, p, s]];
        let faces = [left, left, right, right];
        // All may be too far, as they can be divided again, but no more may be unproved.
        let before = self.unproved_among([left, right].into_iter());
        let allowed = Unproved {
            all: before.all,
            far: 5,
        };
        let allowed = if helps { before } else { allowed };
        let proved = self.prove_more(&faces, &corners, allowed)?;
        let ends = [mesh.origin(h), mesh.target(h)];
        Some(Plan {
            vertex: Some(m),
            faces: proved,
            loss: ends
                .map(|v| self.losses[v.index()])
                .into_iter()
                .fold(0.0, f64::max),
        })
    }

    pub fn plan_move(&self, v: VertexId) -> Option<Plan> {
        let mesh = &self.mesh;
        let own = self.vertices[v.index()];
        let count = mesh.degree(v) as f64;
        let mean = mesh.neighbors(v).map(|n| mesh.position(n)).sum::<DVec3>() / count;
        let normal = own.normal();
        let along = mean - own.position;
        let along = along - normal * along.dot(normal);
        let before = self.star_angle(v);
        let is_off = own.value.abs() > 1e-2 * self.tolerance * own.gradient.length();
        let unproved = self.unproved_among(mesh.vertex_faces(v));
        let is_proved = unproved == Unproved::default();
        let reach = along.length()
            + if is_proved {
                self.tolerance
            } else {
                self.coarse
            };
        [1.0, 0.5, 0.0].into_iter().find_map(|share| {
            let start = own.position + along * share;
            let vertex = project(self.space, start, reach, self.tolerance)?;
            let faces: Vec<FaceId> = mesh.vertex_faces(v).collect();
            let corners: Vec<[Vertex; 3]> = faces
                .iter()
                .map(|f| self.corners_with(*f, &[v], vertex))
                .collect();
            if !is_proved {
                let proved = self.prove_more(&faces, &corners, unproved)?;
                let loss = self.loss(&[v], &proved, &corners)?;
                return Some(Plan {
                    vertex: Some(vertex),
                    faces: proved,
                    loss,
                });
            }
            // Better by a little, or as fair where the vertex has to come to the surface.
            let least = if is_off {
                before.min(FAIR)
            } else {
                before + 0.01
            };
            let proved = self.prove(&faces, &corners, least, self.tolerance)?;
            Some(Plan {
                vertex: Some(vertex),
                faces: proved,
                loss: 0.0,
            })
        })
    }
}
