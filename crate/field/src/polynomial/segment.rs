//! Being written.
use crate::bone::Segment;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(_c: [f64; 2], _bone: &Segment<R::Scalar>, _p: [R; 3]) -> Jet<R> {
    Jet::zero()
}
