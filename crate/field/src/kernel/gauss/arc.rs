//! The Gauss kernel along a circular arc, by Gauss–Legendre quadrature (it has no elementary form).
//!
//! With ρ the point's distance from the axis and ψ its azimuth, and u the azimuth of a point of the
//! arc as seen from ψ, the squared distance between the two is
//! `z² + (ρ−r)² + 4rρ·sin²(u/2)`, so that
//!
//! `f = r·e^(−z²−(ρ−r)²)·∫ e^(−4rρ·sin²(u/2)) du`.
//!
//! Where 4rρ is large, only a window counts around the place of the piece that is nearest, where u
//! is v: `4rρ·(sin²(u/2) − sin²(v/2)) ≤ L²`. What lies outside is below erfc L of the field, or,
//! where the nearest place is an end, below e^(−L²) of it: so beyond the ends, where the field is a
//! tiny part of the whole circle's, it keeps its digits. The integral runs over the part of the
//! piece within that window. It has one peak and no other feature, of width L times less than the
//! window's: its Chebyshev coefficients fall like those of e^(−L²x²), which are
//! `e^(−L²/2)·I_k(L²/2)` for the even degrees 2k. With n nodes those up to degree 2n−1 count
//! exactly, and the rest is about 10⁻⁷ (L = 3.6, n = 16) or 10⁻¹⁵ (L = 6.3, n = 40) of the peak; of
//! one that falls off from an end less. Where the window would be wider than a half circle, the
//! integrand may reach further out than L: there the rest is up to 10⁻⁶ and 10⁻¹².
//!
//! Azimuths jump by 2π somewhere. An arc of at most a half circle whose middle is at |u| ≤ π
//! reaches |u| = 3π/2 at most: the window is either narrower than π/2 and meets it in one piece, or
//! takes it whole. A longer arc is the sum of its halves: all terms are positive, and nothing
//! cancels in a gap or on the axis. Azimuths are measured from that of the origin, the arc's or the
//! gap's middle, so short arcs of huge circles and narrow gaps keep their digits.
//!
//! Gradient: in the plane, away from the axis and along the circle,
//! `−2·∫ ((ρ−r) + 2r·sin²(u/2), −2r·sin(u/2)cos(u/2))`, each times the integrand of f; across it
//! `−2zf`.
use crate::angle::direction;
use crate::bone::Arc;
use crate::real::Scalar;
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

    // The field is even in y. With ψ ≥ 0 there are fewer cases.
    let beside = y.abs();
    let centred = radius + x;
    let rho = (centred * centred + y * y).sqrt();
    // ρ − r, without subtracting large squares.
    let gap = (two * radius * x + x * x + y * y) / (rho + radius).max(tiny);
    // The azimuth may be any on the axis, but must be the same everywhere.
    let axis = rho.lt(tiny);
    let azimuth = R::select(axis, R::splat(0.0), direction(beside, centred));
    let reciprocal = R::splat(1.0) / rho.max(tiny);
    let outward = [
        R::select(axis, R::splat(1.0), centred * reciprocal),
        R::select(axis, R::splat(0.0), beside * reciprocal),
    ];

    let coupling = two * two * radius * rho;
    // The squared distance from an end, or from the point opposite the gap, less (ρ − r)².
    let beyond = |end_x: R, end_y: R| {
        let (dx, dy) = (x - end_x, beside - end_y);
        (dx * dx + dy * dy - gap * gap).max(R::splat(0.0))
    };
    let end_x = -(radius * R::lift(arc.versine));
    let end_y = radius * R::lift(arc.sine);
    // The end with y ≥ 0 is the nearer one.
    let near_end = beyond(end_x, end_y);
    let sums = if R::Scalar::decide(R::Scalar::splat(0.0).lt(arc.side)) {
        piece(coupling, near_end, -azimuth, [-half_angle, half_angle])
    } else {
        // Azimuths count from the gap's middle. The halves meet opposite, at the same bits of u;
        // the other ends keep the digits of a small gap.
        let zero = R::splat(0.0);
        let half_gap = R::lift(direction(
            arc.sine,
            <R::Scalar as Real>::splat(1.0) - arc.versine,
        ));
        let seam = R::splat(PI) - azimuth;
        let opposite = beyond(-(radius + radius), zero);
        let one = piece(
            coupling,
            near_end.min(opposite),
            zero,
            [half_gap - azimuth, seam],
        );
        let end = -half_gap - azimuth;
        let turn = R::splat(TAU);
        // The middle of the other half, (seam + end + 2π)/2, beyond π?
        let wraps = zero.lt(seam + end);
        let other = [
            R::select(wraps, seam - turn, seam),
            R::select(wraps, end, end + turn),
        ];
        let far_end = beyond(end_x, -end_y);
        let other = piece(coupling, far_end.min(opposite), zero, other);
        [one[0] + other[0], one[1] + other[1], one[2] + other[2]]
    };

    let factor = radius * (z * z + gap * gap).decay();
    let value = factor * sums[0];
    let radial = -two * (gap * value + two * radius * factor * sums[1]);
    let tangential = two * two * radius * factor * sums[2];
    Jet {
        value,
        gradient: [
            radial * outward[0] - tangential * outward[1],
            y.sign_to(radial * outward[1] + tangential * outward[0]),
            -two * z * value,
        ],
    }
}

/// The window's w, or a little more; past all if that exceeds π/2. Given `4rρ·sin²(v/2)`.
#[inline(always)]
fn window<R: Real>(coupling: R, nearest: R) -> R {
    let (around, beyond) = if R::DOUBLE {
        (39.7, 39.7)
    } else {
        (13.0, 15.5)
    };
    let at_end = R::splat(0.0).lt(nearest);
    let cut = nearest + R::select(at_end, R::splat(beyond), R::splat(around));
    let sine = (cut / coupling.max(R::splat(1e-30))).sqrt();
    // arcsin s ≤ s(1 + 0.2215s²) up to s = √½: the quotient (arcsin s − s)/s³ rises.
    let narrow = R::splat(2.0) * sine * (R::splat(1.0) + R::splat(0.2215) * sine * sine);
    R::select(
        sine.lt(R::splat(FRAC_1_SQRT_2)),
        narrow,
        R::splat(1.5 * PI + 0.1),
    )
}

/// Returns the integrals of `e^(−coupling·s²)·(1, s², s·c)`, s and c the sine and cosine of u/2,
/// over the part of `from + limits` in the window; `from` is separate to keep the digits of a short
/// piece's length. `ends` is coupling·s² at the nearer of the limits.
#[inline(always)]
fn piece<R: Real>(coupling: R, ends: R, from: R, [low, high]: [R; 2]) -> [R; 3] {
    let zero = R::splat(0.0);
    let abreast = R::both((from + low).lt(zero), zero.lt(from + high));
    let reach = window(coupling, R::select(abreast, zero, ends));
    let low = low.max(-reach - from);
    let high = high.min(reach - from);
    // Mean and half the difference of the limits of u/2.
    let quarter = R::splat(0.25);
    let mean = R::splat(0.5) * from + quarter * (high + low);
    let spread = quarter * (high - low).max(zero);
    let mut sums = [zero; 3];
    if !R::any(zero.lt(spread)) {
        return sums;
    }
    // |u| ≤ 3π/2: a quarter of the mean is in the first octant, and twice doubled again.
    let (mean_sine, mean_cosine) = double(double((quarter * mean).sin_cos_octant()));
    for &(node, weight) in legendre::choose::<R>(&SINGLE, &DOUBLE) {
        // The angle is at most π/4, as a piece is at most a half circle; the nodes ± share it.
        let (sine, cosine) = (spread * R::splat(node)).sin_cos_octant();
        let weight = R::splat(weight);
        let (a, b) = (mean_sine * cosine, mean_cosine * sine);
        let (c, d) = (mean_cosine * cosine, mean_sine * sine);
        for (s, c) in [(a + b, c - d), (a - b, c + d)] {
            let square = s * s;
            let e = weight * (coupling * square).decay();
            sums[0] = sums[0] + e;
            sums[1] = sums[1] + e * square;
            sums[2] = sums[2] + e * (s * c);
        }
    }
    // Adding 0 makes 0 of −0, as where all was left out.
    let length = spread + spread;
    sums.map(|sum| sum * length + zero)
}

/// Sine and cosine of twice the angle.
#[inline(always)]
fn double<R: Real>((sine, cosine): (R, R)) -> (R, R) {
    let twice = sine + sine;
    (twice * cosine, R::splat(1.0) - twice * sine)
}
