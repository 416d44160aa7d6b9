//! Shapes with what is done to them.
//!
//! All coordinates are world coordinates: objects and their transforms are already applied.

use crate::{Rgb, Shape};
use field::Kernel;
use serde::{Deserialize, Serialize};

/// Shape with its softness and its look. The indices point into the lists of the
/// [`Scene`](crate::Scene).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// The geometry, in the world's coordinates.
    pub shape: Shape,
    /// Index into [`Scene::flesh`](crate::Scene::flesh); `None` for a hard element.
    pub flesh: Option<u32>,
    /// Index into [`Scene::finishes`](crate::Scene::finishes).
    pub finish: u32,
    /// Index into [`Scene::bodies`](crate::Scene::bodies).
    pub body: u32,
    /// Index into [`Scene::frames`](crate::Scene::frames).
    pub frame: u32,
    /// The kernel, unless the flesh names one.
    pub kernel: Kernel,
    /// Place in the text of the command that made the element.
    pub origin: Origin,
    /// Colours at the corners of a triangle or patch; `None` for other shapes, and where the finish
    /// says all.
    pub paint: Option<Box<Paint>>,
}

impl Element {
    /// Returns a hard element with the first finish, in the body without a name and the world's
    /// frame.
    #[must_use]
    pub fn new(shape: Shape) -> Self {
        Self {
            shape,
            flesh: None,
            finish: 0,
            body: 0,
            frame: 0,
            kernel: Kernel::Cauchy,
            origin: Origin::default(),
            paint: None,
        }
    }
}

/// Colours at the corners of a triangle, mixed linearly within it. [`Element::finish`] has about
/// their mean, for what cannot mix colours within a triangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Paint {
    /// Index into [`Scene::finishes`](crate::Scene::finishes): the finish whose `ambient` and
    /// `diffuse` the colours multiply.
    pub finish: u32,
    /// The colours, in the order of the shape's corners; each channel 0 to 1.
    pub corners: [Rgb; 3],
}

/// Origin of an element: a byte range of one of the project's files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Origin {
    /// Index of the file in the compiler's file list.
    pub file: u32,
    /// First byte of the command.
    pub start: u32,
    /// End of the command: one past its last byte.
    pub end: u32,
}
