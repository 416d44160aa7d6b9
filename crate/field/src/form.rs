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
use crate::{
    Jet, Kernel, Real, cauchy, cubed, curve, gauss, inverse, metaballs, plane, point, polynomial,
    squared,
};

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
        match (self.kernel, &self.bone) {
            (kernel, Bone::Point) => point::jet(kernel, p),
            (kernel, Bone::Plane) => plane::jet(kernel, p),
            (kernel, Bone::Curve(bone)) => curve::jet(kernel, bone, p),
            (Kernel::Cauchy, Bone::Segment(bone)) => cauchy::segment::jet(bone, p),
            (Kernel::Cauchy, Bone::Arc(bone)) => cauchy::arc::jet(bone, p),
            (Kernel::Cauchy, Bone::Triangle(bone)) => cauchy::triangle::jet(bone, p),
            (Kernel::Cauchy, Bone::Polygon(bone)) => cauchy::polygon::jet(bone, p),
            (Kernel::Gauss, Bone::Segment(bone)) => gauss::segment::jet(bone, p),
            (Kernel::Gauss, Bone::Arc(bone)) => gauss::arc::jet(bone, p),
            (Kernel::Gauss, Bone::Triangle(bone)) => gauss::polygon::jet(&bone.edges, p),
            (Kernel::Gauss, Bone::Polygon(bone)) => gauss::polygon::jet(&bone.edges, p),
            (Kernel::Inverse, Bone::Segment(bone)) => inverse::segment::jet(bone, p),
            (Kernel::Inverse, Bone::Arc(bone)) => inverse::arc::jet(bone, p),
            (Kernel::Inverse, Bone::Triangle(bone)) => inverse::polygon::triangle(bone, p),
            (Kernel::Inverse, Bone::Polygon(bone)) => inverse::polygon::jet(bone, p),
            (Kernel::Squared, Bone::Segment(bone)) => squared::segment::jet(bone, p),
            (Kernel::Squared, Bone::Arc(bone)) => squared::arc::jet(bone, p),
            (Kernel::Squared, Bone::Triangle(bone)) => squared::polygon::triangle(bone, p),
            (Kernel::Squared, Bone::Polygon(bone)) => squared::polygon::jet(bone, p),
            (Kernel::Cubed, Bone::Segment(bone)) => cubed::segment::jet(bone, p),
            (Kernel::Cubed, Bone::Arc(bone)) => cubed::arc::jet(bone, p),
            (Kernel::Cubed, Bone::Triangle(bone)) => cubed::polygon::triangle(bone, p),
            (Kernel::Cubed, Bone::Polygon(bone)) => cubed::polygon::jet(bone, p),
            (Kernel::Metaballs, Bone::Segment(bone)) => metaballs::segment::jet(bone, p),
            (Kernel::Metaballs, Bone::Arc(bone)) => metaballs::arc::jet(bone, p),
            (Kernel::Metaballs, Bone::Triangle(bone)) => metaballs::polygon::jet(&bone.edges, p),
            (Kernel::Metaballs, Bone::Polygon(bone)) => metaballs::polygon::jet(&bone.edges, p),
            (Kernel::Soft | Kernel::Quartic | Kernel::Compact6, bone) => {
                let coefficients = self.kernel.polynomial().unwrap_or_default();
                match bone {
                    Bone::Segment(bone) => polynomial::segment::jet(coefficients, bone, p),
                    Bone::Arc(bone) => polynomial::arc::jet(coefficients, bone, p),
                    Bone::Triangle(bone) => polynomial::polygon::jet(coefficients, &bone.edges, p),
                    Bone::Polygon(bone) => polynomial::polygon::jet(coefficients, &bone.edges, p),
                    Bone::Point | Bone::Plane | Bone::Curve(_) => point::jet(self.kernel, p),
                }
            }
        }
    }

    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Form<Q> {
        Form {
            kernel: self.kernel,
            bone: self.bone.cast(f),
        }
    }
}
