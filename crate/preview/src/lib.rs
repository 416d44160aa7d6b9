//! The draft: the true surface of a scene, drawn on the GPU.
//!
//! [`Tracer`] draws what [`cells::Packed`] holds – bodies as they melt together, hard shapes,
//! meshes of what has neither – by a ray for each pixel, with shadows. The tracer on the processor
//! has the same projection ([`scene::Camera::projection`]) and Phong's model, so that its picture
//! falls into place over the draft. Spots, sky, fog, gradients, ground and filmic tone are drawn, a
//! texture as its mean colour; no mirrors and glass.
//!
//! [`Pace`] finds the resolution at which frames keep up with a hand; [`orbit`] moves a camera with
//! the pointer, or to where it sees everything; [`Copy`] brings a picture back.
//!
//! All run wherever wgpu does, WebGL2 included, without storage buffers and compute shaders; the
//! tracer uses those where a caller asks for them.

mod bindings;
mod copy;
mod materials;
pub mod orbit;
mod pace;
mod trace;
mod verdict;
mod view;

pub use copy::Copy;
pub use pace::Pace;
pub use trace::{Code, Pixel, Stage, Target, Tracer};
pub use view::MAX_LIGHTS;
