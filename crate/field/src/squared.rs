//! The squared kernel.

pub mod arc;
pub mod polygon;
pub mod segment;
