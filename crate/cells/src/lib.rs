//! Scenes as plain numbers that a graphics card sends rays through; no card is asked here, so that
//! a worker can make them.
//!
//! The functions of all bodies ([`scene::Scene::surfaces`]) are divided into cells ([`octree`]),
//! those that the surface passes with a cubic each ([`cubic`]) and, where that is not enough and
//! the card has them, with the chart's formulas ([`formulas`]). Bodies for which that takes too
//! long are meshed ([`facade`]). The work is bounded, and counted ([`counted`]). Hard shapes
//! ([`solid`]) and the triangles of meshes have a hierarchy of boxes ([`hierarchy`]). [`pack`] lays
//! all of it out as `shaders/scene.wgsl` reads it. Nothing of it depends on the camera: while one
//! turns, only the view changes.

mod bounds;
mod counted;
mod cubic;
mod facade;
mod facets;
pub mod formulas;
mod hierarchy;
mod look;
mod octree;
mod pack;
mod paint;
mod solid;
mod units;

pub use bounds::Bounds;
pub use formulas::{Chart, Cubics, Formulas};
pub use look::{draft_colours, finite, with};
pub use octree::Told;
pub use pack::{Detail, Frame, Packed};
pub use units::Units;
