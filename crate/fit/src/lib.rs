//! Deformation of meshes by control points, and meshes fitted to measured points and outlines.
//!
//! - [`Sibson`] gives the natural-neighbour coordinates of points in space with respect to control
//!   points that lie anywhere; [`Deformation`] moves the vertices of a mesh with them: Dirichlet
//!   free-form deformation, after Moccozet and Magnenat-Thalmann.
//! - [`fit()`] finds the moves of control points that bring a mesh, or the implicit surface around
//!   it, onto [`Observations`]: points, and lines of sight that graze it. After Ilić and Fua.
//!   Nearly half of the points may be wrong; a fit that fails says why ([`Fitted::failure`]).
//! - [`cloud()`] and [`outlines()`] read those from files; [`Disturbance`] makes measurements of
//!   perfect ones; [`trial`] has a head to try all this on, [`shapes`] has others.
//!
//! Knows meshes and fields, no scenes and no pages.
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

mod align;
mod cage;
mod cell;
mod cloud;
mod contour;
mod deformation;
mod disturb;
mod error;
mod field;
mod lines;
mod noise;
mod normal;
mod outlines;
mod problem;
pub mod recovery;
mod remarks;
pub mod shapes;
mod sibson;
mod sight;
mod solve;
mod stiffness;
pub mod trial;

pub use align::Rigid;
pub use cage::{cage, web};
pub use cloud::cloud;
pub use deformation::{Deformation, MAX_NODES, lattice};
pub use disturb::{Disturbance, Numbers};
pub use error::Error;
pub use field::Kind;
pub use lines::deform_lines;
pub use outlines::{Outline, outlines, sights};
pub use problem::{
    Controls, Loss, MAX_FITTED_CONTROLS, MAX_FITTED_VERTICES, MAX_OBSERVATIONS, Observations,
    Options, Problem, mean_edge,
};
pub use remarks::remarks;
pub use sibson::{MAX_CONTROLS, Sibson};
pub use sight::Sight;
pub use solve::{Fitted, Progress, fit};
