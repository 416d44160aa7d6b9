//! The inverse kernel.

pub mod arc;
pub mod polygon;
pub mod segment;

/// ε², the square of the distance (in radii) by which the poles of the inverse and the squared kernel
/// are rounded off. At a radius from the skeleton that changes the field by 5·10⁻¹¹ of itself.
pub const POLE2: f64 = 1e-10;
