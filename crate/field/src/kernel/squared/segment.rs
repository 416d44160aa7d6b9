//! The squared kernel along a line segment (thesis 3.1: two arctangents, here made one angle).
//!
//! The segment lies on the x axis, |x| ≤ c. With `ρ² = y²+z²+ε²`, `a = x+c`, `b = c−x` (signed
//! distances of the foot of the perpendicular from the ends), `A = ρ²+a²`, `B = ρ²+b²` and the
//! angle θ in [0, π] between the directions to the ends, `√(AB)·(sin θ, cos θ) = (2cρ, ρ²−ab)`:
//!
//! `f = θ/ρ`.
//!
//! Gradient: `∂f/∂x = 1/A − 1/B = −4cx/(AB)`, and `∂f/∂y = −2y·∫du/(ρ²+u²)²`, where the integral is
//! the [Cauchy kernel](crate::kernel::cauchy::segment)'s with ρ for its p:
//! `(θ − sin θ cos θ)/(2ρ³) + 2c/(AB)`.
use crate::angle::angle;
use crate::bone::Segment;
use crate::kernel::POLE2;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(segment: &Segment<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let half = R::lift(segment.half);
    let length = half + half;
    let rho2 = y * y + z * z + R::splat(POLE2);
    let (a, b) = (half + x, half - x);
    let product = one / ((rho2 + a * a) * (rho2 + b * b));
    let root = product.sqrt();
    let rho = rho2.sqrt();
    let i_rho = one / rho;
    let turn = angle(rho * length * root, (rho2 - a * b) * root);
    let ends = length * product;
    let radial = -two * (turn.sin2 * i_rho * i_rho * i_rho + ends);
    Jet {
        value: turn.theta * i_rho,
        gradient: [-two * x * ends, radial * y, radial * z],
    }
}
