//! Fewer and better triangles: edges are collapsed and flipped and vertices moved, as long as
//! [samples](crate::certify::estimate) tell that each new triangle is near the surface, and all
//! places of the surface where there were vertices at the start are near the mesh. At the end
//! triangles are [proved](crate::certify::is_within) to be near the surface.
//!
//! Rounds: edits that do not touch each other are chosen in an order that depends on the mesh
//! alone, planned on several threads, and applied one after the other. Where cells leave the
//! surface open, at kinks and where it touches itself, an edit is refused if an exact test finds
//! that a new triangle meets another one ([`crate::guard`]).
//!
//! `state.rs` has the mesh and changes it, `plan.rs` plans edits,
//! `rounds.rs` does many of a kind, and `settle.rs` mends what the fine mesh has wrong.

mod plan;
mod rounds;
mod settle;
mod state;

pub use state::{Improver, may_be_unproved, sine};

use crate::certify::at;
use crate::options::{MeshError, Progress};
use glam::DVec3;
use mesh::{TriangleMesh, VertexId};

/// An improved mesh.
pub struct Improved {
    /// The mesh, with normals.
    pub mesh: TriangleMesh,
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
        let proved = self.prove(&mut progress.part(0.99, 1.0))?;
        let mesh = &self.mesh;
        let is_lid = |f| self.is_fixed_face(f) && self.errors[f.index()] == 0.0;
        let is_lid = mesh.faces().map(is_lid).collect();
        let is_unproved = proved.iter().map(|is| !is).collect();
        // Those of polynomials are a few degrees off.
        let normal = |v: VertexId| at(self.space, mesh.position(v)).normal();
        let normals: Vec<DVec3> = mesh.vertices().map(normal).collect();
        let triangles = mesh.to_triangles();
        let mut mesh = triangles.map_err(|error| MeshError::Failed(error.to_string()))?;
        mesh.normals = Some(normals);
        Ok(Improved {
            mesh,
            is_unproved,
            is_lid,
        })
    }
}
