//! Remedies for triangles that are not near the surface, and proofs of those that are.

use super::state::{Edit, Improver};
use crate::certify::is_within;
use crate::options::{MeshError, Progress};
use crate::parallel::{LARGE, map_by};
use mesh::{FaceId, HalfEdgeId, VertexId};

/// Rounds in which triangles are divided or removed until all are near the surface.
const SETTLE_ROUNDS: usize = 40;
/// Rounds in which nothing but divisions are tried, as long as more than one of so many triangles
/// are far.
const COARSE_ROUNDS: usize = 12;
const COARSE: usize = 4;
/// Rounds in which every edit is tried at the triangles that are left.
const RESCUE_ROUNDS: usize = 8;
/// Most triangles of such a round: where more are left, there are kinks, or the surface touches
/// itself, and no edit would help.
const MOST_RESCUED: usize = 300;
/// No more remedies are tried after so many evaluations, and so many for each triangle of the mesh.
const LEAST_WORK: u64 = 50_000;
const MOST_WORK: u64 = 60;
/// Sine of the smallest angle below which a triangle is not divided but removed.
const THIN: f64 = 0.25;
/// That below which it is not divided even if nothing else helps.
const SLIVER: f64 = 0.02;

/// Rounds in which triangles that are not proved are divided.
const DIVISIONS: usize = 5;
/// Most triangles of such a round, as a part of all, unless there are fewer than so many.
const FEW: usize = 8;
const LEAST_DIVIDED: usize = 60;

impl Improver<'_> {
    /// Looks at triangles of which nothing is known yet; divides those that are too far from the
    /// surface, and removes flat ones.
    pub fn settle(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        let (mut least, mut stalled) = (usize::MAX, 0);
        let start = self.space.evaluations();
        let most = LEAST_WORK + MOST_WORK * self.mesh.face_count() as u64;
        for round in 0..SETTLE_ROUNDS {
            progress.at(round as f32 / SETTLE_ROUNDS as f32)?;
            let far = self.off(progress)?;
            // A mesh that is too coarse has more such faces at first, and each half of one is
            // nearer.
            let is_coarse = round < COARSE_ROUNDS && COARSE * far.len() > self.mesh.face_count();
            // All kinds of remedies have been tried without much success.
            if far.len() < least - least / 20 {
                (least, stalled) = (far.len(), 0);
            } else if !is_coarse {
                stalled += 1;
                if stalled == 8 {
                    break;
                }
            }
            if self.space.evaluations() - start > most {
                break;
            }
            let mut edits: Vec<(f64, Edit)> = far
                .into_iter()
                .filter_map(|f| self.remedy(f, if is_coarse { 0 } else { round }))
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
        self.off(progress)?;
        Ok(())
    }

    /// Proves faces to be near the surface, and divides those that are not, as long as they are
    /// few. Returns whether each is proved, in the order of the faces.
    pub fn prove(&mut self, progress: &mut Progress<'_>) -> Result<Vec<bool>, MeshError> {
        for round in 0..=DIVISIONS {
            progress.at(round as f32 / (DIVISIONS + 1) as f32)?;
            let faces = self.mesh.faces();
            let new: Vec<FaceId> = faces.filter(|f| self.proofs[f.index()].is_none()).collect();
            let this = &*self;
            let found = map_by(LARGE, self.threads, &new, progress, |f| {
                let corners = this.corners(*f).map(|v| this.mesh.position(v));
                this.is_fixed_face(*f) || is_within(this.space, corners, this.limit)
            })?;
            for (f, is_proved) in new.into_iter().zip(found) {
                self.proofs[f.index()] = Some(is_proved);
            }
            let faces = self.mesh.faces();
            let open: Vec<FaceId> = faces
                .filter(|f| self.proofs[f.index()] == Some(false))
                .collect();
            let many = LEAST_DIVIDED.max(self.mesh.face_count() / FEW);
            if round == DIVISIONS || open.len() > many {
                break;
            }
            let long = open.into_iter().filter_map(|f| self.split_of_longest(f));
            let mut edits: Vec<(f64, Edit)> = long.collect();
            edits.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            edits.dedup_by_key(|(_, edit)| *edit);
            let edits = edits.into_iter().map(|(_, edit)| edit).collect();
            if self.do_round(edits, progress)? == 0 {
                break;
            }
        }
        let faces = self.mesh.faces();
        Ok(faces
            .map(|f| self.proofs[f.index()] == Some(true))
            .collect())
    }

    /// The division of a face at its longest edge, with its rank; `None` if it is too flat, or in a
    /// lid.
    fn split_of_longest(&self, f: FaceId) -> Option<(f64, Edit)> {
        let length = |h: &HalfEdgeId| {
            let [a, b] = [self.mesh.origin(*h), self.mesh.target(*h)];
            self.mesh
                .position(a)
                .distance_squared(self.mesh.position(b))
        };
        let edges = self.mesh.face_half_edges(f);
        let edges = edges.map(|h| (length(&h), h.min(self.mesh.twin(h))));
        let (length, h) = edges.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
        let edit = Edit::Split(h);
        (self.angle(f) > SLIVER && self.is_allowed(edit)).then_some((-length, edit))
    }

    /// Tries every edit at each of the faces that are left, one after the other, until one helps.
    /// Returns how many were helped.
    pub fn rescue(&mut self, progress: &mut Progress<'_>) -> Result<usize, MeshError> {
        let mut done = 0;
        let far = self.off(progress)?;
        if far.len() > MOST_RESCUED {
            return Ok(0);
        }
        for f in far {
            progress.again()?;
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
                // An edit refused in an earlier round would be planned the same way again; only
                // divisions depend on more.
                let is_known = !matches!(edit, Edit::Split(_)) && self.is_refused(edit);
                if is_known || !self.is_allowed(edit) {
                    continue;
                }
                // Divisions of flat triangles that do not help would be repeated for ever.
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

    /// The faces that are not within the tolerance.
    pub fn off(&mut self, progress: &mut Progress<'_>) -> Result<Vec<FaceId>, MeshError> {
        let tolerance = self.tolerance as f32;
        let faces = self.mesh.faces();
        let far: Vec<FaceId> = faces
            .filter(|f| self.errors[f.index()] > tolerance && !self.is_fixed_face(*f))
            .collect();
        let is_new = |f: &FaceId| !self.is_off[f.index()];
        let new: Vec<FaceId> = far.iter().copied().filter(is_new).collect();
        let this = &*self;
        let distances = map_by(LARGE, self.threads, &new, progress, |f| {
            let corners = this.corners(*f).map(|v| this.vertices[v.index()]);
            this.distance(&corners, this.tolerance)
        })?;
        for (f, distance) in new.into_iter().zip(distances) {
            match distance {
                Some(distance) => {
                    self.errors[f.index()] = distance as f32;
                    // Edits there are judged in another way from now on.
                    for v in self.corners(f) {
                        self.changed[v.index()] = self.round + 1;
                    }
                }
                None => self.is_off[f.index()] = true,
            }
        }
        Ok(far.into_iter().filter(|f| self.is_off[f.index()]).collect())
    }

    /// The edit that may help a face which is not near the surface, with its rank; `None` if there
    /// is none.
    pub fn remedy(&self, f: FaceId, round: usize) -> Option<(f64, Edit)> {
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
}
