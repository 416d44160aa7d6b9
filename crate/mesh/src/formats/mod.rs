//! Parts of file formats that hold more than meshes: texts, XML, PLY's tables, 3MF's packages.

pub mod package;
pub mod ply;
pub mod text;
pub mod xml;
