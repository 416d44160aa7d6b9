//! An infinite plane (thesis 2.24): a function of the height z above it alone.
//!
//! `f(z) = π·∫_{z²}^∞ G(q) dq`, and so `f′ = −2πz·G(z²)`.
//!
//! The integrals of the inverse and the squared kernel diverge. There the plane counts only up to
//! [`WINDOW`] = 10 radii around the foot of the perpendicular, so that it is still the same
//! everywhere.
use crate::{Jet, Kernel, Real};
use core::f64::consts::PI;

/// Half-length, in radii, of the finite lines and planes that stand for infinite ones where those
/// have no finite field.
pub const WINDOW: f64 = 10.0;

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(kernel: Kernel, [_, _, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let (value, slope) = kernel.plane(z);
    Jet {
        value,
        gradient: [zero, zero, R::splat(-2.0 * PI) * z * slope],
    }
}
