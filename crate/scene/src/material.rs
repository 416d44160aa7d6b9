//! What a shape is made of: colours for Phong's model, and the softness of its flesh.

use crate::Rgb;
use field::{BlobScale, Kernel, Profile};
use serde::{Deserialize, Serialize};

/// A material, made by the command `surface` (or its synonym `material`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The alias that the text uses.
    pub name: String,
    /// Light given off whatever the lights do. Default: [`Material::AMBIENT_SHARE`] of `diffuse`.
    pub ambient: Rgb,
    /// Share of a light's colour scattered evenly.
    pub diffuse: Rgb,
    /// Share of a light's colour in the highlight.
    pub specular: Rgb,
    /// Phong's exponent; the larger, the smaller the highlight. ≥ 0.
    pub shine: f32,
    /// Radius in isolation R for soft elements whose own radius is overruled (`fragile`). 0: none.
    pub radius: f64,
    /// Radius at the other end of lines, arcs and curves, along which it varies evenly.
    pub end_radius: Option<f64>,
    /// Depth of influence from which the radius follows, in the place of a radius. 0: none.
    pub depth: f64,
    /// Blobbiness B (its magnitude counts; the datasets write it negative). 0 makes the material hard.
    pub blobbiness: f64,
    /// Blobbiness at the other end of lines, arcs and curves.
    pub end_blobbiness: Option<f64>,
    /// Multiplies the field; negative values carve.
    pub strength: f64,
    /// Kernel of the soft elements, if the material names one.
    pub kernel: Option<Kernel>,
    /// Profile (a texture whose target is `strength`), if any.
    pub profile: Option<Profile>,
    /// How much of a triangle's field is taken away at its edges, 0 to 1.
    pub restriction: f64,
}

impl Material {
    /// Makes the flesh fit for bones scaled by a factor: radii and depths grow with them, and an
    /// absolute blobbiness, a squared width, shrinks.
    pub fn scale(&mut self, factor: f64, blob_scale: BlobScale) {
        self.radius *= factor;
        self.depth *= factor;
        if let Some(radius) = &mut self.end_radius {
            *radius *= factor;
        }
        if blob_scale == BlobScale::Absolute {
            self.blobbiness /= factor * factor;
            if let Some(blobbiness) = &mut self.end_blobbiness {
                *blobbiness /= factor * factor;
            }
        }
    }

    /// The share of the diffuse colour that a material glows with when the text gives no `ambient`.
    pub const AMBIENT_SHARE: f32 = 0.15;

    /// The profile with the restriction in it.
    #[must_use]
    pub fn whole_profile(&self) -> Option<Profile> {
        if self.restriction == 0.0 {
            return self.profile;
        }
        Some(Profile {
            restriction: self.restriction,
            ..self.profile.unwrap_or_default()
        })
    }

    /// Whether elements of this material become part of the convolution surface.
    #[must_use]
    pub fn is_soft(&self) -> bool {
        self.blobbiness != 0.0
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::from("default"),
            ambient: [0.8 * Self::AMBIENT_SHARE; 3],
            diffuse: [0.8; 3],
            specular: [0.0; 3],
            shine: 0.0,
            radius: 0.0,
            end_radius: None,
            depth: 0.0,
            blobbiness: 0.0,
            end_blobbiness: None,
            strength: 1.0,
            kernel: None,
            profile: None,
            restriction: 0.0,
        }
    }
}
