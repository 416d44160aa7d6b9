//! The squared kernel over a triangle or any planar polygon: a sum over its edges.
//!
//! The polygon lies in the plane z = 0. Let q be the foot of the perpendicular from the point,
//! `c² = z²+ε²`. For an edge of length l let h be the signed distance of q from its line (positive
//! inside), t₀ and `t₁ = t₀+l` the edge's interval measured from q's foot on that line, and
//! `k² = c²+h²`. Green's theorem gives
//!
//! `f = Σ ∫ ½ln((k²+t²)/c²)·h/(h²+t²) dt`,
//!
//! which the thesis gives up, and which no elementary function is. But with `t = |h|·tan φ`,
//! `k²+t² = ((k+|h|)/2)²·|1+βe^{2iφ}|²/cos²φ` where `β = (k−|h|)/(k+|h|) = c²/(k+|h|)²`. The
//! logarithm of
//! |1+βe^{2iφ}| and that of cos φ, which is the same thing with β = 1, integrate to
//! [dilogarithms](crate::clausen). With Δ the angle at which q sees the edge, ψ in [0, π/2] the
//! angle between the edge's line and the direction from q to an end, `Λ(β, ψ) = Im Li₂(βe^{2iψ})`:
//!
//! `f = Σ sign(h)·[Δ·ln((k+|h|)/c) + ½·(sign(t)·(Λ(β,ψ)−Λ(1,ψ)) at t₁ less that at t₀)]`.
//!
//! Gradient, elementary: `Σ n·θ/k` over inward normals n in the plane, where θ is the angle that
//! the edge is seen at from a distance k instead of |h|, and across it `−(z/c²)·Σ (h/k)θ`. Where
//! the point is so near the plane that the terms of that sum are large but leave a small rest, they
//! are taken apart: `(h/k)θ = sign(h)·(Δ + D − eθ)`, `e = 1−|h|/k = c²/(k(k+|h|))`, where
//! `Σ sign(h)Δ` is a multiple of 2π, 0 outside, and `D = θ−Δ` is the difference of two small angles
//! at the ends, `arctan(t/|h|) − arctan(t/k) = −arg(1−βe^{2iψ})`, which the dilogarithms need as
//! well.
//!
//! Outside the polygon terms of both signs cancel. In single precision that leaves an error of
//! about 10⁻⁶, which weighs against the largest field; where a polygon is small compared to its
//! distance the [cubature](crate::far) replaces the sum.
use crate::angle::direction;
use crate::bone::{Edge, Polygon, Triangle};
use crate::clausen::{InDisc, imaginary_dilogarithm};
use crate::kernel::POLE2;
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

        let side = EdgeTerms {
            h: h_abs,
            h2,
            k2,
            i_rim,
            beta: c2 * i_rim * i_rim,
            ln_rim: (rim * i_c).ln(),
        };
        let (start, end) = (side.at(t0), side.at(t1));
        let theta = direction(k * length, k2 + both);
        let less = start.less - end.less;
        let seen = theta - less;
        let potential = seen * side.ln_rim + half * (end.potential - start.potential);
        value = value + h.sign_to(potential);

        let slope = theta * ik;
        in_plane = [in_plane[0] - ay * slope, in_plane[1] + ax * slope];
        plain = plain + h * slope;
        plain_size = plain_size + h_abs * slope;
        let part = less - c2 * i_both * theta;
        parted = parted + h.sign_to(part);
        parted_size = parted_size + part.abs();
        winding = winding + h.sign_to(seen);
        let (tt0, tt1) = (t0 * t0, t1 * t1);
        let beside = R::select(both.lt(zero), zero, tt0.min(tt1));
        nearest = nearest.min(h2 + beside);
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

/// Quantities that both ends of an edge share.
struct EdgeTerms<R> {
    /// |h|.
    h: R,
    /// h².
    h2: R,
    /// k².
    k2: R,
    /// 1/(k+|h|).
    i_rim: R,
    /// β.
    beta: R,
    /// `ln((k+|h|)/c) = −½·ln β`.
    ln_rim: R,
}

/// Contributions of one end of an edge; odd functions of t.
struct End<R> {
    /// `Λ(β,ψ) − Λ(1,ψ)`.
    potential: R,
    /// `arctan(|t|/|h|) − arctan(|t|/k)`.
    less: R,
}

impl<R: Real> EdgeTerms<R> {
    /// Returns the contributions of the end t.
    #[inline(always)]
    fn at(&self, t: R) -> End<R> {
        let zero = R::splat(0.0);
        let one = R::splat(1.0);
        let two = R::splat(2.0);
        let t2 = t * t;
        let t_abs = t.abs();
        // An end at q itself, with h = 0, counts as ψ = 0.
        let i_planar = one / (self.h2 + t2).max(R::splat(1e-37));
        let sine2 = self.h2 * i_planar;
        let versine = two * sine2;
        let psi = direction(self.h, t_abs);
        // |1−e^{2iψ}|² = 4 sin²ψ; ln of 0 is multiplied by ψ = 0.
        let ln_chord2 = (versine + versine).max(R::splat(1e-37)).ln();
        let ln_ratio = ((self.k2 + t2) * self.i_rim * self.i_rim).ln();
        // The imaginary and the real part of 1−βe^{2iψ}, both without their factor 2|h|: it may be
        // 0.
        let weight = self.beta * i_planar;
        let less = direction(weight * t_abs, self.i_rim + weight * self.h);
        let inner = imaginary_dilogarithm(&InDisc {
            half_argument: psi,
            real: self.beta * (one - versine),
            ln_modulus: -(self.ln_rim + self.ln_rim),
            ln_rest2: ln_chord2 + ln_ratio,
            rest_argument: less,
        });
        let outer = imaginary_dilogarithm(&InDisc {
            half_argument: psi,
            real: one - versine,
            ln_modulus: zero,
            ln_rest2: ln_chord2,
            rest_argument: R::splat(FRAC_PI_2) - psi,
        });
        End {
            potential: t.sign_to(inner - outer),
            less: t.sign_to(less),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes beside a polygon and nearly in its plane, also on the line of an edge, where h is 0
    /// or nearly so.
    #[test]
    fn slopes_near_the_plane() {
        // Numbers of few bits, so that both precisions mean the same places.
        let corners = [[-3.0, -2.0], [3.0, -2.0], [0.0, 4.0]];
        let bone = Triangle::new(corners);
        let narrow = bone.cast(|x| x as f32);
        for x in [-6.0_f32, -3.5, 0.25, 5.0] {
            for y in [-4.0, -2.0, -2.0 + 1e-6, -2.0 - 1e-6, 2.0, 9.0] {
                for z in [0.0, 1e-6, 1e-5, -1e-4, 1e-3, -0.1, 1.0] {
                    let p = [x, y, z];
                    let single = triangle(&narrow, p);
                    let double = triangle(&bone, p.map(f64::from));
                    let size = double.gradient.iter().fold(0.0_f64, |l, g| l.max(g.abs()));
                    for axis in 0..3 {
                        let (slope, want) =
                            (f64::from(single.gradient[axis]), double.gradient[axis]);
                        assert!(
                            (slope - want).abs() <= 1e-5 * size,
                            "axis {axis}: {slope} instead of {want} at {p:?}"
                        );
                    }
                }
            }
        }
    }
}
