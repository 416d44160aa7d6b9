//! The mathematics of convolution surfaces.
//!
//! A skeleton (points, segments, arcs, triangles, planes) is convolved with a kernel h(r), a bump
//! that falls with distance. The result is a smooth field F in space, the sum of one term per
//! [`Primitive`]; the surface is where F equals [`THRESHOLD`], and inside is where F is larger.
//! This room knows only mathematics: values, gradients, bounds and ray intervals.

mod angle;
mod bounds;
pub mod cauchy;
pub mod kernel;
pub mod primitive;
pub mod profile;
pub mod quadrature;
mod ray;
mod reach;
pub mod real;
pub mod shaping;
pub mod skeleton;
mod smooth;
pub mod sum;
mod term;
mod waves;

pub use kernel::Kernel;
pub use primitive::{Jet, Primitive};
pub use profile::{Profile, Wave};
pub use ray::AlongRay;
pub use real::Real;
pub use shaping::{BlobScale, Shaping};
pub use skeleton::Skeleton;
pub use sum::Field;

/// The iso-value T: the surface is where the field equals it.
pub const THRESHOLD: f64 = 1.0;
