//! Light sources.

use crate::Rgb;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Light source. Its brightness does not fall with distance, as in the published datasets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Geometry of the source.
    pub kind: LightKind,
    /// Colour times intensity.
    pub colour: Rgb,
    /// Whether things in the way stop the light (`noshadow` clears it).
    pub shadow: bool,
    /// Radius of the source, which has soft shadows with
    /// [`Settings::penumbra`](crate::Settings::penumbra). Of a [`LightKind::Distant`] one, the
    /// radius at the distance 1: the tangent of half the angle under which it is seen.
    pub size: f64,
}

impl Light {
    /// Returns a light that casts shadows and has no size.
    #[must_use]
    pub fn new(kind: LightKind, colour: Rgb) -> Self {
        Self {
            kind,
            colour,
            shadow: true,
            size: 0.0,
        }
    }

    /// The share of the light's brightness, 0 to 1, that it sends to a point: less than 1 only for
    /// [`LightKind::Spot`], where it is 1 up to `angle − edge` from the axis and 0 from `angle` on;
    /// between them it falls as `3s² − 2s³` with the angle.
    ///
    /// ```
    /// use glam::DVec3;
    /// use scene::{Light, LightKind};
    /// let (position, direction) = (DVec3::ZERO, DVec3::Z);
    /// let spot = LightKind::Spot { position, direction, angle: 60.0, edge: 30.0 };
    /// let light = Light::new(spot, [1.0; 3]);
    /// let half = DVec3::new(1.0, 0.0, 1.0); // 45° off the axis
    /// assert!((light.share(half) - 0.5).abs() < 1e-12);
    /// assert_eq!(light.share(DVec3::X), 0.0);
    /// ```
    #[must_use]
    pub fn share(&self, point: DVec3) -> f64 {
        let LightKind::Spot {
            position,
            direction,
            angle,
            edge,
            ..
        } = self.kind
        else {
            return 1.0;
        };
        let Some(way) = (point - position).try_normalize() else {
            return 1.0;
        };
        let off = libm::acos(way.dot(direction).clamp(-1.0, 1.0)).to_degrees();
        if off >= angle {
            return 0.0;
        }
        if edge > 0.0 {
            let s = ((angle - off) / edge).min(1.0);
            s * s * (3.0 - 2.0 * s)
        } else {
            1.0
        }
    }
}

/// The geometry of a light source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LightKind {
    /// Shines from a point in all directions.
    Point {
        /// The point.
        position: DVec3,
    },
    /// Shines from infinity: parallel rays.
    Distant {
        /// Unit vector from the scene towards the light.
        towards: DVec3,
    },
    /// Shines from a point into a cone.
    Spot {
        /// The point.
        position: DVec3,
        /// Unit vector along the cone's axis, away from the point.
        direction: DVec3,
        /// Angle from the axis beyond which there is no light, degrees, in (0, 180].
        angle: f64,
        /// Angle over which the light fades towards that limit, degrees, in [0, `angle`]. 0: a
        /// sharp edge.
        edge: f64,
    },
}
