//! Being written.
use crate::bone::Arc;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(_c: [f64; 2], _bone: &Arc<R::Scalar>, _p: [R; 3]) -> Jet<R> {
    Jet::zero()
}
