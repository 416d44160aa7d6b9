//! The inverse kernel, the Newtonian potential: `h(r) = 1/√(r²+ε²)`.
//!
//! ε rounds the pole off. It acts like a distance in a fourth dimension: in every formula z²
//! becomes z²+ε². All work in the primitive's own frame, in units of its radius.
use crate::Real;

pub mod arc;
pub mod polygon;
pub mod segment;

/// ε², the square of the distance (in radii) by which the poles of the inverse, the squared and the
/// cubed kernel are rounded off. At a radius from the skeleton that changes the field by 5·10⁻¹¹ of
/// itself (cubed: 1.5·10⁻¹⁰).
pub const POLE2: f64 = 1e-10;

/// `A−a` of `A = √(ρ²+a²)`: by how much a hypotenuse is longer than its leg, to the last digits.
#[inline(always)]
fn surplus<R: Real>(rho2: R, hypotenuse: R, leg: R) -> R {
    let sum = hypotenuse + leg.abs();
    R::select(leg.lt(R::splat(0.0)), sum, rho2 / sum)
}
