//! Scene to pixels.
//!
//! [`Picture::new`] prepares a scene for tracing at a given size; [`Picture::trace`] draws one
//! tile of it. A tile's pixels depend on nothing but the scene, so tiles may be traced in any
//! order, by any number of threads or workers, on any platform, with equal results.

pub mod picture;
pub mod tile;

pub use picture::{Hit, Picture, Stats};
pub use tile::{Pass, Tile};
