//! The inverse kernel over a triangle or any planar polygon: the potential of a uniform plate, as a
//! sum over its edges.
//!
//! The polygon lies in the plane z = 0. Let q be the foot of the perpendicular from the point,
//! `c² = z²+ε²`. For an edge of length l let h be the signed distance of q from its line (positive
//! inside), t₀ and `t₁ = t₀+l` the edge's interval measured from q's foot on that line,
//! `k² = c²+h²` and `ρᵢ² = k²+tᵢ²`. Green's theorem gives
//!
//! `f = Σ ∫ h(√(k²+t²)−c)/(h²+t²) dt = Σ h·L − c·Ω`, `L = asinh(t₁/k) − asinh(t₀/k)`, `Ω = Σ W`,
//! `W = 2·atan2(h·l, (ρ₀+c)(ρ₁+c)+h²+t₀t₁)`.
//!
//! L is the [segment](super::segment)'s field. W is the solid angle at which the point sees the
//! triangle between q and the edge (Van Oosterom and Strackee), and Ω the polygon's: two
//! arctangents of the published form (fields.md 3.5) in one, in which nothing cancels: `ρ₀ρ₁+t₀t₁`
//! is never negative, and computed as `k²(k²+t₀²+t₁²)/(ρ₀ρ₁−t₀t₁)` where it would cancel.
//!
//! Gradient: `Σ n·L` over inward normals n in the plane, and `−(z/c)·Ω` across it.
//!
//! Outside the polygon terms of both signs cancel. In single precision that leaves an error of
//! about 10⁻⁷ times the perimeter, 2·10⁻⁶ of the largest field at a radius from the skeleton; where
//! a polygon is small compared to its distance the [cubature](crate::far) replaces the sum.
use super::surplus;
use crate::angle::direction;
use crate::bone::{Edge, Polygon, Triangle};
use crate::kernel::POLE2;
use crate::real::Scalar;
use crate::{Jet, Kernel, Real, far};

/// Value and gradient of a polygon at a local position.
#[inline(always)]
pub fn jet<R: Real>(polygon: &Polygon<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let edges = &polygon.edges;
    let parts = polygon.fan.iter().map(|(sign, part)| (*sign, part));
    far::or_near(Kernel::Inverse, edges, parts, p, over_edges(edges, p))
}

/// Value and gradient of a triangle at a local position.
#[inline(always)]
pub fn triangle<R: Real>(triangle: &Triangle<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let edges = &triangle.edges;
    let parts = core::iter::once((R::Scalar::round(1.0), triangle));
    far::or_near(Kernel::Inverse, edges, parts, p, over_edges(edges, p))
}

/// The sum over the edges.
#[inline(always)]
fn over_edges<R: Real>(edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let c2 = z * z + R::splat(POLE2);
    let c = c2.sqrt();
    let mut value = zero;
    let mut half_angle = zero;
    let mut in_plane = [zero; 2];
    for edge in edges {
        let [ax, ay] = edge.along.map(R::lift);
        let length = R::lift(edge.length);
        let t0 = R::lift(edge.start) - (ax * x + ay * y);
        let t1 = t0 + length;
        let h = ax * y - ay * x - R::lift(edge.offset);
        let h2 = h * h;
        let k2 = c2 + h2;
        let (tt0, tt1) = (t0 * t0, t1 * t1);
        let (rho0, rho1) = ((k2 + tt0).sqrt(), (k2 + tt1).sqrt());
        let gap = surplus(k2, rho0, -t0) + surplus(k2, rho1, t1);
        let line = ((length + length) / gap).ln_1p();
        let (product, both) = (rho0 * rho1, t0 * t1);
        let sum = product + both.abs();
        let cosine = R::select(both.lt(zero), k2 * ((k2 + tt0 + tt1) / sum), sum);
        half_angle = half_angle + direction(h * length, cosine + k2 + c * (rho0 + rho1));
        value = value + h * line;
        in_plane = [in_plane[0] - ay * line, in_plane[1] + ax * line];
    }
    let angle = half_angle + half_angle;
    Jet {
        value: value - c * angle,
        gradient: [in_plane[0], in_plane[1], -(z / c) * angle],
    }
}
