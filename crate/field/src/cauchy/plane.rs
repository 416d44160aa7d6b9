//! An infinite plane (thesis 2.24): `f = π/(1+z²)` at the height z above it.
use crate::{Jet, Real};
use core::f64::consts::PI;

/// The plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane;

impl Plane {
    /// Value and gradient at a local position.
    #[inline(always)]
    pub fn jet<R: Real>(&self, [_, _, z]: [R; 3]) -> Jet<R> {
        let one = R::splat(1.0);
        let i = one / (one + z * z);
        let zero = R::splat(0.0);
        Jet {
            value: R::splat(PI) * i,
            gradient: [zero, zero, R::splat(-2.0 * PI) * z * i * i],
        }
    }
}
