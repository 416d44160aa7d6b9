//! Kernels' widths and heights from the user's radius, blobbiness and strength.
use crate::{Kernel, Skeleton, THRESHOLD};
use serde::{Deserialize, Serialize};

/// Ways to read a blobbiness B (`blobscale`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum BlobScale {
    /// Blinn's dimensionless B: `s² = |B|/R²`.
    #[default]
    Relative,
    /// `s² = |B|`, as the published cowrie and seahorse need.
    Absolute,
}

/// Radius and blobbiness at the far end of a segment, an arc or a curve. Along it radius R and
/// blobbiness B vary linearly with length; other skeletons ignore it.
///
/// At every place q of the bone the kernel has the width s and the height that a uniform bone of
/// that R and B has (thesis, section 3.3.2): `f(p) = ∫ height·h(s·|p−q|) dq`. For a constant B both
/// go with 1/R, which is the scale-invariant integral of SCALIS (Zanni et al. 2013): of a figure
/// magnified with its radii, the field at magnified places is the same. A slender cone so has the
/// radius R(q) all along.
///
/// The inverse kernel's field, height·h = const/r, does not depend on R at all (its line has the
/// radius that its length gives it), so that a taper changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// Radius in isolation there. One that is smaller than [`SLIMMEST`] of the larger end's, 0 for
    /// example, is taken to be that, so that the field at a tip is finite.
    pub radius: f64,
    /// Blobbiness there, > 0.
    pub blobbiness: f64,
}

/// The smallest radius of a tapered bone's thin end, as a part of its thick end's.
pub const SLIMMEST: f64 = 1e-3;

/// The user's parameters of a soft primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaping {
    /// The kernel.
    pub kernel: Kernel,
    /// Radius in isolation R.
    pub radius: f64,
    /// Blobbiness B, > 0.
    pub blobbiness: f64,
    /// Way to read `blobbiness`.
    pub blob_scale: BlobScale,
    /// Multiplies the field.
    pub strength: f64,
    /// ε of the depth of influence: the primitive is ignored where its field is below ε·T.
    pub influence: f64,
    /// Radius and blobbiness at the far end, if they differ.
    pub taper: Option<Taper>,
}

impl Shaping {
    /// Whether a skeleton with this shaping has a different kernel at every place.
    #[must_use]
    pub fn varies_along(&self, skeleton: &Skeleton) -> bool {
        let differs = self
            .taper
            .is_some_and(|end| end.radius != self.radius || end.blobbiness != self.blobbiness);
        differs && skeleton.dimension() == 1
    }

    /// Whether a tapered bone is one term that is evaluated at once, however long it is: a segment
    /// of a compact polynomial kernel, whose support is a slender cone.
    #[must_use]
    pub fn is_cone(&self, skeleton: &Skeleton) -> bool {
        let (Some(end), Skeleton::Segment { base, apex }) = (self.taper, skeleton) else {
            return false;
        };
        let is_even = self.blob_scale == BlobScale::Relative && end.blobbiness == self.blobbiness;
        let is_compact = self.kernel.is_compact() && self.kernel.has_cones();
        let [first, last] = [0.0, 1.0].map(|at| self.at(at).width().map(|width| 1.0 / width));
        let (Some(first), Some(last)) = (first, last) else {
            return false;
        };
        let steepest = crate::kernel::polynomial::cone::STEEPEST * base.distance(*apex);
        is_even && is_compact && (last - first).abs() <= steepest
    }

    /// Returns the shaping at a fraction of a tapered bone's length.
    #[must_use]
    pub fn at(&self, fraction: f64) -> Self {
        let Some(end) = self.taper else {
            return *self;
        };
        let mix = |a: f64, b: f64| a + (b - a) * fraction;
        let slim = |radius: f64| {
            // A negative radius stays, so that it is rejected as a mistake.
            if radius >= 0.0 {
                radius.max(SLIMMEST * self.radius.max(end.radius))
            } else {
                radius
            }
        };
        Self {
            radius: mix(slim(self.radius), slim(end.radius)),
            blobbiness: mix(self.blobbiness, end.blobbiness),
            taper: None,
            ..*self
        }
    }

    /// Estimates a bone's length in kernel widths, by the geometric mean of the width parameters at
    /// its ends, as most of a taper is thicker than its tip.
    #[must_use]
    pub fn widths_along(&self, length: f64) -> f64 {
        let [start, end] = [0.0, 1.0].map(|at| self.at(at).width().unwrap_or(0.0));
        length * (start * end).sqrt()
    }

    /// Returns the blobbiness |B| in Blinn's dimensionless sense, `|B|·R²` if it was given
    /// absolutely.
    fn relative(&self) -> f64 {
        let b = self.blobbiness;
        match self.blob_scale {
            BlobScale::Relative => b,
            BlobScale::Absolute => b * self.radius * self.radius,
        }
    }

    /// The kernel's width parameter, an inverse length: distances times it are the kernel's u
    /// (fields.md, section 4). `None` if radius or blobbiness are zero, negative, or
    /// not finite.
    ///
    /// Cauchy and Gauss `√|B|/R`. Compact kernels have the depth 1/s at which their logarithmic
    /// slope at R is Blinn's, `−2|B|`. Kernels with a pole have no width: 1/R, whatever B is. The
    /// formulas stand in the kernels' files.
    #[must_use]
    pub fn width(&self) -> Option<f64> {
        let b = self.relative();
        let width = self.kernel.width(b) / self.radius;
        let usable = |x: f64| x.is_finite() && x > 0.0;
        (usable(self.radius) && b.is_finite() && b >= 0.0 && usable(width)).then_some(width)
    }

    /// The factor on the integral of the kernel over a skeleton of this kind (thesis, section
    /// 3.3.2): with it, a point, an infinite line and an infinite plane have `F = T` at the
    /// distance R, times the strength. Where infinite ones have no finite field (inverse lines,
    /// inverse and squared planes), finite ones of half-length 10·R stand for them.
    ///
    /// Of the cubed kernel 1/d³ that is R³ for points, R²/2 for lines and R/2π for planes, in units
    /// of length.
    ///
    /// It depends on the skeleton's dimension only, not on its size. So cutting a segment, an arc
    /// or a triangle in two changes nothing, so that joints are free of bulges.
    #[must_use]
    pub fn height(&self, skeleton: &Skeleton) -> Option<f64> {
        let s = self.width()?;
        let x = s * self.radius;
        let field_at_radius = match skeleton.dimension() {
            0 => self.kernel.value(x),
            1 => self.kernel.line(x) / s,
            _ => self.kernel.plane(x).0 / (s * s),
        };
        let height = self.strength * THRESHOLD / field_at_radius;
        height.is_finite().then_some(height)
    }

    /// The radius R at which a point, an infinite line or an infinite plane (`dimension` 0, 1, 2)
    /// with this blobbiness has the depth of influence `depth`: a compact kernel's support, or
    /// where the field of an infinite kernel has fallen to `influence·T`. `None` if there is none.
    #[must_use]
    pub fn radius_of_depth(&self, depth: f64, dimension: u8) -> Option<f64> {
        let kernel = self.kernel;
        let reference = |u: f64| match dimension {
            0 => kernel.value(u),
            1 => kernel.line(u),
            _ => kernel.plane(u).0,
        };
        let field_at = |radius: f64| {
            let shaping = Self { radius, ..*self };
            let s = shaping.width()?;
            if kernel.is_compact() {
                // Grows with the radius, and is 1 where the support is `depth`.
                return Some(1.0 / (s * depth));
            }
            Some(reference(s * depth) / reference(s * radius) / self.influence)
        };
        if !(depth.is_finite() && depth > 0.0 && self.influence > 0.0) {
            return None;
        }
        // The field at the depth grows with the radius: bisection.
        let (mut low, mut high) = (0.0, depth);
        for _ in 0..56 {
            let middle = 0.5 * (low + high);
            if field_at(middle).is_none_or(|f| f < 1.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        field_at(high)
            .is_some_and(|f| f >= 1.0 - 1e-9)
            .then_some(high)
    }
}
