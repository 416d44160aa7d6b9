//! The Gauss kernel along a line segment (thesis 2.21, whose print lacks the factor √π/2).
//!
//! The segment lies on the x axis, |x| ≤ c. With `ρ² = y²+z²` and, for x ≥ 0 (the field is even in
//! x), the distances `a = x−c` and `b = x+c` of the foot of the perpendicular from the ends:
//!
//! `f = e^(−ρ²)·(√π/2)·(erf b − erf a)`,
//!
//! where the difference is `erfc a − erfc b` beyond the end (a ≥ 0) and `2 − erfc|a| − erfc b`
//! abreast of the segment: the complements keep their digits far out, and for c ≥ ½ differ by so
//! much that their difference does too.
//!
//! Gradient: `∂f/∂x = e^(−ρ²)(e^(−b²) − e^(−a²))`, `∂f/∂y = −2yf`.
//!
//! For a segment shorter than 1 the differences would cancel, but the integrand is nearly level
//! along it, and a few Gauss–Legendre nodes give its integral to the last digits. The remainder of
//! the rule with n nodes is `l²ⁿ⁺¹(n!)⁴/((2n+1)(2n)!³)·max|g⁽²ⁿ⁾|`, for this g at most that of
//! `e^(−t²)` at 0, (2n)!/n!: for l = 1 it is 2·10⁻¹⁰ of the length with the 6 nodes of single and
//! below 10⁻²⁰ with the 14 of double precision.
use crate::bone::Segment;
use crate::{Jet, Real, legendre};
use core::f64::consts::FRAC_2_SQRT_PI;

/// Half the length from which on the differences keep their digits.
const SHORT: f64 = 0.5;
const SINGLE: [(f64, f64); 3] = legendre::pairs();
const DOUBLE: [(f64, f64); 7] = legendre::pairs();

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(segment: &Segment<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let half = R::lift(segment.half);
    if segment.half.lane(0) < SHORT {
        short(half, p)
    } else {
        long(half, p)
    }
}

#[inline(always)]
fn long<R: Real>(half: R, [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let two = R::splat(2.0);
    let abreast = x.abs();
    let (a, b) = (abreast - half, abreast + half);
    let beside = (y * y + z * z).decay();
    let (bell_a, bell_b) = ((a * a).decay(), (b * b).decay());
    let (erfc_a, erfc_b) = (a.abs().erfc(bell_a), b.erfc(bell_b));
    let along = R::select(a.lt(zero), two - erfc_a, erfc_a) - erfc_b;
    let value = R::splat(1.0 / FRAC_2_SQRT_PI) * beside * along;
    Jet {
        value,
        gradient: [
            x.sign_to(beside * (bell_b - bell_a)),
            -two * y * value,
            -two * z * value,
        ],
    }
}

#[inline(always)]
fn short<R: Real>(half: R, [x, y, z]: [R; 3]) -> Jet<R> {
    let beside = y * y + z * z;
    let (mut sum, mut moment) = (R::splat(0.0), R::splat(0.0));
    for &(node, weight) in legendre::choose::<R>(&SINGLE, &DOUBLE) {
        let t = half * R::splat(node);
        let weight = R::splat(weight);
        let (near, far) = (x - t, x + t);
        let e_near = weight * (near * near + beside).decay();
        let e_far = weight * (far * far + beside).decay();
        sum = sum + (e_near + e_far);
        moment = moment + (near * e_near + far * e_far);
    }
    let value = half * sum;
    let two = R::splat(2.0);
    Jet {
        value,
        gradient: [-two * half * moment, -two * y * value, -two * z * value],
    }
}
