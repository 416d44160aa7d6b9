//! Rays.
use glam::DVec3;

/// The points `origin + t·direction`, t > 0, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// A unit vector, so that t is a distance.
    pub direction: DVec3,
}

impl Ray {
    /// The point at parameter t.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
