//! Rays.
use glam::DVec3;

/// Largest difference of the directions of two rays that are followed together, and of their
/// origins in units of half the scene's size.
const WIDEST: f64 = 0.15;

/// The points `origin + t·direction`, t > 0, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at t = 0.
    pub origin: DVec3,
    /// A unit vector, so that t is a distance.
    pub direction: DVec3,
}

impl Ray {
    /// Whether a beam around the two rays is narrow enough to follow them together, in units of
    /// half the scene's size.
    pub(crate) fn runs_with(&self, other: &Self) -> bool {
        self.direction.distance(other.direction) <= WIDEST
            && self.origin.distance(other.origin) <= WIDEST
    }

    /// Returns the point at parameter t.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
