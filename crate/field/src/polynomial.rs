//! The soft, quartic and compact6 kernels.

pub mod arc;
pub mod polygon;
pub mod segment;
