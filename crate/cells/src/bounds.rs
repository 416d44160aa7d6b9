//! The ball around a scene.

use crate::solid::Solid;
use crate::units::Units;
use glam::DVec3;
use scene::{Element, Scene, Shape};

/// A sphere around everything in a scene that has an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The centre, world coordinates.
    pub center: DVec3,
    /// The radius, > 0.
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
            .flat_map(|element| boxes(scene, element));
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

    /// The least height of a scene's elements along a direction; of a scene without any that have
    /// an end, that of the middle of what its camera looks at.
    #[must_use]
    pub fn lowest(scene: &Scene, up: DVec3) -> f64 {
        let lows = scene
            .elements
            .iter()
            .flat_map(|element| boxes(scene, element))
            .map(|(low, high)| (low * up).min(high * up).element_sum());
        let lowest = lows.fold(f64::INFINITY, f64::min);
        if lowest.is_finite() {
            lowest
        } else {
            scene.camera.target.dot(up)
        }
    }

    fn usable(&self) -> bool {
        self.center.is_finite() && self.radius.is_normal() && self.radius < 1e150
    }

    /// Returns the map to draft units.
    #[must_use]
    pub fn units(self) -> Units {
        Units {
            center: self.center,
            radius: self.radius,
        }
    }
}

/// Axis-parallel boxes that hold an element, as the draft shows it.
fn boxes(scene: &Scene, element: &Element) -> Vec<(DVec3, DVec3)> {
    if let Shape::Quadric(quadric) = &element.shape {
        // The box that cuts it off, without looking where in it the surface is.
        let [x, y, z] = quadric.axes.map(DVec3::abs);
        let corners = [1.0, -1.0].map(|side| quadric.center - side * (x + y + z));
        let is_there = quadric.is_surface();
        return is_there.then_some(corners.into()).into_iter().collect();
    }
    let solids = Solid::of(scene, element, 0);
    solids.iter().filter_map(Solid::bounds).collect()
}
