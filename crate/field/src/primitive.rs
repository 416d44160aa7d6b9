//! A skeletal element with its kernel: one term of the field.
use crate::{Kernel, Profile, Real, Shaping, Skeleton};
use glam::DVec3;

/// A value and its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<R> {
    /// The value.
    pub value: R,
    /// Its derivatives along x, y and z.
    pub gradient: [R; 3],
}

/// One term of the field: a skeleton convolved with a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// The bone.
    pub skeleton: Skeleton,
    /// The kernel.
    pub kernel: Kernel,
    /// The kernel's width parameter s.
    pub width: f64,
    /// The factor on the whole: normalisation times strength.
    pub height: f64,
    /// Depth of influence: beyond this distance from the skeleton |f| < ε·T.
    pub influence: f64,
    /// The profile, if any.
    pub profile: Option<Profile>,
}

impl Primitive {
    /// `None` if the shaping gives no flesh (radius or blobbiness not positive and finite).
    #[must_use]
    pub fn new(skeleton: Skeleton, shaping: &Shaping, profile: Option<Profile>) -> Option<Self> {
        let _ = (skeleton, shaping, profile);
        todo!()
    }

    /// Value and gradient at a point.
    #[must_use]
    pub fn jet<R: Real>(&self, point: [R; 3]) -> Jet<R> {
        let _ = point;
        todo!()
    }

    /// Value alone.
    #[must_use]
    pub fn value<R: Real>(&self, point: [R; 3]) -> R {
        let _ = point;
        todo!()
    }

    /// The ray interval outside which the primitive is beyond its depth of influence:
    /// parameters t of `origin + t·direction`, conservative. `None` if the ray misses it.
    #[must_use]
    pub fn ray_interval(&self, origin: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let _ = (origin, direction);
        todo!()
    }

    /// A sphere (centre, radius) holding all points within the depth of influence; `None` for a plane.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        todo!()
    }

    /// An upper bound on |f| anywhere at `distance` or more from the skeleton.
    #[must_use]
    pub fn bound_at(&self, distance: f64) -> f64 {
        let _ = distance;
        todo!()
    }
}
