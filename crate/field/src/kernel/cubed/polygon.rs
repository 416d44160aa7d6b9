//! The cubed kernel over a triangle or any planar polygon: the solid angle at which it is seen,
//! divided by the height above it.
//!
//! The polygon lies in the plane z = 0. Let q be the foot of the perpendicular from the point,
//! `c² = z²+ε²`. For an edge of length l let h be the signed distance of q from its line (positive
//! inside), t₀ and `t₁ = t₀+l` the edge's interval measured from q's foot on that line,
//! `k² = c²+h²` and `ρᵢ² = k²+tᵢ²`. Green's theorem gives
//!
//! `f = Σ ∫ h(1/c − 1/√(k²+t²))/(h²+t²) dt = (1/c)·Σ W`,
//!
//! where W is the solid angle at which the point sees the triangle between q and the edge, as for
//! the [inverse kernel](crate::kernel::inverse::polygon). Beside the polygon, nearly in its plane,
//! the sum of all W is a small rest. But with Δ, the angle at which q sees the edge, `W = Δ − D`,
//! and the Δ add up to a multiple of 2π that is known beforehand (w is the winding number of q, 0
//! outside):
//!
//! `f = (2πw − Σ D)/c`, `D = arctan(c·t/(|h|ρ))` at t₁ less that at t₀
//! `= atan2(c|h|N, h²ρ₀ρ₁+c²t₀t₁)`,
//!
//! `N = t₁ρ₀−t₀ρ₁`, with the sign of h: small terms without a large one.
//!
//! Gradient: in the plane `Σ n·L` over inward normals n, with the [segment](super::segment)'s field
//! L = N/(k²ρ₀ρ₁). Across it
//!
//! `∂f/∂z = −(z/c²)·(f + Σ h·L)`, or `−z·(2πw/c³ − Σ M)`, `M = (D/c − |h|L)/c²`,
//!
//! which with r = |h|N/(h²ρ₀ρ₁+c²t₀t₁) and s(v) = (v − arctan v)/v³ is
//! `M = r·((ρ₀ρ₁−t₀t₁)/(k²ρ₀ρ₁) − r²·s(cr))`, where c divides out.
//!
//! Outside the polygon terms of both signs cancel; where a polygon is small compared to its
//! distance the [cubature](crate::far) replaces the sum.
use super::Ends;
use crate::angle::{arctangent_shortfall, direction};
use crate::bone::{Edge, Polygon, Triangle};
use crate::kernel::POLE2;
use crate::real::Scalar;
use crate::{Jet, Kernel, Real, far};
use core::f64::consts::TAU;

/// Value and gradient of a polygon at a local position.
#[inline(always)]
pub fn jet<R: Real>(polygon: &Polygon<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let edges = &polygon.edges;
    let parts = polygon.fan.iter().map(|(sign, part)| (*sign, part));
    far::or_near(Kernel::Cubed, edges, parts, p, over_edges(edges, p))
}

/// Value and gradient of a triangle at a local position.
#[inline(always)]
pub fn triangle<R: Real>(triangle: &Triangle<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let edges = &triangle.edges;
    let parts = core::iter::once((R::Scalar::round(1.0), triangle));
    far::or_near(Kernel::Cubed, edges, parts, p, over_edges(edges, p))
}

/// The sum over the edges.
#[inline(always)]
fn over_edges<R: Real>(edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let half = R::splat(0.5);
    let c2 = z * z + R::splat(POLE2);
    let i_c2 = R::splat(1.0) / c2;
    let (c, i_c) = (c2.sqrt(), i_c2.sqrt());
    let mut in_plane = [zero; 2];
    // Σ W and Σ D, with the sums of their terms' magnitudes.
    let (mut solid, mut solid_size) = (zero, zero);
    let (mut less, mut less_size) = (zero, zero);
    // Σ hL and Σ M.
    let (mut lines, mut bends) = (zero, zero);
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
        let ends = Ends::of(k2, t0, t1, length);
        let half_angle = direction(h_abs * length, ends.cosines[0] + k2 + c * ends.sum);
        let angle = half_angle + half_angle;
        solid = solid + h.sign_to(angle);
        solid_size = solid_size + angle;

        let reach = h_abs * ends.span;
        let across = h2 * ends.product + c2 * ends.both;
        let part = direction(c * reach, across);
        less = less + h.sign_to(part);
        less_size = less_size + part;

        let line = ends.field;
        in_plane = [in_plane[0] - ay * line, in_plane[1] + ax * line];
        lines = lines + h * line;
        let ratio = reach / across.max(R::splat(1e-37));
        let steep = c * ratio;
        let rest = ratio
            * (ends.cosines[1] / (k2 * ends.product)
                - ratio * ratio * arctangent_shortfall(steep, part));
        let wide = (part * i_c - h_abs * line) * i_c2;
        let narrow = R::both(zero.lt(across), steep.lt(R::splat(1.0)));
        bends = bends + h.sign_to(R::select(narrow, rest, wide));

        let (tt0, tt1) = (t0 * t0, t1 * t1);
        let beside = R::select(ends.both.lt(zero), zero, tt0.min(tt1));
        nearest = nearest.min(h2 + beside);
    }
    let winding = solid + less;
    let turns = (winding * R::splat(1.0 / TAU) + half).floor() * R::splat(TAU);
    // Above a corner or an edge the angles Δ have no meaning, and there is no need of them.
    let sound = R::both(c2.lt(nearest), (winding - turns).abs().lt(R::splat(1e-3)));
    let smaller = (turns.abs() + less_size).lt(solid_size);
    let parted = R::both(sound, smaller);
    let value = i_c * R::select(parted, turns - less, solid);
    let across = R::select(parted, turns * i_c2 * i_c - bends, i_c2 * (value + lines));
    Jet {
        value,
        gradient: [in_plane[0], in_plane[1], -z * across],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values and slopes beside a polygon and nearly in its plane, also on the line of an edge,
    /// where h is 0 or nearly so.
    #[test]
    fn values_and_slopes_near_the_plane() {
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
                    let (value, want) = (f64::from(single.value), double.value);
                    assert!(
                        (value - want).abs() <= 2e-6 * want,
                        "{value} instead of {want} at {p:?}"
                    );
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
