//! The mathematics of convolution surfaces.
//!
//! ```
//! use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
//! use glam::DVec3;
//!
//! // A segment of radius 0.3 with the Cauchy kernel.
//! let shaping = Shaping {
//!     kernel: Kernel::Cauchy,
//!     radius: 0.3,
//!     blobbiness: 1.0,
//!     blob_scale: BlobScale::Relative,
//!     strength: 1.0,
//!     influence: 1e-3,
//!     taper: None,
//! };
//! let skeleton = Skeleton::Segment { base: -5.0 * DVec3::X, apex: 5.0 * DVec3::X };
//! let sum: Sum = Primitive::new(skeleton, &shaping, None).into_iter().collect();
//! // The surface is where the field is T: nearly 0.3 beside the axis, as the segment is finite.
//! assert!(sum.jet(DVec3::new(0.0, 0.28, 0.0)).value > THRESHOLD);
//! assert!(sum.jet(DVec3::new(0.0, 0.31, 0.0)).value < THRESHOLD);
//! ```
//!
//! A skeleton (points, segments, arcs, triangles, polygons, planes, curves) is convolved with a
//! kernel h(r), a bump that falls with distance. The result is a smooth field F in space, the sum
//! of one term per [`Primitive`]; the surface is where F equals [`THRESHOLD`], and inside is where
//! F is larger. This room knows only mathematics: values, gradients, bounds and ray intervals.
//!
//! Where to find what:
//! - a [`Kernel`] is a file, `kernel/cauchy.rs` and so on, which says all of it: names, tail,
//!   widths, and which formula serves which bone; the formula of a Cauchy arc is in
//!   `kernel/cauchy/arc.rs`; the crate `oracle` holds them to quadrature;
//! - [`Shaping`] turns a radius, a blobbiness and a strength into a kernel's width and height;
//! - [`Implicit`] is any function with a surface, with value, gradient and proven bounds; [`Sum`]
//!   is the convolution surface's, [`Exponentials`] that of metaballs that fall with distance;
//!   [`Blend`] adds functions, [`Placed`] moves and stretches one; [`Local`] is a skeleton's
//!   convolution whose folds do not blend;
//! - [`Primitive`] is a term of the field: value, gradient, depth of influence, and the ray
//!   interval within it; [`Bound`] gives upper bounds on its size, its derivatives and the error of
//!   a cubic Hermite span;
//! - [`FarField`] divides space into cells, each with a polynomial of all that is far from it and
//!   a list of what is near;
//! - [`Blob`] is a primitive whose largest value on any interval of a ray has a closed form;
//! - [`Real`] is the number type that formulas are generic over: `f64`, `f32`, or eight `f32`
//!   side by side.
//!
//! # Accuracy
//! In double precision every cell of the chart agrees with quadrature to 10⁻⁹ (Cauchy to 10⁻¹¹,
//! from 10⁻⁶ to 10⁶ kernel widths away). In single precision the worst relative error of a cell, at
//! places that matter to a picture, is listed in BENCHMARKS.md: 10⁻⁵ or less for most, 10⁻⁴ for
//! Gauss arcs. Sums over edges (triangles and polygons, but for Cauchy's) lose digits where their
//! terms cancel, far outside and for needles: there the error stays below 2·10⁻⁶ of the largest
//! field. The slope of a Cauchy triangle across its plane is lost more than 100 widths away.

mod angle;
mod blend;
pub mod blob;
pub mod blob_chain;
mod bone;
pub mod bound;
mod carlson;
mod clausen;
mod compiled;
mod curve;
mod cut;
mod envelope;
mod error_function;
mod exponentials;
mod far;
pub mod far_field;
mod form;
mod implicit;
mod influence;
pub mod integral;
pub mod kernel;
pub mod kinks;
mod legendre;
pub mod local;
mod logarithm;
mod placed;
pub mod primitive;
pub mod profile;
mod ramp;
mod ray;
mod reach;
pub mod real;
mod ripple;
pub mod shaping;
pub mod skeleton;
pub mod sliced;
mod sort;
mod sum;
mod term;
mod waves;

pub use blend::Blend;
pub use blob::{Blob, BlobOnRay, Ceiling, Limits};
pub use blob_chain::ChainBlob;
pub use bound::Bound;
pub use cut::Cut;
pub use exponentials::Exponentials;
pub use far_field::FarField;
pub use implicit::{Ball, Clearance, Enclosure, Implicit, Part, Slack, Variation};
pub use kernel::Kernel;
pub use kinks::Kink;
pub use local::Local;
pub use logarithm::Logarithm;
pub use placed::Placed;
pub use primitive::{Jet, Primitive};
pub use profile::{Profile, Wave};
pub use ramp::Ramp;
pub use ray::AlongRay;
pub use real::Real;
pub use shaping::{BlobScale, Shaping, Taper};
pub use skeleton::Skeleton;
pub use sort::heap_sort;
pub use sum::{Sum, sum};
pub use term::{Evaluate, Term};

/// The iso-value T: the surface is where the field equals it.
pub const THRESHOLD: f64 = 1.0;
