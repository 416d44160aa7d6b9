//! Writers of mesh files.

mod any;
mod export;
mod glb;
mod obj;
mod ply;
mod prepared;
mod stl;
mod three_mf;

pub use export::{Export, ExportedFile, Format, Part};
