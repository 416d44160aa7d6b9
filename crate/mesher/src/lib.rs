//! Closed triangle meshes of implicit surfaces and scenes, within a proven tolerance.

mod certify;
mod forest;
mod improve;
mod lattice;
mod march;
mod options;
mod parallel;
mod refine;
mod space;
mod surface;

pub use options::{MeshError, Options, Progress};
pub use surface::{Surface, box_of, extent, polygonize};
