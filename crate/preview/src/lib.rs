//! The instant draft of a scene, drawn on the GPU.
//!
//! Every element is drawn as its *offset surface* – a ball, a cylinder, a piece of a torus, a
//! prism, a slab of the radius that counts for it ([`scene::Scene::radius`]) – and not as a mesh
//! (but for what is flat, and quadrics): the GPU rasterises a box around the element, and a shader
//! (see `shaders/`) casts the viewing ray of each pixel at the exact shape inside. Silhouettes are
//! smooth at any distance, shapes that pass through each other meet in the right curve, and nothing
//! is prepared when the text changes but a list of numbers. The draft and the tracer share the
//! projection ([`scene::Camera::projection`]) and Phong's model, so the traced picture falls into
//! place over the draft. Spots, sky, fog, gradients, ground and filmic tone are drawn, a texture as
//! its mean colour. The draft has no blending of soft elements, unless it is handed a mesh of their
//! true surface ([`Draft::set_mesh`]), no shadows, mirrors and glass.
//!
//! [`Draft`] draws; [`orbit`] moves a camera with the pointer, or to where it sees everything.
//!
//! [`trace`] draws the true surface, with shadows, by a ray for each pixel. The page does not use
//! it yet.
//!
//! All run wherever wgpu does, WebGL2 included, without storage buffers and compute shaders; the
//! tracer uses those where they are.

mod bounds;
mod draft;
mod facets;
mod instance;
mod materials;
mod mesh;
pub mod orbit;
mod pipelines;
mod solid;
mod targets;
pub mod trace;
mod view;

pub use bounds::Bounds;
pub use draft::{Draft, Drawn, MAX_ELEMENTS};
pub use mesh::{Mesh, VERTEX, looks};
pub use targets::Sampling;
pub use view::MAX_LIGHTS;
