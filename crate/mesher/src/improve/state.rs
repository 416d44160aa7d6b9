//! A mesh that is being improved: what is known of its vertices and faces, and how edits change it.

use crate::certify::{Vertex, estimate};
use crate::forest::Forest;
use crate::guard::{Corner, Guard, Guarded};
use crate::march::Raw;
use crate::options::MeshError;
use crate::space::Space;
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, HalfEdgeMesh, TriangleMesh, VertexId};

/// Samples may be so far from the surface, in tolerances: proofs need some room, and between
/// samples it may be a little more.
const SHARE: f64 = 0.8;
/// The largest distance from the surface of vertices whose places are kept, in tolerances.
const ON: f64 = 0.25;

/// A change of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Edit {
    /// Merges the origin of a half-edge into its target.
    Collapse(HalfEdgeId),
    /// The same, as long as the mesh stays near the surface at all.
    Merge(HalfEdgeId),
    /// Replaces an edge by the other diagonal.
    Flip(HalfEdgeId),
    /// Puts a vertex on an edge.
    Split(HalfEdgeId),
    /// Moves a vertex.
    Move(VertexId),
}

/// For each edit the last round in which it was refused.
#[derive(Debug, Default)]
pub struct Refused {
    /// For each kind, by the number of the half-edge or the vertex; 0 for none.
    rounds: [Vec<u32>; 5],
}

impl Refused {
    fn place(edit: Edit) -> (usize, usize) {
        match edit {
            Edit::Collapse(h) => (0, h.index()),
            Edit::Merge(h) => (1, h.index()),
            Edit::Flip(h) => (2, h.index()),
            Edit::Split(h) => (3, h.index()),
            Edit::Move(v) => (4, v.index()),
        }
    }

    /// The round in which an edit was refused, if it was.
    pub fn round(&self, edit: Edit) -> Option<u32> {
        let (kind, i) = Self::place(edit);
        let round = self.rounds[kind].get(i).copied();
        round.filter(|round| *round > 0)
    }

    /// Takes note that an edit was refused.
    pub fn insert(&mut self, edit: Edit, round: u32) {
        let (kind, i) = Self::place(edit);
        let rounds = &mut self.rounds[kind];
        if rounds.len() <= i {
            rounds.resize(i + 1, 0);
        }
        rounds[i] = round;
    }
}

/// A change that was found to be good.
pub struct Plan {
    /// The remaining or moved vertex.
    pub vertex: Option<Vertex>,
    /// The faces that change, with their new distances from the surface.
    pub faces: Vec<(FaceId, f32)>,
}

/// The numbers of faces that are not found to be near the surface at all, and of those found to be
/// farther than the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Off {
    pub all: usize,
    pub far: usize,
}

impl Off {
    /// Counts a face with such a distance from the surface.
    pub fn add(&mut self, distance: f32, tolerance: f64) {
        if distance.is_infinite() {
            self.all += 1;
        } else if distance > tolerance as f32 {
            self.far += 1;
        }
    }
}

/// A mesh that is being improved.
pub struct Improver<'a> {
    pub space: &'a Space<'a>,
    /// The tolerance of samples.
    pub tolerance: f64,
    /// That of proofs.
    pub limit: f64,
    /// The largest distance of the mesh from the surface at the start.
    pub coarse: f64,
    pub threads: usize,
    pub mesh: HalfEdgeMesh,
    pub vertices: Vec<Vertex>,
    pub is_fixed: Vec<bool>,
    pub errors: Vec<f32>,
    /// Places of the surface: where vertices were at the start.
    pub places: Vec<DVec3>,
    /// For each face, the places that it is nearest to, of those that were kept by faces in its
    /// place.
    pub kept: Vec<Vec<u32>>,
    /// The faces that were looked at since they changed, and are not within the tolerance.
    pub is_off: Vec<bool>,
    /// Whether each face was proved to be near the surface, if that was tried since it changed.
    pub proofs: Vec<Option<bool>>,
    pub guard: Guard,
    /// The round in which something around a vertex has changed.
    pub changed: Vec<u32>,
    /// The round in which an edit was refused: as long as nothing changes at its vertices it would
    /// be again.
    pub refused: Refused,
    pub round: u32,
}

impl<'a> Improver<'a> {
    /// Takes a mesh over, with the tolerance of the result and its own. Edits in the guarded places
    /// are kept from making the mesh cut itself.
    ///
    /// # Errors
    /// If it is no manifold.
    pub fn new(
        space: &'a Space<'a>,
        raw: Raw,
        [tolerance, coarse]: [f64; 2],
        threads: usize,
        guarded: Guarded,
    ) -> Result<Self, MeshError> {
        let Raw {
            vertices,
            triangles,
            is_lid,
            ..
        } = raw;
        let mut is_fixed = vec![false; vertices.len()];
        for (triangle, is_lid) in triangles.iter().zip(&is_lid) {
            for i in triangle.iter().filter(|_| *is_lid) {
                is_fixed[*i as usize] = true;
            }
        }
        let positions = vertices.iter().map(|v| v.position).collect();
        let mesh = HalfEdgeMesh::from_triangles(&TriangleMesh::new(positions, triangles))
            .map_err(|error| MeshError::Failed(error.to_string()))?;
        let places: Vec<DVec3> = vertices.iter().map(|v| v.position).collect();
        let mut kept = vec![Vec::new(); mesh.face_slots()];
        for v in mesh.vertices().filter(|v| !is_fixed[v.index()]) {
            let vertex = &vertices[v.index()];
            let is_on = vertex.value.abs() <= ON * tolerance * vertex.gradient.length();
            if let Some(f) = mesh.vertex_faces(v).next().filter(|_| is_on) {
                kept[f.index()].push(v.index() as u32);
            }
        }
        let guard = Guard::new(&mesh, |v| match guarded {
            #[cfg(test)]
            Guarded::Nowhere => false,
            Guarded::Unproved => {
                is_fixed[v.index()] || may_be_unproved(&space.forest, mesh.position(v))
            }
            Guarded::Everywhere => true,
        });
        Ok(Self {
            space,
            tolerance: SHARE * tolerance,
            limit: tolerance,
            coarse,
            threads,
            changed: vec![1; vertices.len()],
            refused: Refused::default(),
            is_off: vec![false; mesh.face_slots()],
            proofs: vec![None; mesh.face_slots()],
            places,
            kept,
            guard,
            mesh,
            vertices,
            is_fixed,
            // Sliding to the surface may have turned flat triangles; lids are exact.
            errors: is_lid
                .iter()
                .map(|is_lid| if *is_lid { 0.0 } else { f32::INFINITY })
                .collect(),
            round: 1,
        })
    }

    /// The distance of a triangle from the surface as samples tell it; `None` if it is more than
    /// the tolerance.
    pub fn distance(&self, corners: &[Vertex; 3], tolerance: f64) -> Option<f64> {
        estimate(self.space, corners.each_ref(), tolerance)
    }

    pub fn corners(&self, f: FaceId) -> [VertexId; 3] {
        let mut corners = [VertexId(0); 3];
        for (corner, v) in corners.iter_mut().zip(self.mesh.face_vertices(f)) {
            *corner = v;
        }
        corners
    }

    /// The corners of a face, with a vertex in the place of some.
    pub fn corners_with(&self, f: FaceId, replaced: &[VertexId], vertex: Vertex) -> [Vertex; 3] {
        self.corners(f).map(|v| {
            if replaced.contains(&v) {
                vertex
            } else {
                self.vertices[v.index()]
            }
        })
    }

    /// The corners of the two triangles at an edge: its ends, then the opposite ones on its left
    /// and its right.
    pub fn diamond(&self, h: HalfEdgeId) -> [VertexId; 4] {
        let mesh = &self.mesh;
        let opposite = |h| mesh.target(mesh.next(h));
        [
            mesh.origin(h),
            mesh.target(h),
            opposite(h),
            opposite(mesh.twin(h)),
        ]
    }

    /// Sine of the smallest angle of a face.
    pub fn angle(&self, f: FaceId) -> f64 {
        sine(self.corners(f).map(|v| self.mesh.position(v)))
    }

    /// That of the faces at a vertex.
    pub fn star_angle(&self, v: VertexId) -> f64 {
        let angles = self.mesh.vertex_faces(v).map(|f| self.angle(f));
        angles.fold(1.0, f64::min)
    }

    pub fn is_fixed_face(&self, f: FaceId) -> bool {
        self.corners(f).iter().all(|v| self.is_fixed[v.index()])
    }

    /// Whether an edit leaves the vertices of lids where they are.
    pub fn is_allowed(&self, edit: Edit) -> bool {
        let is_fixed = |v: VertexId| self.is_fixed[v.index()];
        match edit {
            Edit::Collapse(h) | Edit::Merge(h) => !is_fixed(self.mesh.origin(h)),
            Edit::Move(v) => !is_fixed(v),
            Edit::Flip(h) | Edit::Split(h) => {
                let [a, b, c, d] = self.diamond(h).map(is_fixed);
                !(a && b && (c || d))
            }
        }
    }

    /// The vertices that an edit depends on.
    pub fn touched(&self, edit: Edit, out: &mut Vec<VertexId>) {
        let mesh = &self.mesh;
        match edit {
            Edit::Collapse(h) | Edit::Merge(h) => {
                out.extend([mesh.origin(h), mesh.target(h)]);
                out.extend(mesh.neighbors(mesh.origin(h)));
                out.extend(mesh.neighbors(mesh.target(h)));
            }
            Edit::Flip(h) | Edit::Split(h) => out.extend(self.diamond(h)),
            Edit::Move(v) => {
                out.push(v);
                out.extend(mesh.neighbors(v));
            }
        }
    }

    /// The number of some faces that are not near the surface.
    pub fn off_among(&self, faces: impl Iterator<Item = FaceId>) -> Off {
        let mut off = Off::default();
        faces.for_each(|f| off.add(self.errors[f.index()], self.tolerance));
        off
    }

    /// The triangles that an edit makes, in the place of which faces. A vertex that is new has the
    /// number after all others.
    pub fn changes(&self, edit: Edit, vertex: Option<Vertex>) -> (Vec<[Corner; 3]>, Vec<FaceId>) {
        let mesh = &self.mesh;
        let corner = |v: VertexId| Corner {
            number: v.index() as u32,
            position: mesh.position(v),
        };
        let own = |v: VertexId| Corner {
            position: vertex.map_or(mesh.position(v), |vertex| vertex.position),
            ..corner(v)
        };
        match edit {
            Edit::Collapse(h) | Edit::Merge(h) => {
                let (u, v) = (mesh.origin(h), mesh.target(h));
                let beside = [mesh.face(h), mesh.face(mesh.twin(h))];
                let around = |v: VertexId| {
                    let faces = mesh.vertex_faces(v);
                    faces.filter(move |f| !beside.contains(&Some(*f)))
                };
                let kept: Vec<FaceId> = around(u).chain(around(v)).collect();
                let end = |w: VertexId| if w == u || w == v { own(v) } else { corner(w) };
                let triangles = kept.iter().map(|f| self.corners(*f).map(end));
                let triangles = triangles.collect();
                (
                    triangles,
                    kept.into_iter()
                        .chain(beside.into_iter().flatten())
                        .collect(),
                )
            }
            Edit::Move(v) => {
                let faces: Vec<FaceId> = mesh.vertex_faces(v).collect();
                let end = |w: VertexId| if w == v { own(v) } else { corner(w) };
                let triangles = faces.iter().map(|f| self.corners(*f).map(end));
                (triangles.collect(), faces)
            }
            Edit::Flip(h) | Edit::Split(h) => {
                let [p, q, r, s] = self.diamond(h).map(corner);
                let faces = [mesh.face(h), mesh.face(mesh.twin(h))];
                let triangles = match (edit, vertex) {
                    (Edit::Split(_), Some(vertex)) => {
                        let m = Corner {
                            number: mesh.vertex_slots() as u32,
                            position: vertex.position,
                        };
                        vec![[p, m, r], [m, q, r], [q, m, s], [m, p, s]]
                    }
                    _ => vec![[s, r, p], [r, s, q]],
                };
                (triangles, faces.into_iter().flatten().collect())
            }
        }
    }

    /// Does an edit as planned. Returns whether that was possible: the mesh has to stay a manifold,
    /// and not to cut itself.
    pub fn apply(&mut self, edit: Edit, plan: &Plan) -> bool {
        let mut touched = Vec::new();
        self.touched(edit, &mut touched);
        if !touched.iter().any(|v| self.guard.is_guarded(*v)) {
            return self.change(edit, plan).is_some();
        }
        let (triangles, gone) = self.changes(edit, plan.vertex);
        if !self.guard.is_free(&self.mesh, &triangles, &gone) {
            return false;
        }
        let ends = touched[..2].iter().any(|v| self.guard.is_guarded(*v));
        let center = self.change(edit, plan);
        if let (Some(v), Edit::Collapse(_) | Edit::Merge(_) | Edit::Split(_)) = (center, edit) {
            self.guard.set_guarded(v, ends);
        }
        let around = center.into_iter().flat_map(|v| self.mesh.vertex_faces(v));
        let changed: Vec<FaceId> = gone.iter().copied().chain(around).collect();
        for f in changed {
            if self.mesh.has_face(f) {
                self.guard.set(&self.mesh, f);
            } else {
                self.guard.remove(f);
            }
        }
        center.is_some()
    }

    /// Hands places over to the nearest of some faces.
    fn keep(&mut self, places: &[u32], faces: &[FaceId]) {
        for i in places {
            let place = self.places[*i as usize];
            let mut best = (f64::INFINITY, None);
            for f in faces {
                let triangle = self.corners(*f).map(|v| self.mesh.position(v));
                let square = mesh::closest_point(&triangle, place).distance_squared(place);
                if square < best.0 {
                    best = (square, Some(f));
                }
            }
            if let (_, Some(f)) = best {
                self.kept[f.index()].push(*i);
            }
        }
    }

    /// The faces whose places an edit hands over to others.
    fn giving(&self, edit: Edit) -> Vec<FaceId> {
        let mesh = &self.mesh;
        match edit {
            Edit::Collapse(h) | Edit::Merge(h) => mesh
                .vertex_faces(mesh.origin(h))
                .chain(mesh.vertex_faces(mesh.target(h)))
                .collect(),
            Edit::Move(v) => mesh.vertex_faces(v).collect(),
            Edit::Flip(h) | Edit::Split(h) => [mesh.face(h), mesh.face(mesh.twin(h))]
                .into_iter()
                .flatten()
                .collect(),
        }
    }

    /// Changes the mesh as planned, if it stays a manifold. Returns the vertex in the middle of the
    /// change, or an end of a flipped edge.
    pub fn change(&mut self, edit: Edit, plan: &Plan) -> Option<VertexId> {
        let giving = self.giving(edit);
        let center = self.change_mesh(edit, plan)?;
        self.kept.resize(self.mesh.face_slots(), Vec::new());
        let mut places = Vec::new();
        for f in &giving {
            places.append(&mut self.kept[f.index()]);
        }
        places.sort_unstable();
        let taking: Vec<FaceId> = match edit {
            Edit::Flip(_) => giving,
            _ => self.mesh.vertex_faces(center).collect(),
        };
        self.keep(&places, &taking);
        Some(center)
    }

    fn change_mesh(&mut self, edit: Edit, plan: &Plan) -> Option<VertexId> {
        let center = match (edit, plan.vertex) {
            (Edit::Collapse(h) | Edit::Merge(h), Some(vertex)) => {
                let v = self.mesh.target(h);
                if self.mesh.collapse_edge(h, vertex.position).is_err() {
                    return None;
                }
                self.vertices[v.index()] = vertex;
                v
            }
            (Edit::Move(v), Some(vertex)) => {
                if self.mesh.set_position(v, vertex.position).is_err() {
                    return None;
                }
                self.vertices[v.index()] = vertex;
                v
            }
            (Edit::Split(h), Some(vertex)) => {
                let Ok(v) = self.mesh.bisect_edge(h, vertex.position) else {
                    return None;
                };
                self.vertices.resize(self.mesh.vertex_slots(), vertex);
                self.vertices[v.index()] = vertex;
                self.is_fixed.resize(self.mesh.vertex_slots(), false);
                self.is_fixed[v.index()] = false;
                self.guard.set_guarded(v, false);
                self.changed.resize(self.mesh.vertex_slots(), self.round);
                self.changed[v.index()] = self.round;
                for n in self.mesh.neighbors(v) {
                    self.changed[n.index()] = self.round;
                }
                self.errors.resize(self.mesh.face_slots(), 0.0);
                let farthest = plan
                    .faces
                    .iter()
                    .map(|(_, distance)| *distance)
                    .fold(0.0, f32::max);
                self.is_off.resize(self.mesh.face_slots(), false);
                self.proofs.resize(self.mesh.face_slots(), None);
                for f in self.mesh.vertex_faces(v) {
                    self.errors[f.index()] = farthest;
                    self.is_off[f.index()] = false;
                    self.proofs[f.index()] = None;
                }
                return Some(v);
            }
            (Edit::Flip(h), _) => {
                if self.mesh.flip_edge(h).is_err() {
                    return None;
                }
                let opposite = self.mesh.target(h);
                self.changed[opposite.index()] = self.round;
                self.mesh.origin(h)
            }
            _ => return None,
        };
        for (face, distance) in &plan.faces {
            self.errors[face.index()] = *distance;
            self.is_off[face.index()] = false;
            self.proofs[face.index()] = None;
        }
        self.changed[center.index()] = self.round;
        for n in self.mesh.neighbors(center) {
            self.changed[n.index()] = self.round;
        }
        Some(center)
    }
}

/// Whether proofs may fail at a place: in cells that leave the topology open or where the gradient
/// jumps, or beside such cells.
pub fn may_be_unproved(forest: &Forest, position: DVec3) -> bool {
    let own = &forest.cells[forest.leaf_at(position) as usize];
    let size = forest.size(own.level);
    let is_open = |offset: DVec3| {
        let cell = &forest.cells[forest.leaf_at(position + offset * size) as usize];
        cell.undecided || cell.bounds.is_stuck
    };
    let around = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    around
        .into_iter()
        .any(|offset| is_open(offset) || is_open(-offset))
}

/// Sine of the smallest angle of a triangle.
pub fn sine([a, b, c]: [DVec3; 3]) -> f64 {
    let area = (b - a).cross(c - a).length();
    let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
    sides.sort_unstable_by(f64::total_cmp);
    let product = sides[1] * sides[2];
    if product > 0.0 { area / product } else { 0.0 }
}
