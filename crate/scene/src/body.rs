//! Bodies, within which soft elements blend, and the frames of objects.

use glam::DAffine3;
use serde::{Deserialize, Serialize};

/// Group of elements that blend with one another and with no element of another body.
///
/// Each body has a surface of its own, the iso-surface of the sum of its soft elements; where
/// bodies overlap, the nearer surface is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// The name in the text; empty for the elements that stand in no `body`.
    pub name: String,
}

/// The coordinates that a shape was written in: those of its object before any transform.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Map from the object's coordinates to the world's.
    pub to_world: DAffine3,
    /// The factor from lengths of the object to lengths of the world: where the three axes are
    /// scaled differently, the mean. Radii and [`Flesh`](crate::Flesh) grow by it.
    pub growth: f64,
}

impl Frame {
    /// The world's own frame.
    pub const WORLD: Self = Self {
        to_world: DAffine3::IDENTITY,
        growth: 1.0,
    };
}

impl Default for Frame {
    fn default() -> Self {
        Self::WORLD
    }
}
