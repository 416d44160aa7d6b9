//! The camera of Foley et al. as far as the text has given it.

use glam::DVec3;
use std::ops::Range;

/// The settings of `cp`, `vpn` and `window`, in view coordinates.
#[derive(Clone, Debug, Default)]
pub struct ViewPlane {
    /// The centre of projection.
    pub cp: Option<DVec3>,
    /// The direction towards an eye that is infinitely far away, in place of a centre.
    pub parallel: Option<DVec3>,
    /// The normal of the view plane.
    pub normal: Option<DVec3>,
    /// The left, right, lower and upper edge.
    pub window: Option<[f64; 4]>,
    /// The place of the last of them.
    pub place: (usize, Range<usize>),
}

impl ViewPlane {
    /// Returns whether the text has given any of them.
    #[must_use]
    pub fn is_given(&self) -> bool {
        let has_eye = self.cp.is_some() || self.parallel.is_some();
        has_eye || self.normal.is_some() || self.window.is_some()
    }
}
