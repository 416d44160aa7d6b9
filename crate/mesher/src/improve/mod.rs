//! Fewer and better triangles: edges are collapsed and flipped and vertices moved, as long as each new triangle is
//! [proved](crate::certify) to be near the surface.
//!
//! Rounds: edits that do not touch each other are chosen in an order that depends on the mesh alone, planned on several
//! threads, and applied one after the other. Where nothing may be provable, at kinks and where the surface touches itself, an edit
//! is refused if an exact test finds that a new triangle meets another one ([`crate::guard`]).
//!
//! `state.rs` has the mesh and changes it, `plan.rs` plans edits, `rounds.rs` does many of a kind, and `settle.rs` proves the triangles.

mod plan;
mod rounds;
mod settle;
mod state;

pub use state::{Improver, may_be_unproved};

use crate::options::{MeshError, Progress};
use glam::DVec3;
use mesh::TriangleMesh;

/// An improved mesh.
pub struct Improved {
    /// The mesh, with normals.
    pub mesh: TriangleMesh,
    /// The largest proved distance of a triangle from the surface, of those within the tolerance.
    pub error: f64,
    /// Whether a triangle is not proved to be within the tolerance.
    pub is_unproved: Vec<bool>,
    /// Whether a triangle is a part of a lid.
    pub is_lid: Vec<bool>,
}

impl Improver<'_> {
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
        let is_lid = |f| self.is_fixed_face(f) && self.errors[f.index()] == 0.0;
        let is_lid = mesh.faces().map(is_lid).collect();
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
            is_lid,
        })
    }
}
