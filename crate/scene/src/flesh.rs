//! The softness of a shape: which kernel is convolved with its skeleton, how wide and how strong.

use field::{BlobScale, Kernel, Profile};
use serde::{Deserialize, Serialize};

/// Parameters of soft elements, in the lengths of the object that they stand in
/// ([`Frame::growth`](crate::Frame) brings them to the world's).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flesh {
    /// Radius in isolation R for elements whose own radius is overruled (`fragile`). 0: none.
    pub radius: f64,
    /// Radius at the other end of lines, arcs and curves, along which it varies evenly.
    pub end_radius: Option<f64>,
    /// Depth of influence from which the radius follows, in the place of a radius. 0: none.
    pub depth: f64,
    /// Blobbiness B, > 0; none is hard.
    pub blobbiness: Option<f64>,
    /// Blobbiness at the other end of lines, arcs and curves, > 0.
    pub end_blobbiness: Option<f64>,
    /// Factor on the field; negative values carve.
    pub strength: f64,
    /// Kernel, which overrules the [element's](crate::Element::kernel).
    pub kernel: Option<Kernel>,
    /// Profile (a texture whose target is `strength`), if any.
    pub profile: Option<Profile>,
    /// Share of a triangle's field that is taken away at its edges, 0 to 1.
    pub restriction: f64,
}

impl Flesh {
    /// Returns these parameters for a skeleton scaled by a factor: radii and depths grow with it,
    /// and an absolute blobbiness, which is a squared inverse width, shrinks.
    #[must_use]
    pub fn scaled(&self, factor: f64, blob_scale: BlobScale) -> Self {
        let mut flesh = self.clone();
        flesh.radius *= factor;
        flesh.depth *= factor;
        if let Some(radius) = &mut flesh.end_radius {
            *radius *= factor;
        }
        if blob_scale == BlobScale::Absolute {
            for blobbiness in [&mut flesh.blobbiness, &mut flesh.end_blobbiness] {
                *blobbiness = blobbiness.map(|b| b / (factor * factor));
            }
        }
        flesh
    }

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

    /// Whether elements with these parameters are part of a convolution surface.
    #[must_use]
    pub fn is_soft(&self) -> bool {
        self.blobbiness.is_some()
    }
}

impl Default for Flesh {
    /// Hard, of strength 1.
    fn default() -> Self {
        Self {
            radius: 0.0,
            end_radius: None,
            depth: 0.0,
            blobbiness: None,
            end_blobbiness: None,
            strength: 1.0,
            kernel: None,
            profile: None,
            restriction: 0.0,
        }
    }
}
