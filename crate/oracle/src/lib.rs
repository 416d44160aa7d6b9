//! Slow but true results that fast code is held to, and the checks that hold it: for tests.
//!
//! - [`quadrature`] integrates a kernel over a skeleton: the truth of every formula of `field`.
//! - [`Reference`] finds where the whole field equals T, by bisection: the truth of every way of
//!   finding a surface.
//! - [`kernels`], [`cells`] and [`tapers`] are the conformance suite of fields: of a kernel, and of
//!   its fields, generic over how they are evaluated ([`evaluation`]);
//!   `crate/field/tests/it/chart.rs` calls them for all that there are.
//! - `surfaces` (with the feature `rays`) is the suite of ways of finding a surface: random rays
//!   through random scenes, judged by the reference, generic over how crossings are found;
//!   `crate/tracer/tests/it/certified.rs` calls it.

pub mod cells;
pub mod evaluation;
pub mod kernels;
pub mod quadrature;
#[cfg(feature = "rays")]
pub mod rays;
pub mod reference;
#[cfg(feature = "rays")]
pub mod surfaces;
pub mod tapers;

pub use reference::Reference;
