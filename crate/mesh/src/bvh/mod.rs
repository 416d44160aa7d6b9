//! Bounding volume hierarchy over boxes, and searches in it.

mod build;
mod search;
mod tree;

pub use search::Ray;
pub use tree::Bvh;
