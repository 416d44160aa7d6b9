//! The chart: which formula serves which kernel on which bone.
//!
//! | | point | segment | arc | triangle, polygon | plane | curve |
//! |---|---|---|---|---|---|---|
//! | cauchy | closed | closed | closed | closed | closed | G–L |
//! | gauss | closed | closed (erf) | G–L | closed (Owen's T, by recurrence) | closed | G–L |
//! | inverse | closed | closed | elliptic (Carlson) | closed | closed, windowed | G–L |
//! | squared | closed | closed | closed | closed (Clausen) | closed, windowed | G–L |
//! | metaballs | closed | closed | closed, G–L outside | closed, G–L outside | closed | G–L |
//! | soft, quartic, compact6 | closed | closed (exact rule) | closed | closed | closed | G–L |
//! | cubed | closed | closed | elliptic (Carlson) | closed | closed | G–L |
//!
//! G–L: Gauss–Legendre integrals (*outside*: from u = ⅓ on), whose errors stand in the cells' own
//! files. BENCHMARKS.md lists each cell's cost and the worst error of single precision.
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
