//! From the user's radius, blobbiness and strength to a kernel's width and height.
use crate::{Kernel, Skeleton, THRESHOLD};
use core::f64::consts::PI;
use serde::{Deserialize, Serialize};

/// How a blobbiness B is read (`blobscale`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum BlobScale {
    /// Blinn's dimensionless B: `s² = |B|/R²`.
    #[default]
    Relative,
    /// `s² = |B|`, as the published cowrie and seahorse need.
    Absolute,
}

/// What the user says of a soft primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaping {
    /// The kernel.
    pub kernel: Kernel,
    /// Radius in isolation R.
    pub radius: f64,
    /// Blobbiness B; only its magnitude counts.
    pub blobbiness: f64,
    /// How `blobbiness` is read.
    pub blob_scale: BlobScale,
    /// Multiplies the field.
    pub strength: f64,
    /// ε of the depth of influence: the primitive is ignored where its field is below ε·T.
    pub influence: f64,
}

impl Shaping {
    /// The kernel's width parameter s (an inverse length), or `None` if radius or blobbiness are
    /// zero, negative (the radius), or not finite.
    #[must_use]
    pub fn width(&self) -> Option<f64> {
        let root = self.blobbiness.abs().sqrt();
        let width = match self.blob_scale {
            BlobScale::Relative => root / self.radius,
            BlobScale::Absolute => root,
        };
        let usable = |x: f64| x.is_finite() && x > 0.0;
        (usable(self.radius) && usable(width)).then_some(width)
    }

    /// The factor on the integral of the kernel over a skeleton of this kind (thesis, section
    /// 3.3.2): with it, a point, an infinite line and an infinite plane have `F = T` at the
    /// distance R, times the strength.
    ///
    /// It depends on the skeleton's dimension only, not on its size. So cutting a segment, an arc
    /// or a triangle in two changes nothing, which is what keeps joints free of bulges.
    #[must_use]
    pub fn height(&self, skeleton: &Skeleton) -> Option<f64> {
        let s = self.width()?;
        let sr = s * self.radius;
        let x = 1.0 + sr * sr;
        let field_at_radius = match skeleton.dimension() {
            0 => 1.0 / (x * x),
            1 => PI / (2.0 * s * x * x.sqrt()),
            _ => PI / (s * s * x),
        };
        let height = self.strength * THRESHOLD / field_at_radius;
        height.is_finite().then_some(height)
    }
}
