//! A triangle or any planar polygon: a sum over its edges.
//!
//! The polygon lies in the plane z = 0. Let q be the foot of the perpendicular from the point,
//! `c² = z²+ε²`. For an edge of length l let h be the signed distance of q from its line (positive
//! inside), t₀ and `t₁ = t₀+l` the edge's interval measured from q's foot on that line, and `k² = c²+h²`.
//! Green's theorem gives
//!
//! `f = Σ ∫ ½ln((k²+t²)/c²)·h/(h²+t²) dt`,
//!
//! which the thesis gives up, and which no elementary function is. But with `t = |h|·tan φ`,
//! `k²+t² = ((k+|h|)/2)²·|1+βe^{2iφ}|²/cos²φ` where `β = (k−|h|)/(k+|h|) = c²/(k+|h|)²`. The logarithm of
//! |1+βe^{2iφ}| and that of cos φ, which is the same thing with β = 1, integrate to
//! [dilogarithms](crate::clausen). With Δ the angle at which q sees the edge, ψ in [0, π/2] the angle between
//! the edge's line and the direction from q to an end, `Λ(β, ψ) = Im Li₂(βe^{2iψ})`:
//!
//! `f = Σ sign(h)·[Δ·ln((k+|h|)/c) + ½·(sign(t)·(Λ(β,ψ)−Λ(1,ψ)) at t₁ less that at t₀)]`.
//!
//! Gradient, elementary: `Σ n·θ/k` over inward normals n in the plane, where θ is the angle that the edge
//! is seen at from a distance k instead of |h|, and across it `−(z/c²)·Σ (h/k)θ`. Where the point is so near
//! the plane that the terms of that sum are large but leave a small rest, they are taken apart:
//! `(h/k)θ = sign(h)·(Δ + D − eθ)`, `e = 1−|h|/k = c²/(k(k+|h|))`,
//! `tan D = l(k−|h|)(t₀t₁−k|h|)/((k²+t₀t₁)(h²+t₀t₁)+k|h|l²)`, and `Σ sign(h)Δ` is a multiple of 2π, 0 outside.
//!
//! Outside the polygon terms of both signs cancel. In single precision that leaves an error of about 10⁻⁶,
//! which weighs against the largest field; where a polygon is small compared to its distance the
//! [cubature](crate::far) replaces the sum.
use crate::angle::direction;
use crate::bone::{Edge, Polygon, Triangle};
use crate::clausen::{InDisc, imaginary_dilogarithm};
use crate::inverse::POLE2;
use crate::real::Scalar;
use crate::{Jet, Kernel, Real, far};
use core::f64::consts::{FRAC_PI_2, TAU};

/// Value and gradient of a polygon at a local position.
#[inline(always)]
pub fn jet<R: Real>(polygon: &Polygon<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let edges = &polygon.edges;
    let parts = polygon.fan.iter().map(|(sign, part)| (*sign, part));
    far::or_near(Kernel::Squared, edges, parts, p, over_edges(edges, p))
}

/// Value and gradient of a triangle at a local position.
#[inline(always)]
pub fn triangle<R: Real>(triangle: &Triangle<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let edges = &triangle.edges;
    let parts = core::iter::once((R::Scalar::round(1.0), triangle));
    far::or_near(Kernel::Squared, edges, parts, p, over_edges(edges, p))
}

/// The sum over the edges.
#[inline(always)]
fn over_edges<R: Real>(edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let half = R::splat(0.5);
    let c2 = z * z + R::splat(POLE2);
    let i_c2 = one / c2;
    let i_c = i_c2.sqrt();
    let mut value = zero;
    let mut in_plane = [zero; 2];
    // Σ (h/k)θ and Σ sign(h)(D − eθ), with the sums of their terms' magnitudes.
    let (mut plain, mut plain_size) = (zero, zero);
    let (mut parted, mut parted_size) = (zero, zero);
    let mut winding = zero;
    let mut nearest = R::splat(1e37);
    for edge in edges {
        let [ax, ay] = edge.along.map(R::lift);
        let length = R::lift(edge.length);
        let t0 = R::lift(edge.start) - (ax * x + ay * y);
        let t1 = t0 + length;
        let h = ax * y - ay * x - R::lift(edge.offset);
        let h_abs = h.abs();
        let h2 = h * h;
        let k2 = c2 + h2;
        let k = k2.sqrt();
        let rim = k + h_abs;
        let i_both = one / (k * rim);
        let (ik, i_rim) = (i_both * rim, i_both * k);
        let both = t0 * t1;

        let theta = direction(k * length, k2 + both);
        let seen = direction(h_abs * length, h2 + both);
        let e = c2 * i_both;
        let less = direction(
            c2 * i_rim * length * (both - k * h_abs),
            (k2 + both) * (h2 + both) + k * h_abs * length * length,
        ) - e * theta;
        let slope = theta * ik;
        plain = plain + h * slope;
        plain_size = plain_size + h_abs * slope;
        parted = parted + h.sign_to(less);
        parted_size = parted_size + less.abs();
        winding = winding + h.sign_to(seen);
        let (tt0, tt1) = (t0 * t0, t1 * t1);
        let beside = R::select(both.lt(zero), zero, tt0.min(tt1));
        nearest = nearest.min(h2 + beside);
        in_plane = [in_plane[0] - ay * slope, in_plane[1] + ax * slope];

        let side = Side {
            h: h_abs,
            h2,
            k2,
            i_rim2: i_rim * i_rim,
            beta: c2 * i_rim * i_rim,
            rest: (h_abs + h_abs) * i_rim,
            ln_beta: zero,
        };
        let ln_rim = (rim * i_c).ln();
        let side = Side {
            ln_beta: -(ln_rim + ln_rim),
            ..side
        };
        let ends = side.at(t1) - side.at(t0);
        value = value + h.sign_to(seen * ln_rim + half * ends);
    }
    let turns = (winding * R::splat(1.0 / TAU) + half).floor() * R::splat(TAU);
    // Above a corner or an edge the angles Δ have no meaning, and there is no need of them.
    let sound = R::both(c2.lt(nearest), (winding - turns).abs().lt(R::splat(1e-3)));
    let smaller = (turns.abs() + parted_size).lt(plain_size);
    let across = R::select(R::both(sound, smaller), turns + parted, plain);
    Jet {
        value,
        gradient: [in_plane[0], in_plane[1], -z * i_c2 * across],
    }
}

/// What both ends of an edge have in common.
struct Side<R> {
    /// |h|.
    h: R,
    /// h².
    h2: R,
    /// k².
    k2: R,
    /// 1/(k+|h|)².
    i_rim2: R,
    /// β.
    beta: R,
    /// 1−β.
    rest: R,
    /// ln β.
    ln_beta: R,
}

impl<R: Real> Side<R> {
    /// `sign(t)·(Λ(β,ψ) − Λ(1,ψ))` at an end.
    #[inline(always)]
    fn at(&self, t: R) -> R {
        let zero = R::splat(0.0);
        let one = R::splat(1.0);
        let two = R::splat(2.0);
        let t2 = t * t;
        let t_abs = t.abs();
        // An end at q itself, with h = 0, counts as ψ = 0.
        let i_planar = one / (self.h2 + t2).max(R::splat(1e-37));
        let sine2 = self.h2 * i_planar;
        let versine = two * sine2;
        let double_sine = two * self.h * t_abs * i_planar;
        let psi = direction(self.h, t_abs);
        // |1−e^{2iψ}|² = 4 sin²ψ; ln of 0 is multiplied by ψ = 0.
        let ln_chord2 = (versine + versine).max(R::splat(1e-37)).ln();
        let ln_ratio = ((self.k2 + t2) * self.i_rim2).ln();
        let inner = imaginary_dilogarithm(&InDisc {
            half_argument: psi,
            real: self.beta * (one - versine),
            ln_modulus: self.ln_beta,
            ln_rest2: ln_chord2 + ln_ratio,
            rest_argument: direction(self.beta * double_sine, self.rest + self.beta * versine),
        });
        let outer = imaginary_dilogarithm(&InDisc {
            half_argument: psi,
            real: one - versine,
            ln_modulus: zero,
            ln_rest2: ln_chord2,
            rest_argument: R::splat(FRAC_PI_2) - psi,
        });
        t.sign_to(inner - outer)
    }
}
