//! Plans of edits: where vertices go, and whether the new triangles are near the surface.

use super::state::{Edit, Improver, Off, Plan, sine};
use crate::certify::{EASY, Vertex, project, sag};
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, VertexId};

/// Sine of the smallest angle that collapses must leave, unless it was smaller.
const FAIR: f64 = 0.42;
/// Most edges at a vertex after a collapse.
const MOST_EDGES: usize = 9;
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

    /// A collapse after which more triangles are near the surface.
    pub fn plan_merge(&self, h: HalfEdgeId) -> Option<Plan> {
        let mesh = &self.mesh;
        let ends = [mesh.origin(h), mesh.target(h)];
        let beside = [mesh.face(h)?, mesh.face(mesh.twin(h))?];
        if !self.can_collapse(h) {
            return None;
        }
        let around = |v: VertexId| mesh.vertex_faces(v).filter(move |f| !beside.contains(f));
        let before = self.off_among(around(ends[0]).chain(around(ends[1])).chain(beside));
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
            if !self.holds(faces.iter().copied().chain(beside), &corners) {
                return None;
            }
            let faces = self.judge_better(&faces, &corners, before)?;
            (!self.looks_in(&faces, &corners)).then_some(Plan {
                vertex: Some(vertex),
                faces,
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
        // A vertex between them is found by evaluations, and moves all triangles around both.
        let easily = || self.try_collapse(h, at_v, false);
        if sag(&at_u, &at_v) <= EASY * self.tolerance
            && let Some(plan) = easily()
        {
            return Some(plan);
        }
        let length = at_u.position.distance(at_v.position);
        let middle = 0.5 * (at_u.position + at_v.position);
        let between = project(self.space, middle, length, self.tolerance);
        between
            .and_then(|vertex| self.try_collapse(h, vertex, true))
            .or_else(|| self.try_collapse(h, at_v, false))
            .or_else(|| self.try_collapse(h, at_u, true))
    }

    /// The collapse of an edge to a vertex; `moves` if the target of the half-edge gets another
    /// position.
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
        let is_likely = |corners| self.is_likely(corners, before, self.tolerance);
        let gone = faces.iter().copied().chain(beside.into_iter().flatten());
        if !(corners.iter().all(is_likely) && self.holds(gone, &corners)) {
            return None;
        }
        let plan = self.judge(&faces, &corners, before, self.tolerance)?;
        Some(Plan {
            vertex: Some(vertex),
            faces: plan,
        })
    }

    /// Distances of triangles from the surface; `None` if one is not good.
    pub fn judge(
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
        let mut judged = vec![(FaceId(0), 0.0); faces.len()];
        for (_, i) in order {
            let distance = self.distance(&corners[i], tolerance)?;
            judged[i] = (faces[i], distance as f32);
        }
        Some(judged)
    }

    /// Distances of triangles from the surface, infinite where none is found; `None` if they are no
    /// better than before: fewer are to have none, or as few and fewer are to be beyond the
    /// tolerance.
    pub fn judge_better(
        &self,
        faces: &[FaceId],
        corners: &[[Vertex; 3]],
        before: Off,
    ) -> Option<Vec<(FaceId, f32)>> {
        let mut now = Off::default();
        let mut judged = Vec::with_capacity(faces.len());
        for (f, corners) in faces.iter().zip(corners) {
            let distance = self.distance(corners, self.coarse);
            let distance = distance.map_or(f32::INFINITY, |d| d as f32);
            now.add(distance, self.tolerance);
            if now >= before {
                return None;
            }
            judged.push((*f, distance));
        }
        Some(judged)
    }

    /// Whether triangles in the place of some faces are near all places of the surface that are
    /// kept there.
    pub fn holds(&self, faces: impl Iterator<Item = FaceId>, corners: &[[Vertex; 3]]) -> bool {
        let most = self.tolerance * self.tolerance;
        let triangles: Vec<[DVec3; 3]> = corners.iter().map(|c| c.map(|v| v.position)).collect();
        let is_near = |i: &u32| {
            let place = self.places[*i as usize];
            let square = |t: &[DVec3; 3]| mesh::closest_point(t, place).distance_squared(place);
            triangles.iter().any(|t| square(t) <= most)
        };
        faces
            .into_iter()
            .all(|f| self.kept[f.index()].iter().all(is_near))
    }

    /// Whether one of some triangles looks inwards, where not all are near the surface.
    fn looks_in(&self, faces: &[(FaceId, f32)], corners: &[[Vertex; 3]]) -> bool {
        let is_in = |corners: &[Vertex; 3]| {
            let [a, b, c] = corners.map(|vertex| vertex.position);
            let out: DVec3 = corners.iter().map(Vertex::normal).sum();
            (b - a).cross(c - a).dot(out) <= 0.0
        };
        let is_far = |(_, distance): &(FaceId, f32)| *distance > self.tolerance as f32;
        faces.iter().any(is_far) && corners.iter().any(is_in)
    }

    /// Whether a triangle may be near the surface as its corners tell, and no angle is below the
    /// least one.
    pub fn is_likely(&self, corners: &[Vertex; 3], least_angle: f64, tolerance: f64) -> bool {
        let [a, b, c] = corners.map(|v| v.position);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            return false;
        };
        let looks_out = |v: &Vertex| -v.gradient.dot(normal) > 0.3 * v.gradient.length();
        sine([a, b, c]) >= least_angle
            && corners.iter().all(looks_out)
            && [(0, 1), (1, 2), (2, 0)]
                .iter()
                .all(|(i, j)| sag(&corners[*i], &corners[*j]) <= 1.2 * tolerance)
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
        if !self.holds(faces.into_iter(), &corners) {
            return None;
        }
        let before = self.off_among(faces.into_iter());
        let mut judged = if before == Off::default() {
            self.judge(&faces, &corners, 0.0, self.tolerance)?
        } else {
            self.judge_better(&faces, &corners, before)?
        };
        // Either may get either number.
        let farthest = judged
            .iter()
            .map(|(_, distance)| *distance)
            .fold(0.0, f32::max);
        judged
            .iter_mut()
            .for_each(|(_, distance)| *distance = farthest);
        Some(Plan {
            vertex: None,
            faces: judged,
        })
    }

    /// A division of two triangles into four; `helps` if fewer have to be off the surface
    /// afterwards.
    pub fn plan_split(&self, h: HalfEdgeId, helps: bool) -> Option<Plan> {
        let mesh = &self.mesh;
        let [p, q, r, s] = self.diamond(h).map(|v| self.vertices[v.index()]);
        let middle = 0.5 * (p.position + q.position);
        let reach = 0.5 * p.position.distance(q.position);
        let m = project(self.space, middle, reach, self.tolerance)?;
        let (left, right) = (mesh.face(h)?, mesh.face(mesh.twin(h))?);
        let corners = [[p, m, r], [m, q, r], [q, m, s], [m, p, s]];
        let faces = [left, left, right, right];
        // All may be too far, as they can be divided again, but no more may be off the surface.
        let before = self.off_among([left, right].into_iter());
        let allowed = Off {
            all: before.all,
            far: 5,
        };
        let allowed = if helps { before } else { allowed };
        let judged = self.judge_better(&faces, &corners, allowed)?;
        Some(Plan {
            vertex: Some(m),
            faces: judged,
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
        let off = self.off_among(mesh.vertex_faces(v));
        let is_near = off == Off::default();
        let reach = along.length() + if is_near { self.tolerance } else { self.coarse };
        [1.0, 0.5, 0.0].into_iter().find_map(|share| {
            let start = own.position + along * share;
            let vertex = project(self.space, start, reach, self.tolerance)?;
            let faces: Vec<FaceId> = mesh.vertex_faces(v).collect();
            let corners: Vec<[Vertex; 3]> = faces
                .iter()
                .map(|f| self.corners_with(*f, &[v], vertex))
                .collect();
            if !self.holds(faces.iter().copied(), &corners) {
                return None;
            }
            if !is_near {
                let judged = self.judge_better(&faces, &corners, off)?;
                return (!self.looks_in(&judged, &corners)).then_some(Plan {
                    vertex: Some(vertex),
                    faces: judged,
                });
            }
            // Better by a little, or as fair where the vertex has to come to the surface.
            let least = if is_off {
                before.min(FAIR)
            } else {
                before + 0.01
            };
            let judged = self.judge(&faces, &corners, least, self.tolerance)?;
            Some(Plan {
                vertex: Some(vertex),
                faces: judged,
            })
        })
    }
}
