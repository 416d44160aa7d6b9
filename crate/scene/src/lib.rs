//! What a picture is, as plain data.
//!
//! A [`Scene`] is a list of [`Element`]s (shapes made of a [`Material`]), lights, a camera and
//! settings. The language (`rats`) writes it; the tracer, the draft and the mesher read it. It
//! knows nothing of text, pixels or GPUs. Two things are computed here because every reader needs
//! them and must agree on them: the projection ([`Camera`]), and which elements are *soft*, that
//! is, parts of the convolution surface, with which kernel constants ([`soft`]).

pub mod camera;
pub mod element;
pub mod light;
pub mod limbs;
pub mod material;
pub mod parts;
pub mod quadric;
pub mod settings;
pub mod soft;
pub mod wire;

pub use camera::{Camera, Projection};
pub use element::{Element, Origin, Shape};
pub use light::{Light, LightKind};
pub use material::Material;
pub use quadric::Quadric;
pub use settings::{Digger, Fragile, Settings};
pub use soft::SoftSurface;

use serde::{Deserialize, Serialize};

/// A linear colour, red, green, blue; 0 is none and 1 the full light. Values above 1 are allowed.
pub type Rgb = [f32; 3];

/// Everything a renderer needs to draw one picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The shapes, in the order of the text.
    pub elements: Vec<Element>,
    /// Materials; [`Element::material`] indexes this list.
    pub materials: Vec<Material>,
    /// Light sources. A scene without any is lit by ambient light only.
    pub lights: Vec<Light>,
    /// Colour of a ray that meets nothing.
    pub background: Rgb,
    /// From where the scene is seen.
    pub camera: Camera,
    /// Options that steer modelling and rendering.
    pub settings: Settings,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            elements: Vec::new(),
            materials: vec![Material::default()],
            lights: Vec::new(),
            background: DEFAULT_BACKGROUND,
            camera: Camera::default(),
            settings: Settings::default(),
        }
    }
}

/// The background of a text that sets none: a dark slate on which bright and dark flesh both read.
pub const DEFAULT_BACKGROUND: Rgb = [0.055, 0.07, 0.10];
