//! Being written.
use crate::bone::Curve;
use crate::{Jet, Kernel, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(_kernel: Kernel, _bone: &Curve<R::Scalar>, _p: [R; 3]) -> Jet<R> {
    Jet::zero()
}
