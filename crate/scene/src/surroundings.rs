//! Surroundings of the shapes: background, sky, ground, fog and clouds of light; and the lens that
//! they are seen through.

use crate::Rgb;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Light that a ray gets which meets nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Background {
    /// Constant colour.
    Colour(Rgb),
    /// Colours from above to below, evenly spaced; at least one. They change over directions
    /// between 30° above the horizon and 30° below it, evenly in the sine of that angle.
    Gradient(Vec<Rgb>),
    /// An image around the scene, by its index in [`Scene::images`](crate::Scene::images): the
    /// whole way round across (its middle towards −z if y is up), from straight up to straight
    /// down.
    Image(u32),
}

impl Background {
    /// Returns a colour that stands for the whole: the constant colour, the mean of a gradient's,
    /// or grey for an image, which is not looked at here.
    #[must_use]
    pub fn mean(&self) -> Rgb {
        match self {
            Self::Colour(colour) => *colour,
            Self::Gradient(colours) => {
                let count = colours.len().max(1) as f32;
                [0, 1, 2].map(|i| colours.iter().map(|colour| colour[i]).sum::<f32>() / count)
            }
            Self::Image(_) => [0.5; 3],
        }
    }
}

impl Default for Background {
    fn default() -> Self {
        Self::Colour(crate::DEFAULT_BACKGROUND)
    }
}

impl From<Rgb> for Background {
    fn from(colour: Rgb) -> Self {
        Self::Colour(colour)
    }
}

/// Light that comes from everywhere above, except where something is in the way.
///
/// A surface gets the mean of the sky over the directions of its half space that are free, weighted
/// by their cosine to the normal, times its diffuse colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sky {
    /// Light from straight above, times an intensity.
    pub colour: Rgb,
    /// Light from the horizon and from below. Between them it changes evenly with the sine of the
    /// height.
    pub horizon: Rgb,
    /// Directions per sample of a pixel, 1 … [`Sky::MAX_SAMPLES`].
    pub samples: u32,
}

impl Sky {
    /// Most directions per sample.
    pub const MAX_SAMPLES: u32 = 64;
}

/// Plane across the [`Scene::up`](crate::Scene::up) direction that is there to receive shadows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ground {
    /// Diffuse colour.
    pub colour: Rgb,
    /// Height along [`Scene::up`](crate::Scene::up); `None`: just below everything else.
    pub height: Option<f64>,
}

/// Air that swallows light and glows in its own colour: from the distance d, the share
/// `e^(−d/distance)` of the light arrives (see [`texture::fog`]).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fog {
    /// The fog's own colour.
    pub colour: Rgb,
    /// Distance over which light falls by 1/e, > 0; of fog with a height, at height 0.
    pub distance: f64,
    /// Height over which the fog's density falls by 1/e, > 0, upwards from 0 along
    /// [`Scene::up`](crate::Scene::up). `None`: it is equally dense everywhere.
    pub height: Option<f64>,
}

/// Glowing ball of mist, without a surface; it casts no shadow and hides nothing.
///
/// Its density at the distance r from its middle is `density·(1 − (r/radius)²)²`; a ray gets the
/// integral of the density along its way, in units of the radius, times the colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cloud {
    /// Colour times intensity.
    pub colour: Rgb,
    /// Middle.
    pub position: DVec3,
    /// Radius beyond which there is none of it, > 0.
    pub radius: f64,
    /// Density in its middle, ≥ 0; 1 by default.
    pub density: f64,
}

/// The lens and the shutter of the [`Camera`](crate::Camera), which makes rays as through a
/// pinhole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lens {
    /// Radius of the lens, ≥ 0; 0 is a pinhole.
    pub aperture: f64,
    /// Distance of the plane that is sharp, > 0; `None` for the distance of the camera's target.
    pub focus: Option<f64>,
}
