//! A point: the kernel itself (thesis 2.20), `f = G(|p|²)`, `∇f = 2G′·p`.
use crate::{Jet, Kernel, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(kernel: Kernel, [x, y, z]: [R; 3]) -> Jet<R> {
    let (value, slope) = kernel.pair(x * x + y * y + z * z);
    let twice = slope + slope;
    Jet {
        value,
        gradient: [twice * x, twice * y, twice * z],
    }
}
