//! Points: the kernel itself (thesis 2.20), `f = G(|p|²)`, `∇f = 2G′·p`.
use crate::{Jet, Kernel, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(kernel: Kernel, [x, y, z]: [R; 3]) -> Jet<R> {
    let (value, fall) = kernel.falling(x * x + y * y + z * z);
    let twice = R::splat(-2.0) * fall;
    Jet {
        value,
        gradient: [twice * x, twice * y, twice * z],
    }
}
