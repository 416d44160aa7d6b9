//! The Cauchy kernel along a line segment (thesis 2.21).
//!
//! The segment lies on the x axis, |x| ≤ c. With `p² = 1 + y² + z²`, `a = x+c`, `b = c−x` (signed
//! distances of the foot of the perpendicular from the ends), `A = p²+a²`, `B = p²+b²` and the
//! angle θ in [0, π] between the directions to the ends, `tan θ = 2cp/(p²−ab)`:
//!
//! `f = (θ − sin θ cos θ)/(2p³) + 2c/(AB)`.
//!
//! This is the thesis's formula with the sum of its two arctangents made one angle, and its
//! fractions added. Both terms are positive, so nothing cancels, also beyond the ends and far away.
//!
//! Gradient: `∂f/∂x = 1/A² − 1/B²`, and `∂f/∂y = −4y·∫du/(p²+u²)³` with
//! `p⁵·∫ = ∫₀^θ sin⁴ + C sin³θ + C² sin θ cos θ`, `C = p²/√(AB)`.
use crate::angle::angle;
use crate::bone::Segment;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(segment: &Segment<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let one = R::splat(1.0);
    let half = R::lift(segment.half);
    let length = half + half;
    let p2 = one + y * y + z * z;
    let (a, b) = (half + x, half - x);
    let (aa, bb) = (p2 + a * a, p2 + b * b);
    let (ia, ib) = (one / aa, one / bb);
    let product = ia * ib;
    let root = product.sqrt();
    let p = p2.sqrt();
    let ip = one / p;
    let sine = p * length * root;
    let cosine = (p2 - a * b) * root;
    let turn = angle(sine, cosine);
    let ip3 = ip * ip * ip;
    let c = p2 * root;
    let sixth = ip3 * (ip * ip) * (turn.sin4 + sine * c * (sine * sine + c * cosine));
    let radial = R::splat(-4.0) * sixth;
    Jet {
        value: ip3 * turn.sin2 + length * product,
        gradient: [
            R::splat(-2.0) * x * length * (ia + ib) * product,
            radial * y,
            radial * z,
        ],
    }
}
