//! Light sources.

use crate::Rgb;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// One light source. Its brightness does not fall with distance, as in the published datasets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Where the light comes from.
    pub kind: LightKind,
    /// Colour times intensity.
    pub colour: Rgb,
    /// Whether things in the way stop the light (`noshadow` clears it).
    pub shadow: bool,
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
}
