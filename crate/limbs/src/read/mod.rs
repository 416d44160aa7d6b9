//! Readers of files.

mod any;
mod csv;
mod elements;
mod molecule;
mod obj;
mod ply;
mod polydata;
mod radii;
mod swc;
mod three_mf;
mod vtk;
mod vtp;

pub use any::{Reading, read};
pub(crate) use obj::RADII_IN_VT;
pub(crate) use swc::TYPES;
