//! Scenes: the description of a picture as plain data.
//!
//! A [`Scene`] is a list of [`Element`]s, lights, a camera and settings. An element is a [`Shape`] with a [`Finish`]
//! (its colours) and, if it is soft, a [`Flesh`] (its kernel). Soft elements blend within their [`Body`] and never
//! across bodies. The language (`rats`) writes scenes; the tracer and the draft read them. This room
//! does not depend on text, pixels or GPUs. Two things are computed here because all readers must agree
//! on them: the projection ([`Camera`]), and the function of each body ([`surface`]).
//!
//! ```
//! use glam::DVec3;
//! use scene::{Element, Flesh, Scene, Shape};
//!
//! let mut scene = Scene::default();
//! scene.flesh.push(Flesh { blobbiness: -2.0, ..Flesh::default() });
//! let center = DVec3::ZERO;
//! scene.elements.push(Element {
//!     flesh: Some(0),
//!     ..Element::new(Shape::Sphere { center, radius: 1.0 })
//! });
//! let surfaces = scene.surfaces();
//! assert!(surfaces[0].function().jet(center).value > field::THRESHOLD);
//! ```

pub mod body;
pub mod camera;
pub mod element;
pub mod finish;
pub mod flesh;
pub mod function;
pub mod light;
pub mod limbs;
pub mod parts;
pub mod quadric;
pub mod settings;
pub mod soft;
pub mod surface;

pub use body::{Body, Frame};
pub use camera::{Camera, Projection};
pub use element::{Element, Origin, Shape};
pub use finish::Finish;
pub use flesh::Flesh;
pub use function::{Form, Function};
pub use light::{Light, LightKind};
pub use quadric::Quadric;
pub use settings::{Digger, Fragile, Settings};
pub use soft::SoftSurface;
pub use surface::{ComposedSurface, Surface};

use serde::{Deserialize, Serialize};

/// A linear colour, red, green, blue; 0 is none and 1 the full light. Values above 1 are allowed.
pub type Rgb = [f32; 3];

/// Everything a renderer needs to draw one picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The shapes, in the order of the text.
    pub elements: Vec<Element>,
    /// Bodies; [`Element::body`] indexes this list. The first is the body without a name.
    pub bodies: Vec<Body>,
    /// Softness; [`Element::flesh`] indexes this list.
    pub flesh: Vec<Flesh>,
    /// Looks; [`Element::finish`] indexes this list.
    pub finishes: Vec<Finish>,
    /// Frames of objects; [`Element::frame`] indexes this list. The first is the world's.
    pub frames: Vec<Frame>,
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
            bodies: vec![Body::default()],
            flesh: Vec::new(),
            finishes: vec![Finish::default()],
            frames: vec![Frame::WORLD],
            lights: Vec::new(),
            background: DEFAULT_BACKGROUND,
            camera: Camera::default(),
            settings: Settings::default(),
        }
    }
}

/// The background of a text that sets none: a dark slate on which bright and dark flesh both read.
pub const DEFAULT_BACKGROUND: Rgb = [0.055, 0.07, 0.10];
