//! The cubed kernel, `h(r) = (r²+ε²)^{−3/2}`.
//!
//! ε rounds the pole off as it does the [inverse](crate::inverse) kernel's: in every formula z²
//! becomes z²+ε². All work in the primitive's own frame, in units of its radius.
use crate::Real;

pub mod arc;
pub mod cone;
pub mod polygon;
pub mod segment;

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
        // Of an end that is at the foot, too, one of the two terms is 0.
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
