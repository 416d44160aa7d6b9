//! A point (thesis 2.20): the kernel itself, `f = 1/(1+|x|²)²`.
use crate::{Jet, Real};

/// A point at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point;

impl Point {
    /// Value and gradient at a local position.
    #[inline(always)]
    pub fn jet<R: Real>(&self, [x, y, z]: [R; 3]) -> Jet<R> {
        let one = R::splat(1.0);
        let i = one / (one + x * x + y * y + z * z);
        let value = i * i;
        let slope = R::splat(-4.0) * value * i;
        Jet {
            value,
            gradient: [slope * x, slope * y, slope * z],
        }
    }
}
