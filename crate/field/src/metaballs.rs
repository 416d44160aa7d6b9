//! The metaballs kernel.

pub mod arc;
pub mod polygon;
pub mod segment;

/// Where the inner piece ends.
pub const INNER: f64 = 1.0 / 3.0;
/// Its square.
pub const INNER2: f64 = 1.0 / 9.0;
