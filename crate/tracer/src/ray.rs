//! Rays.
use glam::DVec3;

/// Rays whose directions differ by more than this, or whose origins by more than this part of half
/// the scene's size, are not followed together.
const WIDEST: f64 = 0.15;

/// The points `origin + t·direction`, t > 0, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
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

    /// The point at parameter t.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
