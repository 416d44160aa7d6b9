//! Rounds of edits of one kind that do not touch each other.

use super::state::{Edit, Improver};
use crate::options::{MeshError, Progress};
use crate::parallel::{LARGE, map_by};
use mesh::{HalfEdgeId, VertexId};

/// Most rounds of one kind of edit.
const MOST_ROUNDS: usize = 60;

/// Edits that are done between two reports.
const TOLD: usize = 1024;

impl Improver<'_> {
    /// Plans those of some edits, in their order, that do not touch each other, and applies those
    /// that are good. Returns how many.
    pub fn do_round(
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
            // Two edits change a common face only where an end of one is beside an end of the
            // other.
            let (mesh, is_taken_at) = (&self.mesh, |v: VertexId| is_taken[v.index()]);
            let is_beside = match edit {
                Edit::Collapse(h) | Edit::Merge(h) => {
                    is_taken_at(mesh.origin(h)) || is_taken_at(mesh.target(h))
                }
                Edit::Flip(h) | Edit::Split(h) => self.diamond(h).into_iter().any(is_taken_at),
                Edit::Move(v) => is_taken_at(v),
            };
            if is_beside {
                continue;
            }
            touched.clear();
            self.touched(edit, &mut touched);
            touched.iter().for_each(|v| is_taken[v.index()] = true);
            chosen.push(edit);
        }
        let this = &*self;
        let plans = map_by(LARGE, self.threads, &chosen, progress, |edit| {
            this.plan(*edit)
        })?;
        let mut done = 0;
        for (i, (edit, plan)) in chosen.into_iter().zip(plans).enumerate() {
            if i % TOLD == 0 {
                progress.again()?;
            }
            let is_done = plan.is_some_and(|plan| self.apply(edit, &plan));
            done += usize::from(is_done);
            if !is_done {
                self.refused.insert(edit, self.round);
            }
        }
        Ok(done)
    }

    /// Whether an edit was refused, and would be again.
    pub fn is_refused(&self, edit: Edit) -> bool {
        let vertices = match edit {
            Edit::Collapse(h) | Edit::Merge(h) | Edit::Flip(h) | Edit::Split(h) => {
                [self.mesh.origin(h), self.mesh.target(h)]
            }
            Edit::Move(v) => [v; 2],
        };
        let changed = vertices.map(|v| self.changed[v.index()]);
        let refused = self.refused.round(edit);
        refused.is_some_and(|round| changed.iter().all(|changed| *changed <= round))
    }

    pub fn collapse(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
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

    pub fn flip(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
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

    pub fn relax(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
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
}
