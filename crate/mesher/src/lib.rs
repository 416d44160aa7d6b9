//! Closed triangle meshes of implicit surfaces and scenes: for files, with an error that is
//! measured, or within a proven tolerance, which takes about ten times as long.
//!
//! ```
//! use core::ops::ControlFlow;
//! use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum};
//! use glam::DVec3;
//! use mesher::{Options, Progress, box_of, polygonize};
//!
//! let shaping = Shaping {
//!     kernel: Kernel::Gauss,
//!     radius: 1.0,
//!     blobbiness: 2.0,
//!     blob_scale: BlobScale::Relative,
//!     strength: 1.0,
//!     influence: 1e-3,
//!     taper: None,
//! };
//! let ball = Skeleton::Point { center: DVec3::ZERO };
//! let ball: Sum = Primitive::new(ball, &shaping, None).into_iter().collect();
//! let domain = box_of(ball.support().expect("it has no plane"));
//! let mut report = |_step| ControlFlow::Continue(());
//! let options = Options::new(0.01);
//! let surface = polygonize(&ball, &domain, &options, &mut Progress::new(&mut report))?;
//! assert!(surface.error <= 0.01 && surface.undecided.is_empty());
//! let volume = surface.mesh.signed_volume();
//! assert!((volume - 4.0 / 3.0 * core::f64::consts::PI).abs() < 0.1);
//! # Ok::<(), mesher::MeshError>(())
//! ```
//!
//! A mesh for a file ([`approximate`]): `grow.rs` finds cells of the size that curvature asks for,
//! `dual.rs` makes a mesh of them (`march.rs` where the box cuts the surface off), `decimate.rs`
//! makes its triangles fewer, and `file.rs` measures the error both ways, mends what is too far
//! with `mend.rs`, and begins anew with more care where that is not enough. Limbs so thin that they
//! would take too many cells get a fine mesh of `tubes.rs` in their place.
//!
//! A mesh for the eye ([`look`]) is made the same way of coarse cells, which are found from the
//! skeletons by samples alone.
//!
//! The way of a proven mesh, a file each:
//! - `forest.rs` cuts a box into cubic cells of balanced sizes; `lattice.rs` fills them with
//!   tetrahedra that fit together;
//! - `refine.rs` splits cells until each proves, by bounds on the function's derivatives, that the
//!   linear interpolant has the topology of the surface; `thin.rs` splits those on that may hide a
//!   part which is thinner than they are; `space.rs` evaluates the function by the terms that
//!   matter in a place;
//! - `march.rs` makes triangles of the interpolant's level set, and lids where a box cuts it off;
//! - `patches.rs` fits polynomials to the function near the surface, which are evaluated much
//!   sooner than it;
//! - `improve/` makes them fewer and better, as long as samples of `certify.rs` tell that each is
//!   within the tolerance and all vertices of the fine mesh are that near to the new one; then
//!   `certify.rs` proves what can be proved of them;
//! - `measure.rs` measures distances by samples;
//! - `surface.rs` does all that for one function ([`polygonize`]),
//!   `model.rs` for a scene ([`mesh_scene`]) with the help of `solids.rs` (hard shapes), `level.rs`
//!   (quadrics), `paint.rs` (colours), `clipping.rs` (meshes that clip limbs) and `unite.rs`
//!   (boolean operations).
//!
//! Limits of the proofs: that a triangle is near the surface is not always proved at kinks
//! (profiles, creases between bodies), where the gradient jumps, where a surface touches itself,
//! and where it has parts as thin as a tolerance. Such triangles are counted as `unproved`; samples
//! measure their distance. Of the way back, from the surface to the mesh, no proof is made: it is
//! checked at the vertices of the fine mesh. Triangles do not cut each other: an exact test looks
//! at all of them at the end, and where cells leave the surface open `guard.rs` refuses each edit
//! that an exact test finds to do so, with `boxes.rs` for the search. Parts thinner than the
//! tolerance are there, about half a tolerance thick, unless they are too many: a thin plate of
//! some hundred tolerances' size may be missing; its cells are counted as undecided.
//!
//! [`Coating`] is another kind of mesh, which follows a skeleton that is dragged: `cages.rs` has
//! its rays, `coating.rs` their ends.
//!
//! Results have the same bits everywhere, whatever the number of threads.

mod boxes;
mod cages;
mod caps;
mod certify;
mod clipping;
mod coating;
mod crease;
mod decimate;
mod dual;
mod file;
mod forest;
mod grow;
mod guard;
mod improve;
mod lattice;
mod level;
mod look;
mod march;
mod measure;
mod mend;
mod model;
mod options;
mod paint;
mod parallel;
mod patches;
mod refine;
mod solids;
mod space;
mod surface;
mod thin;
mod tubes;
mod unite;

pub use cages::{Cage, Spoke};
pub use coating::{Coat, Coating};
pub use file::approximate;
pub use look::{THINNEST, look};
pub use measure::Measured;
pub use model::{CoatedBody, Model, ModelPart, Tolerance, Wishes, coat_scene, mesh_scene};
pub use options::{MeshError, Options, Phase, Progress, Step};
pub use surface::{SurfaceMesh, box_of, extent, polygonize};
