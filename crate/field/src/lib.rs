//! The mathematics of convolution surfaces.
//!
//! A skeleton (points, segments, arcs, triangles, polygons, planes, curves) is convolved with a kernel h(r), a bump
//! that falls with distance. The result is a smooth field F in space, the sum of one term per
//! [`Primitive`]; the surface is where F equals [`THRESHOLD`], and inside is where F is larger.
//! This room knows only mathematics: values, gradients, bounds and ray intervals.
//!
//! Where to find what:
//! - the formula of a Cauchy arc is in `cauchy/arc.rs`, and so on; `form.rs` is the chart that says which
//!   formula serves which kernel on which bone; [`quadrature`] is what they are tested against;
//! - [`Shaping`] turns a radius, a blobbiness and a strength into a kernel's width and height;
//! - [`Implicit`] is any function with a surface, with value, gradient and proven bounds; [`Sum`] is the convolution
//!   surface's;
//! - [`Primitive`] is a term of the field: its value and gradient, its depth of influence, where a
//!   ray meets that, how far a cubic may stand in for it;
//! - [`Lump`] is a primitive so simple that its largest value on any piece of a ray has a closed form;
//! - [`Real`] is the number formulas are written in: `f64`, `f32`, or eight `f32` side by side.
//!
//! # Accuracy
//! In double precision every cell of the chart agrees with quadrature to 10⁻⁹ (Cauchy to 10⁻¹¹, from
//! 10⁻⁶ to 10⁶ kernel widths away). In single precision the worst relative error of a cell, at places
//! that matter to a picture, is listed in BENCHMARKS.md: 10⁻⁵ or less for most, 10⁻⁴ for Gauss arcs.
//! Sums over edges (triangles and polygons, but for Cauchy's) lose digits where their terms cancel, far
//! outside and for needles: there it is the error compared to the largest field that stays below 2·10⁻⁶.
//! Of a Cauchy triangle the slope across its plane is lost more than 100 widths away.

mod angle;
pub mod beads;
mod bone;
pub mod bound;
mod bounds;
mod carlson;
mod cauchy;
mod clausen;
pub mod course;
mod cubed;
mod curve;
mod cut;
pub mod endless;
mod envelope;
mod error_function;
mod far;
mod form;
mod gauss;
mod implicit;
mod inverse;
pub mod kernel;
pub mod kinks;
mod legendre;
mod metaballs;
mod plane;
mod point;
mod polynomial;
pub mod primitive;
pub mod profile;
pub mod quadrature;
mod ramp;
mod ray;
mod reach;
pub mod real;
mod ripple;
pub mod shaping;
pub mod skeleton;
mod squared;
mod sum;
mod term;
mod waves;

pub use beads::Bead;
pub use bound::Bound;
pub use course::{Ceiling, Course, Limits, Lump};
pub use cut::Cut;
pub use implicit::{Ball, Enclosure, Implicit};
pub use kernel::{Derivatives, Kernel};
pub use kinks::Kink;
pub use primitive::{Jet, Primitive};
pub use profile::{Profile, Wave};
pub use ramp::Ramp;
pub use ray::AlongRay;
pub use real::Real;
pub use shaping::{BlobScale, Shaping, Taper};
pub use skeleton::Skeleton;
pub use sum::{Sum, sum};

/// The iso-value T: the surface is where the field equals it.
pub const THRESHOLD: f64 = 1.0;
