//! Readers of mesh files.

mod any;
mod cursor;
mod glb;
mod mtl;
mod obj;
mod ply;
mod stl;
mod three_mf;

pub use any::{read, read_with_remarks};
pub(crate) use cursor::Cursor;
pub use mtl::read_mtl;
pub use ply::read_points;
