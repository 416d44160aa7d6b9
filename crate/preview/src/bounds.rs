//! How large a scene is, and where.

use crate::instance::Units;
use crate::solid::Solid;
use glam::DVec3;
use scene::Scene;

/// A sphere around everything in a scene that has an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its centre, world coordinates.
    pub center: DVec3,
    /// Its radius, > 0.
    pub radius: f64,
}

impl Bounds {
    /// The bounds of a scene's elements at the radius that counts. A scene without any, or with
    /// planes only, has the bounds of what its camera looks at.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let boxes = scene
            .elements
            .iter()
            .flat_map(|element| Solid::of(scene, element))
            .filter_map(|solid| solid.bounds());
        let sum = boxes.reduce(|(low, high), (a, b)| (low.min(a), high.max(b)));
        let camera = scene.camera;
        let seen = Self {
            center: camera.target,
            radius: 0.5 * camera.eye.distance(camera.target),
        };
        let around = sum.map(|(low, high)| Self {
            center: low.midpoint(high),
            radius: 0.5 * low.distance(high),
        });
        [around, Some(seen)]
            .into_iter()
            .flatten()
            .find(Self::usable)
            .unwrap_or(Self {
                center: DVec3::ZERO,
                radius: 1.0,
            })
    }

    fn usable(&self) -> bool {
        self.center.is_finite() && self.radius.is_normal() && self.radius < 1e150
    }

    pub(crate) fn units(self) -> Units {
        Units {
            center: self.center,
            radius: self.radius,
        }
    }
}
