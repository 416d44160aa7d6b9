//! Draft units, in which a scene's middle is the origin and its radius 1.

use glam::DVec3;

/// The map from world coordinates to draft units: the scene's middle is the origin, its radius 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// The middle, in world coordinates.
    pub center: DVec3,
    /// The radius, > 0.
    pub radius: f64,
}

impl Units {
    /// The farthest that anything can be from the scene's middle, in its radii: squares of such
    /// distances are still `f32`s.
    const FARTHEST: f64 = 1e15;

    /// Returns a world position in draft units.
    #[must_use]
    pub fn place(self, world: DVec3) -> [f32; 3] {
        let place = ((world - self.center) / self.radius)
            .clamp(DVec3::splat(-Self::FARTHEST), DVec3::splat(Self::FARTHEST));
        place.as_vec3().to_array()
    }
}
