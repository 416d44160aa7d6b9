//! Writers of mesh files.

mod any;
mod export;
mod glb;
mod obj;
mod ply;
mod prepared;
mod rig;
mod shading;
mod shift;
mod stl;
mod three_mf;

pub use export::{Export, ExportedFile, Part};
pub use rig::{Joint, Pose, Rig};
pub use shift::{describe_shift, shift_of};
