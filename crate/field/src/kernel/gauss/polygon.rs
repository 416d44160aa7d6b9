//! The Gauss kernel over a planar polygon, with holes or without, or a triangle (the thesis has
//! none).
//!
//! The polygon lies in the plane z = 0, q is the foot of the perpendicular from the point. For an
//! edge let h be the signed distance of q from its line (positive inside) and [t₀, t₁] its
//! interval measured from q's foot there. Green's theorem gives a sum over the edges,
//!
//! `f = e^(−z²)/2 · Σ (θ − ΔS)`, `S(h, t) = ∫₀ᵗ e^(−h²−τ²)·h/(h²+τ²) dτ`, (1)
//!
//! where θ is the angle at which q sees the edge and ΔS = S(h, t₁) − S(h, t₀). S is odd in h and
//! in t, and Owen's T function but for scale: the mass beyond the edge's line between the
//! directions to its foot and to t. A quadrant less a rectangle is two such masses, which gives
//! for positive h and t
//!
//! `S(h, t) + S(t, h) = (π/2)·(1 − erf h·erf t)`. (2)
//!
//! So it suffices to know S for 0 ≤ t ≤ h. With a = t/h ≤ 1 and `1/(1+x²) ≈ Σ cₖx²ᵏ` on [0, 1]
//! (Chebyshev fits, errors below 10⁻⁷ and 3·10⁻¹⁷) it is
//!
//! `S = e^(−h²)·Σ cₖ·a²ᵏ⁺¹·Fₖ(t²)`, `Fₖ(y) = ∫₀¹ s²ᵏe^(−ys²) ds`, `Fₖ = (2y·Fₖ₊₁ + e^(−y))/(2k+1)`.
//!
//! The recurrence runs downward, where all its terms are positive; a start at K with the error E
//! leaves `E·(2y)ᴷ/(2K−1)!!` in F₀, which with e^(−h²) ≤ e^(−y) is below 2⁻ᴷ/2K.
//!
//! The angles' sum is 0 outside the polygon. It is set to that, so what remains are terms that
//! fall with the distance as the field does; those that do not cancel symbolically (see [`Wing`]).
//!
//! Gradient: in the plane the sum of inward normals times `∫e^(−h²−t²)dt`, an error function;
//! across it `−2zf`.
//!
//! Near a small polygon (1) is a small difference of angles. There the integrand is nearly level,
//! and a product of Gauss–Legendre rules over the triangles between the origin and the edges is
//! good to the last digits. Single precision gives a needle, much thinner than the kernel's width
//! but long, an error of 10⁻⁷ of what a wide polygon would give.
use crate::angle::direction;
use crate::bone::Edge;
use crate::real::Scalar;
use crate::{Jet, Real, legendre};
use core::f64::consts::{FRAC_2_SQRT_PI, FRAC_PI_2};

/// Corners nearer to the origin than this: small.
const SMALL: f64 = 0.7;
/// The rules for small polygons, along an edge and from the origin to it. The remainders (see
/// [`segment`](super::segment)) for lengths 1.4 and 0.7 are below 10⁻⁷.
const EDGE_SINGLE: [(f64, f64); 3] = legendre::pairs();
const SPOKE_SINGLE: [(f64, f64); 2] = legendre::pairs();
/// Rule with remainders below 10⁻¹⁶, in double precision for both directions.
const DOUBLE: [(f64, f64); 6] = legendre::pairs();

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(edges: &[Edge<R::Scalar>], p: [R; 3]) -> Jet<R> {
    let constant = <R::Scalar as Real>::splat;
    let (mut square, mut double_area) = (constant(0.0), constant(0.0));
    for edge in edges {
        let (start, offset) = (edge.start, edge.offset);
        square = square.max(start * start + offset * offset);
        double_area = double_area + offset.abs() * edge.length;
    }
    // A polygon too thin for (1) still gets its area.
    let unseen = if R::DOUBLE { 1e-15 } else { 1e-6 };
    if R::Scalar::decide(square.lt(constant(SMALL * SMALL)))
        || R::Scalar::decide(double_area.lt(constant(unseen)))
    {
        small(edges, p)
    } else {
        large(edges, p)
    }
}

#[inline(always)]
fn large<R: Real>(edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let two = R::splat(2.0);
    let (mut angles, mut beyond, mut in_plane) = (zero, zero, [zero; 2]);
    for edge in edges {
        let [ax, ay] = edge.along.map(R::lift);
        let from = R::lift(edge.start) - (ax * x + ay * y);
        let (t0, t1) = (off_zero(from), off_zero(from + R::lift(edge.length)));
        let signed = ax * y - ay * x - R::lift(edge.offset);
        let h = signed.abs();
        let bell = (h * h).decay();
        let erfc = h.erfc(bell);
        let (first, last) = (wing(h, bell, erfc, t0), wing(h, bell, erfc, t1));
        let angle = direction(h * (t1 - t0), h * h + t0 * t1);
        angles = angles + signed.sign_to(angle);
        let part = (last.rest - first.rest) + (last.level - first.level);
        beyond = beyond + signed.sign_to(part);
        // erf t₁ − erf t₀.
        let both_sides = R::both(t0.lt(zero), zero.lt(t1));
        let span = R::select(
            both_sides,
            two - first.erfc - last.erfc,
            (first.erfc - last.erfc).abs(),
        );
        let weight = bell * span;
        in_plane = [in_plane[0] - ay * weight, in_plane[1] + ax * weight];
    }
    // The angles' sum may be rounding alone: with the foot at a corner the frames of its edges see
    // it at places an ulp apart, and the sum, like that of ΔS, may be anything.
    let rounding = R::splat(if R::DOUBLE { 1e-14 } else { 2e-6 });
    let outside = angles.abs().lt(rounding);
    let angles = R::select(outside, zero, angles);
    let height = (z * z).decay();
    let value = R::splat(0.5) * height * (angles - beyond);
    let slope = R::splat(1.0 / FRAC_2_SQRT_PI) * height;
    Jet {
        value,
        gradient: [slope * in_plane[0], slope * in_plane[1], -two * z * value],
    }
}

/// t, but not 0: at a corner its angle and its S would disagree about the direction of nothing.
#[inline(always)]
fn off_zero<R: Real>(t: R) -> R {
    let tiny = R::splat(1e-18);
    R::select(t.abs().lt(tiny), tiny, t)
}

/// S(h, t) in two parts, with h ≥ 0.
struct Wing<R> {
    /// Part of (2) that does not depend on |t|, `(π/2)·erfc h`, with t's sign, if |t| > h; else 0.
    /// Of two ends on the same side it cancels to the last bit.
    level: R,
    /// The rest of S.
    rest: R,
    /// `erfc |t|`.
    erfc: R,
}

#[inline(always)]
fn wing<R: Real>(h: R, bell_h: R, erfc_h: R, t: R) -> Wing<R> {
    let quarter_turn = R::splat(FRAC_PI_2);
    let size = t.abs();
    let bell_t = (t * t).decay();
    let erfc = size.erfc(bell_t);
    let wide = h.lt(size);
    let core = owen(
        size.max(h),
        size.min(h),
        R::select(wide, bell_t, bell_h),
        R::select(wide, bell_h, bell_t),
    );
    let by_quadrant = quarter_turn * (R::splat(1.0) - erfc_h) * erfc - core;
    let level = R::select(wide, quarter_turn * erfc_h, R::splat(0.0));
    Wing {
        level: t.sign_to(level),
        rest: t.sign_to(R::select(wide, by_quadrant, core)),
        erfc,
    }
}

/// Fits to 1/(1+x²) by powers of x².
const WITCH_SINGLE: [f64; 10] = [
    0.999_999_955_790_430_2,
    -0.999_991_113_876_468_8,
    0.999_699_330_715_743_7,
    -0.995_964_506_258_461_4,
    0.971_688_147_286_127,
    -0.881_056_407_122_745_3,
    0.675_075_179_478_695_8,
    -0.385_343_342_792_560_3,
    0.139_071_281_609_345_05,
    -0.023_178_546_934_890_842,
];
const WITCH_DOUBLE: [f64; 22] = [
    0.999_999_999_999_999_97,
    -0.999_999_999_999_972_1,
    0.999_999_999_995_488_8,
    -0.999_999_999_708_555_4,
    0.999_999_989_973_316_3,
    -0.999_999_787_480_343_2,
    0.999_996_970_987_171_4,
    -0.999_969_239_362_094_8,
    0.999_768_185_080_29,
    -0.998_664_357_650_773_1,
    0.993_981_805_502_401_5,
    -0.978_413_839_918_205_1,
    0.937_463_321_751_079_8,
    -0.851_782_237_586_017_6,
    0.708_980_430_644_247_3,
    -0.519_891_141_452_385_9,
    0.322_414_827_336_691_9,
    -0.161_899_320_675_807,
    0.062_532_578_457_163_94,
    -0.017_301_628_940_854_16,
    0.003_036_483_324_171_845_7,
    -0.000_253_040_277_014_320_5,
];

/// 1/(2k+1).
const fn reciprocals<const N: usize>() -> [f64; N] {
    let mut table = [0.0; N];
    let mut k = 0;
    while k < N {
        table[k] = 1.0 / (2 * k + 1) as f64;
        k += 1;
    }
    table
}

/// S(m, n) for 0 ≤ n ≤ m, given e^(−m²) and e^(−n²).
#[inline(always)]
fn owen<R: Real>(m: R, n: R, bell_m: R, bell_n: R) -> R {
    const START_SINGLE: [f64; 19] = reciprocals();
    const START_DOUBLE: [f64; 61] = reciprocals();
    let (fit, reciprocals): (&[f64], &[f64]) = if R::DOUBLE {
        (&WITCH_DOUBLE, &START_DOUBLE)
    } else {
        (&WITCH_SINGLE, &START_SINGLE)
    };
    let ratio = n / m.max(R::splat(1e-30));
    let square = ratio * ratio;
    let twice = R::splat(2.0) * n * n;
    // The first is the first term of its own series, since there is no F before it.
    let mut integral = R::splat(0.0);
    let (with_fit, before) = reciprocals.split_at(fit.len());
    for &reciprocal in before.iter().rev() {
        integral = (twice * integral + bell_n) * R::splat(reciprocal);
    }
    let mut sum = R::splat(0.0);
    for (&c, &reciprocal) in fit.iter().zip(with_fit).rev() {
        integral = (twice * integral + bell_n) * R::splat(reciprocal);
        sum = sum * square + R::splat(c) * integral;
    }
    bell_m * ratio * sum
}

#[inline(always)]
fn small<R: Real>(edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let half = R::splat(0.5);
    let along_edge = legendre::choose::<R>(&EDGE_SINGLE, &DOUBLE);
    let along_spoke = legendre::choose::<R>(&SPOKE_SINGLE, &DOUBLE);
    let z2 = z * z;
    let (mut value, mut in_plane) = (zero, [zero; 2]);
    for edge in edges {
        let [ax, ay] = edge.along.map(R::lift);
        let (start, length) = (R::lift(edge.start), R::lift(edge.length));
        // The origin's inward distance: twice the triangle's area by the edge's length.
        let altitude = -R::lift(edge.offset);
        let (qx, qy) = (ax * x + ay * y, ax * y - ay * x);
        let mut sums = [zero; 3];
        for &(spoke, w) in along_spoke {
            for spoke in [spoke, -spoke] {
                let s = R::splat(0.5 * (1.0 + spoke));
                let dy = qy + s * altitude;
                let beside = dy * dy + z2;
                let mut row = [zero; 2];
                for &(node, w) in along_edge {
                    for node in [node, -node] {
                        let t = start + length * R::splat(0.5 * (1.0 + node));
                        let dx = qx - s * t;
                        let e = R::splat(w) * (dx * dx + beside).decay();
                        row = [row[0] + e, row[1] + dx * e];
                    }
                }
                let weight = s * R::splat(w);
                sums = [
                    sums[0] + weight * row[0],
                    sums[1] + weight * row[1],
                    sums[2] + weight * row[0] * dy,
                ];
            }
        }
        // The rules are on [−1, 1], twice as long as their intervals.
        let area = half * half * altitude * length;
        value = value + area * sums[0];
        let [gx, gy] = [area * sums[1], area * sums[2]];
        in_plane = [
            in_plane[0] + ax * gx - ay * gy,
            in_plane[1] + ay * gx + ax * gy,
        ];
    }
    let two = one + one;
    Jet {
        value,
        gradient: [-two * in_plane[0], -two * in_plane[1], -two * z * value],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integral::integral;

    /// S by quadrature, over the angle φ with τ = h·tan φ, in which nothing is steep.
    fn by_angle(h: f64, t: f64) -> f64 {
        let end = libm::atan2(t, h);
        let mut mass = |angle: f64| {
            let cosine = libm::cos(angle);
            libm::exp(-(h / cosine) * (h / cosine))
        };
        let breaks: Vec<f64> = (0..=16).map(|i| end * f64::from(i) / 16.0).collect();
        integral(&mut mass, &breaks, 1e-15)
    }

    fn wings<R: Real>(tolerance: f64) {
        for h in [1e-9, 1e-3, 0.1, 0.4, 0.9, 1.0, 1.7, 2.5, 4.0] {
            for t in [1e-6, 1e-2, 0.3, 0.9, 1.0, 1.1, 2.0, 3.0, 5.0, 30.0] {
                let size = R::splat(h);
                let bell = (size * size).decay();
                let wing = wing(size, bell, size.erfc(bell), R::splat(t));
                let got = (wing.rest + wing.level).lane(0);
                let want = by_angle(h, t);
                assert!(
                    (got - want).abs() <= tolerance,
                    "{h} {t}: {got:e} instead of {want:e}, {:e} off",
                    got - want
                );
            }
        }
    }

    #[test]
    fn wings_are_owens_function() {
        wings::<f64>(2e-15);
        wings::<f32>(6e-7);
    }
}
