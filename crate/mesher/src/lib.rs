//! Closed triangle meshes of implicit surfaces and scenes, within a proven tolerance.

mod certify;
mod forest;
mod improve;
mod lattice;
mod level;
mod march;
mod model;
mod options;
mod paint;
mod parallel;
mod refine;
mod solids;
mod space;
mod surface;
mod unite;

pub use model::{Model, ModelPart, Tolerance, Wishes, mesh_scene};
pub use options::{MeshError, Options, Progress};
pub use surface::{SurfaceMesh, box_of, extent, polygonize};
