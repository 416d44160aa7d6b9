//! The gauss kernel.

pub mod arc;
pub mod polygon;
pub mod segment;
