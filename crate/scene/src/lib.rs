//! Scenes: the description of a picture as plain data.
//!
//! A [`Scene`] is a list of [`Element`]s, lights, a camera and settings. An element is a [`Shape`]
//! with a [`Finish`] (its look) and, if it is soft, a [`Flesh`] (its kernel). Soft elements blend
//! within their [`Body`] and never across bodies. The language (`rats`) writes scenes; the tracer
//! and the draft read them. This room does not depend on text, pixels or GPUs. Two things are
//! computed here because all readers must agree on them: the projection ([`Camera`]), and the
//! function of each body ([`surface`]).
//!
//! ```
//! use glam::DVec3;
//! use scene::{Element, Flesh, Scene, Shape};
//!
//! let mut scene = Scene::default();
//! scene.flesh.push(Flesh { blobbiness: Some(2.0), ..Flesh::default() });
//! let center = DVec3::ZERO;
//! scene.elements.push(Element {
//!     flesh: Some(0),
//!     ..Element::new(Shape::sphere(center, 1.0))
//! });
//! let surfaces = scene.surfaces();
//! assert!(surfaces[0].function().jet(center).value > field::THRESHOLD);
//! ```

pub mod body;
pub mod camera;
pub mod contact;
pub mod curves;
pub mod element;
pub mod finish;
pub mod flat_ends;
pub mod flesh;
pub mod function;
pub mod implicit_mesh;
pub mod light;
pub mod limbs;
mod local;
pub mod parts;
pub mod quadric;
mod same;
pub mod settings;
pub mod shape;
mod shared;
pub mod soft;
pub mod surface;
pub mod surroundings;
pub mod unit;

pub use body::{Body, Frame};
pub use camera::{Camera, Projection};
pub use contact::Contact;
pub use curves::{Clip, Curves};
pub use element::{Element, Origin, Paint};
pub use finish::{Finish, Skip};
pub use flesh::Flesh;
pub use function::{Form, Function};
pub use implicit_mesh::ImplicitMesh;
pub use light::{Light, LightKind};
pub use local::Limbs;
pub use quadric::Quadric;
pub use settings::{Digger, Fragile, Settings, Tone};
pub use shape::{Bone, Cuboid, Ends, Shape, extent};
pub use soft::SoftSurface;
pub use surface::{ComposedSurface, Surface, strongest};
pub use surroundings::{Background, Cloud, Fog, Ground, Lens, Sky};
pub use unit::Unit;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use texture::Rgb8;

/// Linear colour, red, green, blue; 0 is none and 1 the full light. Values above 1 are allowed.
pub type Rgb = [f32; 3];

/// Everything a renderer needs to draw one picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The shapes, in the order of the text.
    pub elements: Vec<Element>,
    /// Bodies; [`Element::body`] indexes this list. The first is the body without a name.
    pub bodies: Vec<Body>,
    /// Contacts of bodies, in the order of the text; of two for the same bodies the last counts.
    pub contacts: Vec<Contact>,
    /// Softness; [`Element::flesh`] indexes this list.
    pub flesh: Vec<Flesh>,
    /// Looks; [`Element::finish`] indexes this list.
    pub finishes: Vec<Finish>,
    /// Frames of objects; [`Element::frame`] indexes this list. The first is the world's.
    pub frames: Vec<Frame>,
    /// Light sources. A scene without any is lit by ambient light only.
    pub lights: Vec<Light>,
    /// Light that a ray gets which meets nothing.
    pub background: Background,
    /// Light from everywhere, if any.
    pub sky: Option<Sky>,
    /// Plane to stand on, if any.
    pub ground: Option<Ground>,
    /// Air that is not clear, if so.
    pub fog: Option<Fog>,
    /// Clouds of light.
    pub clouds: Vec<Cloud>,
    /// Unit vector that is up for sky, ground, fog and background.
    pub up: DVec3,
    /// Images for textures and the background, shared by all copies of the scene.
    #[serde(with = "shared")]
    pub images: Vec<Arc<Rgb8>>,
    /// View of the scene.
    pub camera: Camera,
    /// The camera's lens.
    pub lens: Lens,
    /// The scene at moments evenly spread over the time that the shutter is open, if anything moves
    /// then; the camera may move too. Samples of a pixel are taken from these in turn, with the
    /// settings of the scene that holds them. At most [`Scene::MAX_MOMENTS`]; those of the moments
    /// themselves are not looked at.
    pub moments: Vec<Scene>,
    /// Options that steer modelling and rendering.
    pub settings: Settings,
}

impl Scene {
    /// Most moments of a shutter.
    pub const MAX_MOMENTS: usize = 64;
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            elements: Vec::new(),
            bodies: vec![Body::default()],
            contacts: Vec::new(),
            flesh: Vec::new(),
            finishes: vec![Finish::default()],
            frames: vec![Frame::WORLD],
            lights: Vec::new(),
            background: Background::default(),
            sky: None,
            ground: None,
            fog: None,
            clouds: Vec::new(),
            up: DVec3::Y,
            images: Vec::new(),
            lens: Lens::default(),
            moments: Vec::new(),
            camera: Camera::default(),
            settings: Settings::default(),
        }
    }
}

/// The background of a text that sets none: a dark slate on which bright and dark flesh both read.
pub const DEFAULT_BACKGROUND: Rgb = [0.055, 0.07, 0.10];
