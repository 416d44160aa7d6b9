//! Fewer and better triangles: edges are collapsed and flipped and vertices moved, as long as each new triangle is
//! [proved](crate::certify) to be near the surface.
//!
//! Rounds: edits that do not touch each other are chosen in an order that depends on the mesh alone, planned on several
//! threads, and applied one after the other. Where nothing may be provable, at kinks and where the surface touches itself, an edit
//! is refused if an exact test finds that a new triangle meets another one ([`crate::guard`]).

use crate::certify::{Vertex, distance, is_hopeless, project};
use crate::forest::Forest;
use crate::guard::{Corner, Guard};
use crate::march::Raw;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::space::Space;
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, HalfEdgeMesh, TriangleMesh, VertexId};
use std::collections::BTreeMap;

/// Sine of the smallest angle that collapses must leave, unless it was smaller.
const FAIR: f64 = 0.42;
/// Most edges at a vertex after a collapse.
const MOST_EDGES: usize = 9;
/// Rounds in which triangles are divided or removed until all are near the surface.
const SETTLE_ROUNDS: usize = 40;
/// Rounds in which every edit is tried at the triangles that are left.
const RESCUE_ROUNDS: usize = 8;
/// Most triangles of such a round.
const MOST_RESCUED: usize = 500;
/// Sine of the smallest angle below which a triangle is not divided but removed.
const THIN: f64 = 0.25;
/// That below which it is not divided even if nothing else helps.
const SLIVER: f64 = 0.02;
/// Most rounds of one kind of edit.
const MOST_ROUNDS: usize = 60;

/// A change of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Edit {
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

/// A change that was proved to be good.
struct Plan {
    /// The remaining or moved vertex.
    vertex: Option<Vertex>,
    /// The faces that change, with their new distances from the surface.
    faces: Vec<(FaceId, f32)>,
    /// The new loss of that vertex.
    loss: f64,
}

/// How many faces are not proved to be near the surface at all, and how many only to be farther than the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Unproved {
    all: usize,
    far: usize,
}

impl Unproved {
    fn add(&mut self, distance: f32, tolerance: f64) {
        if distance.is_infinite() {
            self.all += 1;
        } else if distance > tolerance as f32 {
            self.far += 1;
        }
    }
}

/// Result of an attempt to prove a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Attempt {
    /// There was none.
    #[default]
    None,
    /// It failed.
    Failed,
    /// Nor would a smaller face there be proved.
    Hopeless,
}

/// A mesh that is being improved.
pub struct Improver<'a> {
    space: &'a Space<'a>,
    tolerance: f64,
    /// The largest distance of the mesh from the surface at the start.
    coarse: f64,
    threads: usize,
    mesh: HalfEdgeMesh,
    vertices: Vec<Vertex>,
    is_fixed: Vec<bool>,
    errors: Vec<f32>,
    /// How far each vertex, and those that were merged into it, may be from where the mesh was before edits that left triangles unproved.
    losses: Vec<f64>,
    /// Results of the last attempts to prove the faces that are not proved to be within the tolerance, since they changed.
    attempts: Vec<Attempt>,
    guard: Guard,
    /// The round in which something around a vertex has changed.
    changed: Vec<u32>,
    /// The round in which an edit was refused: as long as nothing changes at its vertices it would be again.
    refused: BTreeMap<Edit, u32>,
    round: u32,
}

/// An improved mesh.
pub struct Improved {
    /// The mesh, with normals.
    pub mesh: TriangleMesh,
    /// The largest proved distance of a triangle from the surface, of those within the tolerance.
    pub error: f64,
    /// Whether a triangle is not proved to be within the tolerance.
    pub is_unproved: Vec<bool>,
}

impl<'a> Improver<'a> {
    /// Takes a mesh over, with the tolerance of the result and its own. Either all edits are kept from making the mesh cut itself, or
    /// those where proofs may fail.
    ///
    /// # Errors
    /// If it is no manifold.
    pub fn new(
        space: &'a Space<'a>,
        raw: Raw,
        [tolerance, coarse]: [f64; 2],
        threads: usize,
        guards_all: bool,
    ) -> Result<Self, MeshError> {
        let Raw {
            vertices,
            triangles,
            is_lid,
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
        let guard = if guards_all {
            Guard::new(&mesh, |_| true)
        } else {
            Guard::new(&mesh, |v| {
                is_fixed[v.index()] || may_be_unproved(&space.forest, mesh.position(v))
            })
        };
        Ok(Self {
            space,
            tolerance,
            coarse,
            threads,
            changed: vec![1; vertices.len()],
            refused: BTreeMap::new(),
            attempts: vec![Attempt::None; mesh.face_slots()],
            losses: vec![0.0; mesh.vertex_slots()],
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

    /// Improves the mesh.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn run(mut self, progress: &mut Progress<'_>) -> Result<Improved, MeshError> {
        self.collapse(&mut progress.part(0.0, 0.4))?;
        self.settle(&mut progress.part(0.4, 0.5))?;
        for i in 0..3 {
            let mut progress = progress.part(0.5 + 0.16 * i as f32, 0.66 + 0.16 * i as f32);
            self.flip(&mut progress.part(0.0, 0.2))?;
            self.relax(&mut progress.part(0.2, 0.6))?;
            self.collapse(&mut progress.part(0.6, 1.0))?;
        }
        self.flip(&mut progress.part(0.98, 0.985))?;
        self.relax(&mut progress.part(0.985, 0.99))?;
        self.settle(&mut progress.part(0.99, 1.0))?;
        let mesh = &self.mesh;
        let errors = || mesh.faces().map(|f| self.errors[f.index()]);
        let tolerance = self.tolerance;
        let is_proved = |error: &f32| *error <= tolerance as f32;
        let is_unproved = errors().map(|error| !is_proved(&error)).collect();
        let error = errors().filter(is_proved).fold(0.0, f32::max);
        // Rounding to single precision is no part of it.
        let error = f64::from(error).min(tolerance);
        let normals = mesh.vertices().map(|v| self.vertices[v.index()].normal());
        let normals: Vec<DVec3> = normals.collect();
        let triangles = mesh.to_triangles();
        let mut mesh = triangles.map_err(|error| MeshError::Failed(error.to_string()))?;
        mesh.normals = Some(normals);
        Ok(Improved {
            mesh,
            error,
            is_unproved,
        })
    }

    fn collapse(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        for round in 0..MOST_ROUNDS {
            progress.at(round as f32 / MOST_ROUNDS as f32)?;
            let mut edges: Vec<(f64, HalfEdgeId)> = Vec::new();
            for h in self.mesh.edges() {
                let [u, v] = [self.mesh.origin(h), self.mesh.target(h)];
                let [a, b] = [u, v].map(|v| self.is_fixed[v.index()]);
                if a && b {
                    continue;
                }
                let length = self
                    .mesh
                    .position(u)
                    .distance_squared(self.mesh.position(v));
                edges.push((length, if a { self.mesh.twin(h) } else { h }));
            }
            edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let edits = edges.into_iter().map(|(_, h)| Edit::Collapse(h));
            let done = self.do_round(edits.collect(), progress)?;
            if done * 200 < self.mesh.face_count() {
                break;
            }
        }
        Ok(())
    }

    fn flip(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        for round in 0..6 {
            progress.at(round as f32 / 6.0)?;
            let mut edges: Vec<(f64, HalfEdgeId)> = Vec::new();
            for h in self.mesh.edges() {
                if let Some(gain) = self.flip_gain(h) {
                    edges.push((-gain, h));
                }
            }
            edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let edits = edges.into_iter().map(|(_, h)| Edit::Flip(h));
            if self.do_round(edits.collect(), progress)? * 200 < self.mesh.face_count() {
                break;
            }
        }
        Ok(())
    }

    fn relax(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        for round in 0..4 {
            progress.at(round as f32 / 4.0)?;
            let mut moves: Vec<(f64, VertexId)> = Vec::new();
            for v in self.mesh.vertices().filter(|v| !self.is_fixed[v.index()]) {
                moves.push((self.star_angle(v), v));
            }
            moves.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let edits = moves.into_iter().map(|(_, v)| Edit::Move(v));
            self.do_round(edits.collect(), progress)?;
        }
        Ok(())
    }

    /// Proves triangles that are not yet proved to be near the surface; divides those that are too large, and removes flat ones.
    fn settle(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        let (mut least, mut stalled) = (usize::MAX, 0);
        for round in 0..SETTLE_ROUNDS {
            progress.at(round as f32 / SETTLE_ROUNDS as f32)?;
            let far = self.unproved(progress)?;
            // All kinds of remedies have been tried without much success.
            if far.len() < least - least / 20 {
                (least, stalled) = (far.len(), 0);
            } else {
                stalled += 1;
                if stalled == 8 {
                    break;
                }
            }
            let mut edits: Vec<(f64, Edit)> = far
                .into_iter()
                .filter_map(|f| self.remedy(f, round))
                .collect();
            edits.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            edits.dedup_by_key(|(_, edit)| *edit);
            let edits = edits.into_iter().map(|(_, edit)| edit).collect::<Vec<_>>();
            if edits.is_empty() {
                break;
            }
            // Another round tries other edits: that nothing was done in this one does not end it.
            self.do_round(edits, progress)?;
        }
        for round in 0..RESCUE_ROUNDS {
            progress.at(round as f32 / RESCUE_ROUNDS as f32)?;
            if self.rescue(progress)? == 0 {
                break;
            }
        }
        self.unproved(progress)?;
        Ok(())
    }

    /// Tries every edit at each of the faces that are left, one after the other, until one helps. Returns how many were helped.
    fn rescue(&mut self, progress: &mut Progress<'_>) -> Result<usize, MeshError> {
        let mut done = 0;
        let far = self.unproved(progress)?;
        for (i, f) in far.into_iter().take(MOST_RESCUED).enumerate() {
            if i % 16 == 0 {
                progress.again()?;
            }
            let is_left = self.mesh.has_face(f) && self.errors[f.index()] > self.tolerance as f32;
            if !is_left {
                continue;
            }
            let edges: Vec<HalfEdgeId> = self.mesh.face_half_edges(f).collect();
            let twins: Vec<HalfEdgeId> = edges.iter().map(|h| self.mesh.twin(*h)).collect();
            let merges = edges.iter().chain(&twins).map(|h| Edit::Merge(*h));
            let flips = edges.iter().map(|h| Edit::Flip(*h));
            let moves = self.corners(f).map(Edit::Move);
            let splits = edges.iter().map(|h| Edit::Split(*h));
            let edits: Vec<Edit> = merges.chain(flips).chain(moves).chain(splits).collect();
            self.round += 1;
            for edit in edits {
                // An edit refused in an earlier round would be planned the same way again; only divisions depend on more.
                let is_known = !matches!(edit, Edit::Split(_)) && self.is_refused(edit);
                if is_known || !self.is_allowed(edit) {
                    continue;
                }
                // Divisions of flat triangles that prove nothing would be repeated for ever.
                let plan = match edit {
                    Edit::Split(h) => self.plan_split(h, self.angle(f) <= SLIVER),
                    _ => self.plan(edit),
                };
                if let Some(plan) = plan
                    && self.apply(edit, &plan)
                {
                    done += 1;
                    break;
                }
                if !matches!(edit, Edit::Split(_)) {
                    self.refused.insert(edit, self.round);
                }
            }
        }
        Ok(done)
    }

    /// Whether an edit leaves the vertices of lids where they are.
    fn is_allowed(&self, edit: Edit) -> bool {
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

    /// The faces that are not proved to be within the tolerance, also after another attempt, but might be if they were others.
    fn unproved(&mut self, progress: &mut Progress<'_>) -> Result<Vec<FaceId>, MeshError> {
        let tolerance = self.tolerance as f32;
        let faces = self.mesh.faces();
        let far: Vec<FaceId> = faces
            .filter(|f| self.errors[f.index()] > tolerance && !self.is_fixed_face(*f))
            .collect();
        let is_new = |f: &FaceId| self.attempts[f.index()] == Attempt::None;
        let new: Vec<FaceId> = far.iter().copied().filter(is_new).collect();
        let this = &*self;
        let proved = map_told(self.threads, &new, progress, |f| {
            let corners = this.corners(*f).map(|v| this.vertices[v.index()]);
            let proved = distance(this.space, corners.each_ref(), this.tolerance);
            let is_hopeless = proved.is_none() && is_hopeless(this.space, &corners, this.tolerance);
            (proved, is_hopeless)
        })?;
        for (f, (proved, is_hopeless)) in new.into_iter().zip(proved) {
            match proved {
                Some(distance) => {
                    self.errors[f.index()] = distance as f32;
                    // Edits there are judged in another way from now on.
                    for v in self.corners(f) {
                        self.changed[v.index()] = self.round + 1;
                    }
                }
                None if is_hopeless => self.attempts[f.index()] = Attempt::Hopeless,
                None => self.attempts[f.index()] = Attempt::Failed,
            }
        }
        let has_failed = |f: &FaceId| self.attempts[f.index()] == Attempt::Failed;
        Ok(far.into_iter().filter(has_failed).collect())
    }

    fn is_fixed_face(&self, f: FaceId) -> bool {
        self.corners(f).iter().all(|v| self.is_fixed[v.index()])
    }

    /// What may help a face that is not proved to be near the surface.
    fn remedy(&self, f: FaceId, round: usize) -> Option<(f64, Edit)> {
        let mesh = &self.mesh;
        let mut edges: Vec<(f64, HalfEdgeId)> = mesh
            .face_half_edges(f)
            .map(|h| {
                let [a, b] = [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v));
                (a.distance_squared(b), h.min(mesh.twin(h)))
            })
            .collect();
        edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (short, long) = (edges.first()?, edges.last()?);
        let is_fixed = |v: VertexId| self.is_fixed[v.index()];
        let split = |(length, h): (f64, HalfEdgeId)| {
            let [a, b, c, d] = self.diamond(h).map(is_fixed);
            (!(a && b && (c || d))).then_some((-length, Edit::Split(h)))
        };
        if self.angle(f) > THIN && round % 4 < 2 {
            return split(*long);
        }
        let merge = |(length, h): (f64, HalfEdgeId)| {
            let [a, b] = [mesh.origin(h), mesh.target(h)].map(is_fixed);
            let h = if a { mesh.twin(h) } else { h };
            (!(a && b)).then_some((length, Edit::Merge(h)))
        };
        match round % 8 {
            0 | 2 => merge(*short),
            1 | 5 => Some((-long.0, Edit::Flip(long.1))),
            4 => merge(edges[1]),
            6 => merge(*long),
            // A flat one would only become two.
            3 if self.angle(f) > SLIVER => split(*long),
            3 => merge(*short),
            _ => {
                let movable = self.corners(f).into_iter().filter(|v| !is_fixed(*v));
                let least = movable.map(|v| (self.star_angle(v), Edit::Move(v)));
                least.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            }
        }
    }

    /// Plans those of some edits, in their order, that do not touch each other, and applies those that are good. Returns how
    /// many.
    fn do_round(
        &mut self,
        edits: Vec<Edit>,
        progress: &mut Progress<'_>,
    ) -> Result<usize, MeshError> {
        self.round += 1;
        let mut is_taken = vec![false; self.mesh.vertex_slots()];
        let mut chosen = Vec::new();
        let mut touched = Vec::new();
        for edit in edits {
            if self.is_refused(edit) {
                continue;
            }
            touched.clear();
            self.touched(edit, &mut touched);
            if touched.iter().all(|v| !is_taken[v.index()]) {
                touched.iter().for_each(|v| is_taken[v.index()] = true);
                chosen.push(edit);
            }
        }
        let this = &*self;
        let plans = map_told(self.threads, &chosen, progress, |edit| this.plan(*edit))?;
        let mut done = 0;
        for (edit, plan) in chosen.into_iter().zip(plans) {
            let is_done = plan.is_some_and(|plan| self.apply(edit, &plan));
            done += usize::from(is_done);
            if !is_done {
                self.refused.insert(edit, self.round);
            }
        }
        Ok(done)
    }

    /// Whether an edit was refused, and would be again.
    fn is_refused(&self, edit: Edit) -> bool {
        let vertices = match edit {
            Edit::Collapse(h) | Edit::Merge(h) | Edit::Flip(h) | Edit::Split(h) => {
                [self.mesh.origin(h), self.mesh.target(h)]
            }
            Edit::Move(v) => [v; 2],
        };
        let changed = vertices.map(|v| self.changed[v.index()]);
        let refused = self.refused.get(&edit);
        refused.is_some_and(|round| changed.iter().all(|changed| changed <= round))
    }

    /// The vertices that an edit depends on.
    fn touched(&self, edit: Edit, out: &mut Vec<VertexId>) {
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

    /// The corners of the two triangles at an edge: its ends, then the opposite ones on its left and its right.
    fn diamond(&self, h: HalfEdgeId) -> [VertexId; 4] {
        let mesh = &self.mesh;
        let opposite = |h| mesh.target(mesh.next(h));
        [
            mesh.origin(h),
            mesh.target(h),
            opposite(h),
            opposite(mesh.twin(h)),
        ]
    }

    fn plan(&self, edit: Edit) -> Option<Plan> {
        match edit {
            Edit::Collapse(h) => self.plan_collapse(h),
            Edit::Merge(h) => self.plan_merge(h),
            Edit::Flip(h) => self.plan_flip(h),
            Edit::Split(h) => self.plan_split(h, false),
            Edit::Move(v) => self.plan_move(v),
        }
    }

    /// Whether the mesh stays a manifold without an edge.
    fn can_collapse(&self, h: HalfEdgeId) -> bool {
        let mesh = &self.mesh;
        let (u, v) = (mesh.origin(h), mesh.target(h));
        let common = mesh
            .neighbors(u)
            .filter(|n| mesh.find_half_edge(v, *n).is_some());
        common.count() == 2 && mesh.degree(u) + mesh.degree(v) <= MOST_EDGES + 4
    }

    /// A collapse after which more triangles are proved to be near the surface.
    fn plan_merge(&self, h: HalfEdgeId) -> Option<Plan> {
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

    fn plan_collapse(&self, h: HalfEdgeId) -> Option<Plan> {
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
    fn try_collapse(&self, h: HalfEdgeId, vertex: Vertex, moves: bool) -> Option<Plan> {
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
    fn prove(
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
        let proved = faces.iter().zip(corners).map(|(f, corners)| {
            let distance = distance(self.space, corners.each_ref(), tolerance)?;
            Some((*f, distance as f32))
        });
        proved.collect()
    }

    /// Distances of triangles from the surface, infinite where none is proved; `None` if they are no better than before: fewer
    /// may not be proved at all, or as few and fewer not to be within the tolerance.
    fn prove_more(
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
    fn loss(
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
        (loss <= self.tolerance).then_some(loss)
    }

    /// How many of some faces are not proved to be near the surface.
    fn unproved_among(&self, faces: impl Iterator<Item = FaceId>) -> Unproved {
        let mut unproved = Unproved::default();
        faces.for_each(|f| unproved.add(self.errors[f.index()], self.tolerance));
        unproved
    }

    /// Whether a triangle has a chance to be proved, and no angle is below the least one.
    fn is_likely(&self, corners: &[Vertex; 3], least_angle: f64, tolerance: f64) -> bool {
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

    fn flip_gain(&self, h: HalfEdgeId) -> Option<f64> {
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

    fn plan_flip(&self, h: HalfEdgeId) -> Option<Plan> {
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
    fn plan_split(&self, h: HalfEdgeId, helps: bool) -> Option<Plan> {
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

    fn plan_move(&self, v: VertexId) -> Option<Plan> {
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

    /// The corners of a face, with a vertex in the place of some.
    fn corners_with(&self, f: FaceId, replaced: &[VertexId], vertex: Vertex) -> [Vertex; 3] {
        self.corners(f).map(|v| {
            if replaced.contains(&v) {
                vertex
            } else {
                self.vertices[v.index()]
            }
        })
    }

    fn corners(&self, f: FaceId) -> [VertexId; 3] {
        let mut corners = [VertexId(0); 3];
        for (corner, v) in corners.iter_mut().zip(self.mesh.face_vertices(f)) {
            *corner = v;
        }
        corners
    }

    /// Sine of the smallest angle of a face.
    fn angle(&self, f: FaceId) -> f64 {
        sine(self.corners(f).map(|v| self.mesh.position(v)))
    }

    /// That of the faces at a vertex.
    fn star_angle(&self, v: VertexId) -> f64 {
        let angles = self.mesh.vertex_faces(v).map(|f| self.angle(f));
        angles.fold(1.0, f64::min)
    }

    /// The triangles that an edit makes, in the place of which faces. A vertex that is new has the number after all others.
    fn changes(&self, edit: Edit, vertex: Option<Vertex>) -> (Vec<[Corner; 3]>, Vec<FaceId>) {
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

    /// Does an edit as planned. Returns whether that was possible: the mesh has to stay a manifold, and not to cut itself.
    fn apply(&mut self, edit: Edit, plan: &Plan) -> bool {
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

    /// Changes the mesh as planned, if it stays a manifold. Returns the vertex in the middle of the change, or an end of a flipped edge.
    fn change(&mut self, edit: Edit, plan: &Plan) -> Option<VertexId> {
        let center = match (edit, plan.vertex) {
            (Edit::Collapse(h) | Edit::Merge(h), Some(vertex)) => {
                let v = self.mesh.target(h);
                if self.mesh.collapse_edge(h, vertex.position).is_err() {
                    return None;
                }
                self.vertices[v.index()] = vertex;
                self.losses[v.index()] = plan.loss;
                v
            }
            (Edit::Move(v), Some(vertex)) => {
                if self.mesh.set_position(v, vertex.position).is_err() {
                    return None;
                }
                self.vertices[v.index()] = vertex;
                self.losses[v.index()] = plan.loss;
                v
            }
            (Edit::Split(h), Some(vertex)) => {
                let Ok(v) = self.mesh.bisect_edge(h, vertex.position) else {
                    return None;
                };
                self.vertices.resize(self.mesh.vertex_slots(), vertex);
                self.vertices[v.index()] = vertex;
                self.losses.resize(self.mesh.vertex_slots(), plan.loss);
                self.losses[v.index()] = plan.loss;
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
                self.attempts.resize(self.mesh.face_slots(), Attempt::None);
                for f in self.mesh.vertex_faces(v) {
                    self.errors[f.index()] = farthest;
                    self.attempts[f.index()] = Attempt::None;
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
            self.attempts[face.index()] = Attempt::None;
        }
        self.changed[center.index()] = self.round;
        for n in self.mesh.neighbors(center) {
            self.changed[n.index()] = self.round;
        }
        Some(center)
    }
}

/// Whether proofs may fail at a place: in cells that leave the topology open or where the gradient jumps, or beside such cells.
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
fn sine([a, b, c]: [DVec3; 3]) -> f64 {
    let area = (b - a).cross(c - a).length();
    let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
    sides.sort_unstable_by(f64::total_cmp);
    let product = sides[1] * sides[2];
    if product > 0.0 { area / product } else { 0.0 }
}
