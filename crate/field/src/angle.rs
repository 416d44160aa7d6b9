//! Angles and the two integrals of them that the closed forms need.
//!
//! The convolution of a Cauchy kernel with a line, an arc or a triangle ends in an angle θ between
//! two directions, and in `θ − sin θ cos θ`, which for small θ loses all digits when computed as
//! written. Here both come from one polynomial, so that neither does.
use crate::Real;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// tan(π/8): up to here the polynomial of the arctangent reaches.
const OCTANT: f64 = 0.414_213_562_373_095_03;

/// An angle θ in [0, π] and integrals of powers of the sine up to it.
#[derive(Clone, Copy)]
pub struct Angle<R> {
    /// θ.
    pub theta: R,
    /// `∫₀^θ sin² = (θ − sin θ cos θ)/2`.
    pub sin2: R,
    /// `∫₀^θ sin⁴ = ¾·∫₀^θ sin² − ¼·sin³θ cos θ`.
    pub sin4: R,
}

/// `arctan(y/x)` for x, y ≥ 0 brought to a ratio z with |z| ≤ tan(π/8).
struct Reduced<R> {
    /// The ratio; y/x itself if that is at most [`OCTANT`].
    z: R,
    /// z².
    square: R,
    /// Q(z²), see [`Real::arctangent_tail`].
    tail: R,
    /// arctan(y/x).
    angle: R,
}

#[inline(always)]
fn reduce<R: Real>(y: R, x: R) -> Reduced<R> {
    let octant = R::splat(OCTANT);
    let (low, high) = (y.min(x), y.max(x));
    // z is low/high or, nearer to the diagonal, (low−high)/(low+high).
    let diagonal = (high * octant).lt(low);
    let numerator = R::select(diagonal, low - high, low);
    let denominator = R::select(diagonal, low + high, high);
    // 0/0 counts as 0.
    let z = numerator / denominator.max(R::splat(1e-37));
    let square = z * z;
    let tail = R::arctangent_tail(square);
    let arc = z + z * square * (R::splat(-1.0 / 3.0) + square * tail);
    let arc = R::select(diagonal, arc + R::splat(FRAC_PI_4), arc);
    let angle = R::select(x.lt(y), R::splat(FRAC_PI_2) - arc, arc);
    Reduced {
        z,
        square,
        tail,
        angle,
    }
}

/// Returns the angle θ and its integrals from its sine (≥ 0) and cosine, normalised to within
/// rounding.
#[inline(always)]
pub fn angle<R: Real>(sine: R, cosine: R) -> Angle<R> {
    let reduced = reduce(sine, cosine.abs());
    let obtuse = cosine.lt(R::splat(0.0));
    let theta = R::select(obtuse, R::splat(PI) - reduced.angle, reduced.angle);
    // Large angles: as written.
    let half = R::splat(0.5);
    let product = sine * cosine;
    let sin2 = half * (theta - product);
    let sin4 = R::splat(0.75) * sin2 - R::splat(0.25) * sine * sine * product;
    // Small ones, with τ = tan θ and arctan τ = τ − τ³/3 + τ⁵Q:
    // sin θ cos θ = τcos²θ, so the first powers cancel symbolically, not numerically.
    let (y, q) = (reduced.square, reduced.tail);
    let cube = reduced.z * y;
    let c2 = cosine * cosine;
    let small2 = half * cube * (c2 - R::splat(1.0 / 3.0) + y * q);
    let small4 = R::splat(0.125) * cube * y * (R::splat(3.0) * q - c2 + R::splat(2.0) * c2 * c2);
    let large = (cosine * R::splat(OCTANT)).lt(sine);
    Angle {
        theta,
        sin2: R::select(large, sin2, small2),
        sin4: R::select(large, sin4, small4),
    }
}

/// `(w − arctan w)/w³` for w ≥ 0, given arctan w; ⅓ at w = 0.
#[inline(always)]
pub fn arctangent_shortfall<R: Real>(w: R, arctan: R) -> R {
    let octant = R::splat(OCTANT);
    let square = w.min(octant).square();
    let small = R::splat(1.0 / 3.0) - square * R::arctangent_tail(square);
    R::select(octant.lt(w), (w - arctan) / (w * w * w), small)
}

/// The angle of the direction (x, y), in (−π, π].
#[inline(always)]
pub fn direction<R: Real>(y: R, x: R) -> R {
    let angle = reduce(y.abs(), x.abs()).angle;
    let angle = R::select(x.lt(R::splat(0.0)), R::splat(PI) - angle, angle);
    y.sign_to(angle)
}

/// Sliver between a circle's arc on the unit sphere and the great circle through its ends.
#[derive(Clone, Copy)]
pub struct Sliver<R> {
    /// `V = arctan(k tan θ) − kθ`, half the sliver's area.
    pub half_area: R,
    /// `θ − arctan(k tan θ)`.
    pub shortfall: R,
}

/// Returns the sliver for half the arc's angle θ (with its sine and cosine) and `e = 1 − k` in [0,
/// 1].
///
/// `V = eθ − ζ` with `tan ζ = e sin θ cos θ/(1 − e sin²θ)`; both terms lose their first powers
/// symbolically.
#[inline(always)]
pub fn sliver<R: Real>(angle: &Angle<R>, sine: R, cosine: R, e: R) -> Sliver<R> {
    let es2 = e * sine * sine;
    let y = e * sine * cosine.abs();
    let x = R::splat(1.0) - es2;
    let reduced = reduce(y, x);
    let small =
        -reduced.z * (es2 + reduced.square * (reduced.square * reduced.tail - R::splat(1.0 / 3.0)));
    let large = (x * R::splat(OCTANT)).lt(y);
    let rest = R::select(large, y - reduced.angle, small);
    Sliver {
        half_area: R::splat(2.0) * e * angle.sin2 + cosine.sign_to(rest),
        shortfall: cosine.sign_to(reduced.angle),
    }
}
