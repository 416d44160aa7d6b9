//! A kernel on a bone. Which formula serves it stands in the kernel's file; BENCHMARKS.md lists each
//! one's cost and the worst error of single precision.
use crate::bone::Bone;
use crate::{Jet, Kernel, Real, plane, point};

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
        match &self.bone {
            Bone::Point => point::jet(self.kernel, p),
            Bone::Segment(bone) => self.kernel.segment(bone, p),
            Bone::Arc(bone) => self.kernel.arc(bone, p),
            Bone::Triangle(bone) => self.kernel.triangle(bone, p),
            Bone::Polygon(bone) => self.kernel.polygon(bone, p),
            Bone::Plane => plane::jet(self.kernel, p),
            Bone::Curve(bone) => self.kernel.curve(bone, p),
        }
    }

    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Form<Q> {
        Form {
            kernel: self.kernel,
            bone: self.bone.cast(f),
        }
    }
}
