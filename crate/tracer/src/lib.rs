//! Scene to pixels.
//!
//! [`Picture::new`] prepares a scene for tracing at a given size; [`Picture::trace`] draws one
//! tile of it. A tile's pixels depend on nothing but the scene, so tiles may be traced in any
//! order, by any number of threads or workers, on any platform, with equal results.

mod area;
mod beam;
mod bound;
pub mod hard;
mod hierarchy;
mod lanes;
mod packet;
pub mod picture;
mod ray;
mod refine;
#[cfg(not(target_arch = "wasm32"))]
pub mod render;
mod roots;
mod sample;
mod shade;
mod slabs;
mod soft;
mod solids;
mod spans;
#[cfg(test)]
mod tests;
pub mod tile;
mod unit;
mod walk;

pub use picture::{Hit, Picture, Stats};
pub use ray::Ray;
#[cfg(not(target_arch = "wasm32"))]
pub use render::render;
pub use tile::{Pass, Tile, tiles};
