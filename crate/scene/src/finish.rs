//! The look of a surface: colours for Phong's model.

use crate::Rgb;
use serde::{Deserialize, Serialize};

/// The colours of a material, made by the command `surface` (or its synonym `material`).
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
        }
    }
}
