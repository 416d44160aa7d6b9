//! Triangle meshes and height fields from files.
//!
//! [`read`] makes a [`Mesh`] of the bytes of an OBJ, PLY, STL or GLB file, [`heights`] makes
//! [`Heights`] of a PNG picture, and [`terra`] makes a smooth [`Mesh`] of those. [`Mesh::shapes`] are
//! what a scene takes.
//!
//! Files come from anywhere, so nothing in them is believed: every count is checked against what is
//! there and against [`limits`] before memory is taken for it, and what is wrong is told in a
//! sentence with its place. The readers know the few parts of each format that say where
//! triangles and normals are; colours, textures and animations are passed over.

mod cursor;
mod glb;
mod heights;
pub mod limits;
mod model;
mod obj;
mod ply;
mod stl;
mod terra;

pub use heights::{Heights, heights};
pub use model::Mesh;
pub use terra::terra;

use core::fmt;

/// Why a file cannot be used: a sentence for the person who chose it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error(pub String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for Error {}

/// An error with a text.
fn fail<T>(text: impl Into<String>) -> Result<T, Error> {
    Err(Error(text.into()))
}

/// Reads a mesh. The format follows from the first bytes, where they tell, else from the ending of
/// the file's name (`.obj`, `.ply`, `.stl`, `.glb`, in any case).
///
/// Polygons are cut into triangles that all start at their first corner, which is right for convex
/// ones. Triangles without an area are left out. A file in which some triangles have no normals is
/// read as if none had.
///
/// # Errors
/// If the file is of none of these formats, is broken, asks for what cannot be read, has no
/// triangles or is over one of the [`limits`].
pub fn read(name: &str, bytes: &[u8]) -> Result<Mesh, Error> {
    if bytes.len() > limits::MAX_BYTES {
        return fail(format!(
            "this file has {} MB, more than the {} MB that are taken",
            bytes.len() / 1_000_000,
            limits::MAX_BYTES / 1_000_000
        ));
    }
    let name = name.to_ascii_lowercase();
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    let mesh = if bytes.starts_with(b"glTF") {
        glb::read(bytes)
    } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        ply::read(bytes)
    } else {
        match ending {
            "obj" => obj::read(bytes),
            "stl" => stl::read(bytes),
            "ply" => fail("this is no PLY file: it does not begin with `ply`"),
            "glb" => fail("this is no GLB file: it does not begin with `glTF`"),
            "gltf" => fail("a .gltf file needs others beside it; save it as .glb"),
            _ => fail("meshes are read from .obj, .ply, .stl and .glb files"),
        }
    }?;
    mesh.sound()
}
