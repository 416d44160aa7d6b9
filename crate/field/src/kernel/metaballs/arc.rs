//! The metaballs kernel along a circular arc.
//!
//! Seen from the point, the squared distance of the circle's place at the azimuth w is `u² = g² +
//! 4ρr sin²(w/2)`, see [polynomials](crate::kernel::polynomial::arc). The arc's pieces in |w| < W₃,
//! where u < ⅓, have the closed form of the polynomial `1 − 3u² = ⅔ + 3v`, `v = 1/9 − u²`.
//!
//! On those in W₃ < |w| < W₁, up to u = 1, the integrals of u and 1/u are elliptic. In
//! Carlson's form they are the sum of two functions of w of about the size of the whole at each
//! end, which a short piece's difference would not survive; so the Gauss–Legendre rule is taken
//! there, with 8 nodes in single precision and 24 in double. The integrand's singularities, u = 0,
//! are at `sinh(|Im w|/2) = g/√(4ρr)`, Re w = 0, and the pieces end where u = ⅓: the sum of half
//! axes of the largest ellipse around a piece that is clear of them is at least 1.9 (a circle that
//! just fits into the ball, g = ⅓), so that the error falls as 1.9⁻²ⁿ: it is below 5·10⁻⁷ of the
//! largest field with 8 nodes.
use super::INNER;
use super::rule_arc;
use crate::bone::Arc;
use crate::kernel::polynomial::arc::{
    AzimuthRange, Azimuths, FromCircle, Moments, PieceFrame, eighth_turn, quarter_turn,
};
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(arc: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let place = FromCircle::new(arc, p);
    let inner = place.window(R::splat(INNER));
    let outer = place.window(R::splat(1.0));
    let mut sum = [R::splat(0.0); 4];
    let mut add = |part: [R; 4]| sum = core::array::from_fn(|i| sum[i] + part[i]);
    for piece in inner.pieces(arc, &place).into_iter().flatten() {
        add(integrate_inner(arc, &place, inner.top, &piece));
    }
    for span in AzimuthRange::of(arc, &place).into_iter().flatten() {
        for [from, to] in [[inner.half, outer.half], [-outer.half, -inner.half]] {
            add(integrate_outer(arc, &place, &span.between(from, to)));
        }
    }
    place.jet(arc, sum, p)
}

/// Computes the integrals of [`polynomial::arc`](crate::kernel::polynomial::arc) for `⅔ + 3v`.
#[inline(always)]
fn integrate_inner<R: Real>(
    arc: &Arc<R::Scalar>,
    place: &FromCircle<R>,
    top: R,
    piece: &Azimuths<R>,
) -> [R; 4] {
    let around = PieceFrame::new(place, top, piece.middle);
    let h = R::splat(0.5) * piece.half;
    let h2 = h * h;
    let second = Moments::new(h).second;
    let v = around.v.max(R::splat(0.0)) - R::splat(2.0) * h2 * around.bend[0] * second;
    let scale = R::splat(4.0) * h;
    let slope = R::splat(3.0) * scale;
    around.gather([
        scale * (R::splat(2.0 / 3.0) + R::splat(3.0) * v),
        slope,
        R::splat(2.0) * R::lift(arc.radius) * h2 * slope * second,
        R::splat(0.0),
    ])
}

/// Computes the integrals of [`polynomial::arc`](crate::kernel::polynomial::arc) for `1.5(1−u)²`.
#[inline(always)]
fn integrate_outer<R: Real>(
    arc: &Arc<R::Scalar>,
    place: &FromCircle<R>,
    piece: &Azimuths<R>,
) -> [R; 4] {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let half = R::splat(0.5);
    let diameter = R::splat(2.0) * R::lift(arc.radius);
    let (sine, cosine) = quarter_turn(half * piece.middle);
    let reach = half * piece.half;
    let (mut value, mut slope, mut outward, mut onward) = (zero, zero, zero, zero);
    for [node, weight] in rule_arc::<R>() {
        let (s, c) = eighth_turn(R::splat(*node) * reach);
        for s in [s, -s] {
            let (s, c) = (sine * c + cosine * s, cosine * c - sine * s);
            let s2 = s * s;
            let q = place.near + place.spread * s2;
            let u = q.sqrt().max(R::splat(INNER));
            let rest = (one - u).max(zero);
            let weighted = R::splat(*weight) * rest;
            let by_v = weighted / u;
            value = value + weighted * rest;
            slope = slope + by_v;
            outward = outward + by_v * (place.gap + diameter * s2);
            onward = onward - by_v * (diameter * s * c);
        }
    }
    let scale = R::splat(1.5) * piece.half;
    let [cos, sin] = place.turn;
    [
        scale * value,
        scale * (cos * outward - sin * onward),
        scale * (sin * outward + cos * onward),
        scale * slope,
    ]
}
