//! The look of a surface: Phong's model, mirrors, glass, and textures.

use crate::Rgb;
use serde::{Deserialize, Serialize};
use texture::Texture;

/// The look of a material, made by the command `surface` (or its synonym `material`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finish {
    /// The material's alias in the text.
    pub name: String,
    /// Light given off whatever the lights do. Default: [`Finish::AMBIENT_SHARE`] of `diffuse`.
    pub ambient: Rgb,
    /// Share of a light's colour scattered evenly.
    pub diffuse: Rgb,
    /// Share of a light's colour in the highlight.
    pub specular: Rgb,
    /// Phong's exponent; the larger, the smaller the highlight. ≥ 0.
    pub shine: f32,
    /// Share of the light from the mirrored direction.
    pub reflective: Rgb,
    /// Share of the light from the refracted direction, and of the light that passes on its way
    /// from a source.
    pub transparent: Rgb,
    /// Index of refraction of the inside, the outside being air: > 0.
    pub index: f32,
    /// Dispersion: blue's index less red's (see [`texture::refraction::dispersed`]).
    pub dispersion: f32,
    /// Kinds of rays to which surfaces of this look are not there.
    pub skip: Skip,
    /// Layers of texture, the first one at the bottom; at most [`texture::MAX_LAYERS`]. Their
    /// images are indices into [`Scene::images`](crate::Scene::images).
    pub layers: Vec<Texture>,
}

/// `skip RAYTYPE…`: the kinds of rays that pass a surface as if it were not there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Skip {
    /// Rays from the eye.
    pub pixel: bool,
    /// Rays to the lights and to the sky.
    pub shadow: bool,
    /// Reflected rays.
    pub reflected: bool,
    /// Refracted rays.
    pub transmitted: bool,
}

impl Finish {
    /// The share of the diffuse colour that a material glows with when the text gives no `ambient`.
    pub const AMBIENT_SHARE: f32 = 0.15;
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            name: String::from("default"),
            ambient: [0.8 * Self::AMBIENT_SHARE; 3],
            diffuse: [0.8; 3],
            specular: [0.0; 3],
            shine: 0.0,
            reflective: [0.0; 3],
            transparent: [0.0; 3],
            index: 1.0,
            dispersion: 0.0,
            skip: Skip::default(),
            layers: Vec::new(),
        }
    }
}
