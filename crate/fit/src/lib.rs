//! Deformation of meshes by control points.
//!
//! [`Sibson`] gives the natural-neighbour coordinates of points in space with respect to control points that lie
//! anywhere; [`Deformation`] moves the vertices of a mesh with them: Dirichlet free-form deformation, after Moccozet and
//! Magnenat-Thalmann. Knows meshes and fields, no scenes and no pages.
//!
//! ```
//! use fit::Deformation;
//! use glam::DVec3;
//!
//! let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let controls = [DVec3::X, -DVec3::X];
//! let deformation = Deformation::new(&vertices, &controls)?;
//! let moved = deformation.apply(&vertices, &[0.5 * DVec3::Z, DVec3::ZERO]);
//! // A vertex on a control point moves with it, others by less.
//! assert_eq!(moved[1], DVec3::new(1.0, 0.0, 0.5));
//! assert!(moved[0].z > 0.1 && moved[0].z < 0.3);
//! # Ok::<(), fit::Error>(())
//! ```

mod cell;
mod deformation;
mod error;
mod sibson;

pub use deformation::Deformation;
pub use error::Error;
pub use sibson::{MAX_CONTROLS, Sibson};
