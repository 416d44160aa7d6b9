//! A kernel on a bone. The formulas stand in the kernels' files; BENCHMARKS.md lists their costs
//! and worst errors in single precision.
use crate::bone::Bone;
use crate::{Jet, Kernel, Real};

/// A kernel on a bone, both in units of the kernel's width.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Form<S> {
    pub kernel: Kernel,
    pub bone: Bone<S>,
}

impl<S: Copy> Form<S> {
    /// Value and gradient at a local position, for a factor of 1.
    #[inline(always)]
    pub fn jet<R: Real<Scalar = S>>(&self, p: [R; 3]) -> Jet<R> {
        let horizon = R::splat(R::HORIZON);
        let p = p.map(|x| x.min(horizon).max(-horizon));
        self.kernel.jet(&self.bone, p)
    }

    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Form<Q> {
        Form {
            kernel: self.kernel,
            bone: self.bone.cast(f),
        }
    }
}
