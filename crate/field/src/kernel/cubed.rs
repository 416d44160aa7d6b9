//! The cubed kernel, `h(r) = (r²+ε²)^{−3/2}`.
//!
//! ε rounds the pole off as it does the [inverse](crate::kernel::inverse) kernel's: in every
//! formula z² becomes z²+ε². All work in the primitive's own frame, in units of its radius.
use crate::bone::Bone;
use crate::kernel::{ALONG, Cells, Falloff, HEIGHT, POLE2, Tail, cell, numeric, powers};
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod cone;
pub mod polygon;
pub mod segment;

/// The cubed kernel.
pub(crate) struct Cubed;

impl Falloff for Cubed {
    const NAME: &'static str = "cubed";
    const MEANING: &'static str = "1/r³: no width, so the blobbiness is ignored";
    const FORMULA: &'static str = "h(u) = 1/u³";
    const TAIL: Tail = Tail::pole(3);
    const CELLS: Cells = Cells {
        segment: cell("closed", "F = [ x/√(ρ²+x²) ] / ρ² from x₁ to x₂", ALONG),
        arc: cell(
            "Carlson",
            "F = r₀ ∫ dφ/√(A − B cos φ)³, elliptic integrals of the first and the second kind",
            "computed as Carlson's R_D",
        ),
        face: cell(
            "closed",
            "F = ( 2πw − Σ [ atan2(zt, h√(h²+t²+z²)) ] along each edge ) / z",
            "the solid angle at which the polygon is seen, over the height z; \
             w is the number of times the edges run around the foot of the point, \
             h its distance from the edge's line, and t runs along the edge",
        ),
        plane: cell("closed", "F = 2π/d", HEIGHT),
    };
    const HAS_CONES: bool = true;

    fn derivatives(q: f64) -> [f64; 5] {
        let i = 1.0 / (q + POLE2);
        powers(i * i.sqrt(), i, [1.0, -1.5, 3.75, -13.125, 59.0625])
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let i = R::splat(1.0) / (q + R::splat(POLE2));
        let g = i * i.sqrt();
        (g, R::splat(1.5) * g * i)
    }

    fn along(u: f64) -> f64 {
        u / (POLE2 * (u * u + POLE2).sqrt())
    }

    /// Integrals from a and from b on: the difference of two integrals from 0 would be lost beside
    /// the pole's part.
    fn between(a: f64, b: f64) -> f64 {
        let [from_a, from_b] = [a, b].map(|u| {
            let root = (u * u + POLE2).sqrt();
            1.0 / (root * (root + u))
        });
        from_a - from_b
    }

    fn over_ring(p: f64, q: f64) -> f64 {
        let [near, far] = [p, q].map(|q| (q + POLE2).sqrt());
        2.0 * (q - p) / (near * far * (near + far))
    }

    fn line(distance: f64) -> f64 {
        2.0 / (distance * distance + POLE2)
    }

    /// `2π/√(z²+ε²)`.
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let pi = R::splat(PI);
        let c = (z * z + R::splat(POLE2)).sqrt();
        ((pi + pi) / c, Self::falling(z * z).0)
    }

    #[inline(always)]
    fn jet<R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
        match bone {
            Bone::Segment(bone) => segment::jet(bone, p),
            Bone::Arc(bone) => arc::jet(bone, p),
            Bone::Triangle(bone) => polygon::triangle(bone, p),
            Bone::Polygon(bone) => polygon::jet(bone, p),
            Bone::Curve(bone) if let Some(cone) = &bone.cone => cone::jet(cone, p),
            _ => numeric::jet::<Self, R>(bone, p),
        }
    }
}

/// A segment as seen from a point at distance k beside its line. Its ends are at t₀ and t₁ ≥ t₀
/// from the foot of the perpendicular, `ρᵢ² = k²+tᵢ²`.
struct Ends<R> {
    /// ρ₀ρ₁.
    product: R,
    /// t₀t₁.
    both: R,
    /// ρ₀+ρ₁.
    sum: R,
    /// `N = t₁ρ₀ − t₀ρ₁`.
    span: R,
    /// 1/ρ₀² and 1/ρ₁².
    inverse: [R; 2],
    /// `ρ₀ρ₁ + t₀t₁` and `ρ₀ρ₁ − t₀t₁`.
    cosines: [R; 2],
    /// The segment's field `∫ (k²+t²)^{−3/2} dt = (t₁/ρ₁ − t₀/ρ₀)/k² = N/(k²ρ₀ρ₁)`.
    field: R,
}

impl<R: Real> Ends<R> {
    /// Computes the quantities from k², t₀, t₁ and `length = t₁−t₀`. A difference that would cancel
    /// is computed as a difference of squares over the sum: `N = k²(t₁²−t₀²)/(t₁ρ₀+t₀ρ₁)`, and the
    /// smaller of `ρ₀ρ₁±t₀t₁` as `k²(k²+t₀²+t₁²)/(ρ₀ρ₁∓t₀t₁)`.
    #[inline(always)]
    fn of(k2: R, t0: R, t1: R, length: R) -> Self {
        let zero = R::splat(0.0);
        let (tt0, tt1) = (t0 * t0, t1 * t1);
        let (rho2_0, rho2_1) = (k2 + tt0, k2 + tt1);
        let (rho0, rho1) = (rho2_0.sqrt(), rho2_1.sqrt());
        let (product, both) = (rho0 * rho1, t0 * t1);
        let beside = both.lt(zero);
        // One of the two terms is 0 if an end is at the foot.
        let cross = t1.abs() * rho0 + t0.abs() * rho1;
        let apart = k2 * (length * ((t0 + t1).abs() / cross.max(R::splat(1e-37))));
        let span = R::select(beside, cross, apart);
        let larger = product + both.abs();
        let smaller = k2 * ((k2 + tt0 + tt1) / larger);
        Self {
            product,
            both,
            sum: rho0 + rho1,
            span,
            inverse: [R::splat(1.0) / rho2_0, R::splat(1.0) / rho2_1],
            cosines: [
                R::select(beside, smaller, larger),
                R::select(beside, larger, smaller),
            ],
            field: span / (k2 * product),
        }
    }
}
