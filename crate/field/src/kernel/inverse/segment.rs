//! The inverse kernel along a line segment.
//!
//! The segment lies on the x axis, |x| ≤ c. With `ρ² = y²+z²+ε²`, `a = x+c`, `b = c−x` (signed
//! distances of the foot of the perpendicular from the ends) and the distances `A = √(ρ²+a²)`,
//! `B = √(ρ²+b²)` of the ends themselves,
//!
//! `f = asinh(a/ρ) + asinh(b/ρ) = ln((A+B+2c)/(A+B−2c))`.
//!
//! Beside the segment `A+B−2c = (A−a)+(B−b)` cancels, but each of its brackets is `ρ²/(A+a)` where
//! a is positive, and a sum where it is not. So `f = ln(1+4c/g)` with a g of two positive terms,
//! and nothing cancels beside the segment, beyond its ends, on its axis or far away.
//!
//! Gradient: with `s = A+B`, `∂f/∂x = 1/A−1/B = −4cx/(ABs)` and `∂f/∂y = −4c·s·y/(AB·g·(s+2c))`.
use super::surplus;
use crate::bone::Segment;
use crate::kernel::POLE2;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(segment: &Segment<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let one = R::splat(1.0);
    let half = R::lift(segment.half);
    let length = half + half;
    let rho2 = y * y + z * z + R::splat(POLE2);
    let (a, b) = (half + x, half - x);
    let (to_a, to_b) = ((rho2 + a * a).sqrt(), (rho2 + b * b).sqrt());
    let sum = to_a + to_b;
    let gap = surplus(rho2, to_a, a) + surplus(rho2, to_b, b);
    let double = length + length;
    let ends = double / (to_a * to_b);
    let i_gap = one / gap;
    let radial = -ends * (sum / (sum + length)) * i_gap;
    Jet {
        value: (double * i_gap).ln_1p(),
        gradient: [-ends * x / sum, radial * y, radial * z],
    }
}
