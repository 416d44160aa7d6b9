//! The reader of any format.

use super::{glb, obj, ply, stl, three_mf};
use crate::error::{Error, fail};
use crate::format::Format;
use crate::limits;
use crate::triangle_mesh::TriangleMesh;

/// Reads a mesh of the format that [`Format::of`] tells.
///
/// Positions are in the file's units, but those of 3MF files in millimetres (GLB's unit is the
/// metre). Colours become linear: vertex colours of GLB are, those of PLY, OBJ and 3MF are taken
/// for sRGB.
///
/// Polygons are cut into triangles that all start at their first corner, which is right for convex
/// ones. Triangles without an area are left out, and so are those that are there twice, facing the
/// same side. A file in which some triangles have no normals is read as if none had.
///
/// # Errors
/// If the file is of none of these formats, is broken, asks for what cannot be read, has no
/// triangles or is over one of the [`limits`].
pub fn read(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Error> {
    read_with_remarks(name, bytes).map(|(mesh, _)| mesh)
}

/// Reads a mesh as [`read`] does, and returns sentences about what was left out, too.
///
/// ```
/// let obj = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 2 3 1\n";
/// let (mesh, remarks) = mesh::read_with_remarks("a.obj", obj)?;
/// assert_eq!(mesh.triangles.len(), 1);
/// assert_eq!(remarks, ["1 triangles that are there twice are left out"]);
/// # Ok::<(), mesh::Error>(())
/// ```
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_with_remarks(name: &str, bytes: &[u8]) -> Result<(TriangleMesh, Vec<String>), Error> {
    if bytes.len() > limits::MAX_BYTES {
        return fail(format!(
            "this file has {} MB, more than the {} MB that are taken",
            bytes.len() / 1_000_000,
            limits::MAX_BYTES / 1_000_000
        ));
    }
    let is_told = Format::of_bytes(bytes).is_some();
    let mesh = match Format::of(name, bytes) {
        Some(Format::Obj) => obj::read(bytes),
        Some(Format::Stl) => stl::read(bytes),
        Some(Format::Glb) if is_told => glb::read(bytes),
        Some(Format::ThreeMf) if is_told => three_mf::read(bytes),
        Some(Format::Ply) if is_told => ply::read(bytes),
        Some(Format::Ply) => fail("this is no PLY file: it does not begin with `ply`"),
        Some(Format::Glb) => fail("this is no GLB file: it does not begin with `glTF`"),
        Some(Format::ThreeMf) => {
            fail("this is no 3MF file: it does not begin as a zip archive does")
        }
        None if name.to_ascii_lowercase().ends_with(".gltf") => {
            fail("a .gltf file needs others beside it; save it as .glb")
        }
        None => Err(Format::refuse()),
    }?;
    mesh.check()
}
