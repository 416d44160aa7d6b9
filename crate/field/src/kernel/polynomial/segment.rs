//! Polynomial kernels along a line segment.
//!
//! The segment lies on the x axis. At t from the foot of the perpendicular, whose length is ρ,
//! `v = c² − t²` with `c² = 1 − ρ²`. The part of the segment within |t| ≤ c has a middle m and a
//! half length δ, and on it
//!
//! `f = ∫g dt`, `∂f/∂x = ∫2t·g′ dt`, `∂f/∂(y,z) = −2(y,z)·∫g′ dt`, `g′ = 2c₂v + 3c₃v²`.
//!
//! The integrands are polynomials of degree at most 6, for which the Gauss–Legendre rule with four
//! nodes is exact: it is a closed form with weights for coefficients. v is positive at all nodes,
//! so that nothing cancels, however short the part or close to the kernel's rim.
use super::GAUSS4;
use crate::bone::Segment;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(
    coefficients: [f64; 2],
    segment: &Segment<R::Scalar>,
    [x, y, z]: [R; 3],
) -> Jet<R> {
    let zero = R::splat(0.0);
    let part = within(segment, R::splat(1.0), [x, y, z]);
    let [c2, c3] = coefficients.map(R::splat);
    let [d2, d3] = [2.0 * coefficients[0], 3.0 * coefficients[1]].map(R::splat);
    let (mut value, mut along, mut slope) = (zero, zero, zero);
    for [node, weight] in GAUSS4 {
        for sign in [1.0, -1.0] {
            let t = part.middle + R::splat(sign * node) * part.half;
            let v = (part.reach2 - t * t).max(zero);
            let weighted = R::splat(weight) * v;
            let by_v = weighted * (d2 + d3 * v);
            value = value + weighted * v * (c2 + c3 * v);
            slope = slope + by_v;
            along = along + t * by_v;
        }
    }
    let double = part.half + part.half;
    let across = -double * slope;
    Jet {
        value: part.half * value,
        gradient: [double * along, across * y, across * z],
    }
}

/// The part of a segment within a ball around the point.
pub(crate) struct InBall<R> {
    /// Half the length of the ball's chord on the segment's line, squared.
    pub reach2: R,
    /// The part's middle, from the foot of the perpendicular.
    pub middle: R,
    /// Half its length.
    pub half: R,
}

/// The part of a segment within a ball around the point.
#[inline(always)]
pub(crate) fn within<R: Real>(
    segment: &Segment<R::Scalar>,
    radius: R,
    [x, y, z]: [R; 3],
) -> InBall<R> {
    let zero = R::splat(0.0);
    let half = R::lift(segment.half);
    let reach2 = (radius * radius - (y * y + z * z)).max(zero);
    let reach = reach2.sqrt();
    let (t0, t1) = (-half - x, half - x);
    let (low, high) = (t0.max(-reach), t1.min(reach));
    // The whole segment's length is known better than as a difference.
    let whole = R::both((-reach).lt(t0), t1.lt(reach));
    let middle = R::splat(0.5) * (low + high);
    let cut = (R::splat(0.5) * (high - low)).max(zero);
    InBall {
        reach2,
        middle: R::select(whole, -x, middle),
        half: R::select(whole, half, cut),
    }
}
