//! A circular arc, by Gauss–Legendre (it has no elementary form).
//!
//! With ρ the point's distance from the axis and ψ its azimuth, and u the azimuth of a point of the
//! arc as seen from ψ, the squared distance between the two is
//! `z² + (ρ−r)² + 4rρ·sin²(u/2)`, so that
//!
//! `f = r·e^(−z²−(ρ−r)²)·∫ e^(−4rρ·sin²(u/2)) du`.
//!
//! Where 4rρ is large, only a window around u = 0 counts, `4rρ·sin²(u/2) ≤ L²`: what lies outside is
//! below erfc L of the whole circle's field. The integral runs over the part of the arc within that
//! window. It has one peak and no other feature, of width L times less than the window's: its
//! Chebyshev coefficients fall like those of e^(−L²x²), which are `e^(−L²/2)·I_k(L²/2)` for the even
//! degrees 2k. With n nodes those up to degree 2n−1 count exactly, and the rest is 10⁻⁷ (L = 3.6,
//! n = 16) or 10⁻¹⁵ (L = 6.3, n = 40) of the peak.
//!
//! Azimuths jump by 2π somewhere. An arc of at most a half circle, whose middle is brought to
//! |u| ≤ π, reaches |u| = 3π/2 at most: the window is either narrower than π/2 and meets it in
//! one piece, or takes it whole. A longer arc is the sum of its halves, whose terms are positive.
//! Azimuths are measured from the origin's, so short arcs of huge circles keep their digits.
//!
//! Gradient: in the plane, away from the axis and along the circle,
//! `−2·∫ ((ρ−r) + 2r·sin²(u/2), −2r·sin(u/2)cos(u/2))`, each times the integrand of f; across it `−2zf`.
use crate::angle::direction;
use crate::bone::Arc;
use crate::{Jet, Real, legendre};
use core::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

const SINGLE: [(f64, f64); 8] = legendre::pairs();
const DOUBLE: [(f64, f64); 20] = legendre::pairs();

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(arc: &Arc<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let two = R::splat(2.0);
    let tiny = R::splat(1e-30);
    let radius = R::lift(arc.radius);
    let half_angle = R::lift(arc.half_angle);

    let centred = radius + x;
    let rho = (centred * centred + y * y).sqrt();
    // ρ − r, without subtracting large squares.
    let gap = (two * radius * x + x * x + y * y) / (rho + radius).max(tiny);
    // On the axis any azimuth will do, but it must be the same everywhere.
    let axis = rho.lt(tiny);
    let azimuth = R::select(axis, R::splat(0.0), direction(y, centred));
    let reciprocal = R::splat(1.0) / rho.max(tiny);
    let outward = [
        R::select(axis, R::splat(1.0), centred * reciprocal),
        R::select(axis, R::splat(0.0), y * reciprocal),
    ];

    let coupling = two * two * radius * rho;
    let reach = window(coupling);
    let sums = if arc.side.lane(0) > 0.0 {
        piece(coupling, reach, -azimuth, half_angle)
    } else {
        let half = R::splat(0.5) * half_angle;
        let middle = R::splat(PI) - half;
        let one = piece(coupling, reach, nearest_turn(middle - azimuth), half);
        let other = piece(coupling, reach, nearest_turn(-middle - azimuth), half);
        [one[0] + other[0], one[1] + other[1], one[2] + other[2]]
    };

    let factor = radius * (-(z * z + gap * gap)).exp();
    let value = factor * sums[0];
    let radial = -two * (gap * value + two * radius * factor * sums[1]);
    let tangential = two * two * radius * factor * sums[2];
    Jet {
        value,
        gradient: [
            radial * outward[0] - tangential * outward[1],
            radial * outward[1] + tangential * outward[0],
            -two * z * value,
        ],
    }
}

/// An angle in (−2π, 2π) brought to [−π, π].
#[inline(always)]
fn nearest_turn<R: Real>(angle: R) -> R {
    let pi = R::splat(PI);
    let turn = R::splat(TAU);
    let angle = R::select(pi.lt(angle), angle - turn, angle);
    R::select(angle.lt(-pi), angle + turn, angle)
}

/// Half the window: the angle w of `√coupling·sin(w/2) = L`, or a little more; past all if that
/// exceeds π/2.
#[inline(always)]
fn window<R: Real>(coupling: R) -> R {
    let cut = R::splat(if R::DOUBLE { 6.3 } else { 3.6 });
    let sine = cut / coupling.sqrt().max(R::splat(1e-15));
    // arcsin s ≤ s(1 + 0.2215s²) up to s = √½: the quotient (arcsin s − s)/s³ rises.
    let narrow = R::splat(2.0) * sine * (R::splat(1.0) + R::splat(0.2215) * sine * sine);
    R::select(
        sine.lt(R::splat(FRAC_1_SQRT_2)),
        narrow,
        R::splat(1.5 * PI + 0.1),
    )
}

/// The integrals of `e^(−coupling·s²)·(1, s², s·c)`, s and c the sine and cosine of u/2, over
/// `middle ± half` within ± `reach`.
#[inline(always)]
fn piece<R: Real>(coupling: R, reach: R, middle: R, half: R) -> [R; 3] {
    let zero = R::splat(0.0);
    // The limits from the middle, lest a short piece lose its length's digits.
    let low = (-half).max(-reach - middle);
    let high = half.min(reach - middle);
    // Mean and half the difference of the limits of u/2.
    let quarter = R::splat(0.25);
    let mean = R::splat(0.5) * middle + quarter * (high + low);
    let (mean_sine, mean_cosine) = mean.sin_cos();
    let spread = quarter * (high - low).max(zero);
    let mut sums = [zero; 3];
    for &(node, weight) in legendre::choose::<R>(&SINGLE, &DOUBLE) {
        // At most π/4, since the piece is at most a half circle. The two nodes ± share it.
        let (sine, cosine) = (spread * R::splat(node)).sin_cos_octant();
        let weight = R::splat(weight);
        let (a, b) = (mean_sine * cosine, mean_cosine * sine);
        let (c, d) = (mean_cosine * cosine, mean_sine * sine);
        for (s, c) in [(a + b, c - d), (a - b, c + d)] {
            let square = s * s;
            let e = weight * (-(coupling * square)).exp();
            sums[0] = sums[0] + e;
            sums[1] = sums[1] + e * square;
            sums[2] = sums[2] + e * (s * c);
        }
    }
    let length = spread + spread;
    sums.map(|sum| sum * length)
}
