//! Writers of mesh files.

mod any;
mod export;
mod glb;
mod obj;
mod ply;
mod prepared;
mod rig;
mod shading;
mod stl;
mod three_mf;

pub use export::{Export, ExportedFile, Part};
pub use rig::{Joint, Pose, Rig};
