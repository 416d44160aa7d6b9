//! The metaballs kernel along a line segment.
//!
//! The kernel is `1.5·P(u) − 0.5·P(3u)` with `P(u) = (1−u)₊²`. Within the ball u ≤ 1 the segment
//! has a part of length L around the middle m, from t₀ to t₁, seen from the foot of the
//! perpendicular, whose length is ρ. With u₀ and u₁ the ends' distances, U their sum, and
//! `λ = asinh(t₁/ρ) − asinh(t₀/ρ)`,
//!
//! `∫P = L + L(ρ²+m²+L²/12) − 2T`, `T = ∫u = ½(L(U/2 + 2m²/U) + ρ²λ)`,
//! `∂/∂x = (u₁−u₀)(2−U)`, `u₁−u₀ = 2mL/U`, `∂/∂(y,z) = −2(y,z)(λ−L)`,
//!
//! and the same for the ball u ≤ ⅓. So each term is L times something, exact to its last digits:
//! short segments keep theirs. `λ = ln(1 + 2L/(U−L))`, and `U−L = (u₀+t₀) + (u₁−t₁)`, of which a
//! sum whose terms differ in sign is ρ² over the other. Where the two balls hold the same part, the
//! terms that are not smooth at the axis cancel to the last bit and leave `1 − 3u²`.
use super::INNER;
use crate::bone::Segment;
use crate::kernel::polynomial::segment::within;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(segment: &Segment<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let [_, y, z] = p;
    let two = R::splat(2.0);
    let three = R::splat(3.0);
    let half = R::splat(0.5);
    let outer = Integrals::new(segment, R::splat(1.0), p);
    let inner = Integrals::new(segment, R::splat(INNER), p);
    let whole = outer.length + (outer.squares - two * outer.distances);
    let core = inner.length + three * (three * inner.squares - two * inner.distances);
    let across = three * ((outer.length - three * inner.length) - (outer.lambda - inner.lambda));
    Jet {
        value: R::splat(1.5) * whole - half * core,
        gradient: [
            R::splat(1.5)
                * (outer.end_difference * (two - outer.ends)
                    - inner.end_difference * (two - three * inner.ends)),
            across * y,
            across * z,
        ],
    }
}

/// Integrals over the part within a ball.
struct Integrals<R> {
    length: R,
    /// `∫u²`.
    squares: R,
    /// `∫u`.
    distances: R,
    /// `∫1/u`.
    lambda: R,
    /// u₁−u₀.
    end_difference: R,
    /// u₀+u₁.
    ends: R,
}

impl<R: Real> Integrals<R> {
    #[inline(always)]
    fn new(segment: &Segment<R::Scalar>, radius: R, p: [R; 3]) -> Self {
        let zero = R::splat(0.0);
        let two = R::splat(2.0);
        let half = R::splat(0.5);
        let tiny = R::splat(1e-30);
        let part = within(segment, radius, p);
        let length = part.half + part.half;
        let rho2 = p[1] * p[1] + p[2] * p[2];
        let m2 = part.middle * part.middle;
        let (t0, t1) = (part.middle - part.half, part.middle + part.half);
        let (u0, u1) = ((rho2 + t0 * t0).sqrt(), (rho2 + t1 * t1).sqrt());
        let ends = u0 + u1;
        let slant = two * part.middle / ends.max(tiny);
        let (q0, q1) = (u0 + t0.abs(), u1 + t1.abs());
        // (u₀+t₀) + (u₁−t₁), with one division.
        let share = rho2 / (q0 * q1).max(tiny);
        let before = R::select(t0.lt(zero), share * q1, q0);
        let after = R::select(zero.lt(t1), share * q0, q1);
        let rest = before + after;
        let lambda = (two * length / rest.max(tiny)).ln_1p();
        Self {
            length,
            squares: length * (rho2 + m2 + length * length * R::splat(1.0 / 12.0)),
            distances: half * (length * (half * ends + part.middle * slant) + rho2 * lambda),
            lambda,
            end_difference: length * slant,
            ends,
        }
    }
}
