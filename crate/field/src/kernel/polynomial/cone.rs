//! Polynomial kernels along a line segment whose support varies evenly along it.
//!
//! The segment lies on the x axis, |t| ≤ c; the support's radius at its point t is `r(t) = r₁ +
//! kt`, in units of the smaller of those at its ends, |k| < 1. The factor on the kernel is that of
//! a uniform line of that width. At u from the foot of the perpendicular, whose length is ρ, and
//! with `a = r(x)`,
//!
//! `f = r(−c)·∫ g(v)/r du`, `v = ((a+ku)² − u² − ρ²)/r²`, `r = a+ku`,
//!
//! `∂f/∂x = r(−c)·∫ 2u·g′/r³ du`, `∂f/∂(y,z) = −2(y,z)·r(−c)·∫ g′/r³ du`, `g′ = 2c₂v + 3c₃v²`.
//!
//! With `β = 1−k²` and w = u − m measured from `m = ak/β`, `vr² = β(s² − w²)`, `s² = (a²/β −
//! ρ²)/β`: the support is left at ±s, as it is by a uniform segment. On the part within, the
//! integrand is a polynomial over a power of r, whose zero, the cone's tip, is `a/|k|` away from
//! the foot: a Gauss–Legendre rule is right to 10⁻⁶ of the value with 10 nodes for |k| ≤
//! [`STEEPEST`], to 10⁻¹² with 16.
use crate::kernel::cubed::cone::Cone;
use crate::legendre;
use crate::{Jet, Real};

/// Largest change of the support's radius over the length.
pub(crate) const STEEPEST: f64 = 0.4;

/// The rules, which single and double precision have.
const SINGLE: &[(f64, f64)] = &legendre::pairs::<5>();
const DOUBLE: &[(f64, f64)] = &legendre::pairs::<8>();

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(coefficients: [f64; 2], cone: &Cone<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let (zero, one, split) = (R::splat(0.0), R::splat(1.0), R::splat(0.5));
    let (half, k, inverse) = (
        R::lift(cone.half),
        R::lift(cone.slope),
        R::lift(cone.upright),
    );
    let a = R::lift(cone.middle) + k * x;
    let lean = a * inverse;
    let shift = k * lean;
    let reach2 = (lean * lean - (y * y + z * z) * inverse).max(zero);
    let reach = reach2.sqrt();
    let (t0, t1) = (-half - x - shift, half - x - shift);
    let (low, high) = (t0.max(-reach), t1.min(reach));
    // The whole segment's length is known better than as a difference.
    let whole = R::both((-reach).lt(t0), t1.lt(reach));
    let middle = R::select(whole, -x - shift, split * (low + high));
    let part = R::select(whole, half, (split * (high - low)).max(zero));
    let [c2, c3] = coefficients.map(R::splat);
    let [d2, d3] = [2.0 * coefficients[0], 3.0 * coefficients[1]].map(R::splat);
    let upright = one - k * k;
    let (mut value, mut along, mut slope) = (zero, zero, zero);
    for &(node, weight) in legendre::choose::<R>(SINGLE, DOUBLE) {
        for node in [-node, node] {
            let t = middle + part * R::splat(node);
            let u = t + shift;
            // Where nothing is within the support a node may be anywhere.
            let over = one / (a + k * u).max(split);
            let over2 = over * over;
            let v = (reach2 - t * t).max(zero) * (upright * over2);
            let weighted = R::splat(weight) * over * v;
            let by_v = weighted * over2 * (d2 + d3 * v);
            value = value + weighted * v * (c2 + c3 * v);
            slope = slope + by_v;
            along = along + u * by_v;
        }
    }
    let scale = R::lift(cone.scales[0]) * part;
    let double = scale + scale;
    let across = -double * slope;
    Jet {
        value: scale * value,
        gradient: [double * along, across * y, across * z],
    }
}
