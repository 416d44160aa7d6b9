//! Exports: meshes with names and materials, to be written.

use crate::triangle_mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

/// Meshes to be written to a file, with their size.
///
/// All formats but GLB are written in millimetres. GLB's unit is the metre: its positions are the
/// same numbers, below a node that scales them by 0.001. So every format has the same coordinates,
/// rounded to 32 bits once, and what was proved of [`Export::round`] holds for each. (OBJ and 3MF
/// have the shortest decimals that are these 32-bit numbers; a reader that takes them for 64-bit
/// ones is off by up to 6e-8 of a coordinate.)
///
/// Colours are linear in GLB, and sRGB in PLY, OBJ, MTL and 3MF. STL has no colours. Vertex colours
/// replace the colours of materials: in GLB, where both are multiplied, the materials of a mesh
/// with vertex colours are white.
///
/// ```
/// use glam::DVec3;
/// use mesh::{Export, Format, Part, TriangleMesh};
///
/// let mesh = TriangleMesh::new(
///     vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
///     vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
/// );
/// let export = Export {
///     name: "corner".into(),
///     parts: vec![Part { name: "only".into(), mesh }],
///     millimetres: 50.0,
/// };
/// let files = export.write(Format::ThreeMf)?;
/// assert_eq!(files[0].name, "corner.3mf");
/// let again = mesh::read(&files[0].name, &files[0].bytes)?;
/// assert_eq!(again.corners(3), [DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * 50.0));
/// assert_eq!(again.groups[0].name, "only");
/// # Ok::<(), mesh::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Export {
    /// Name of the file without its ending.
    pub name: String,
    /// The parts: one for each body.
    pub parts: Vec<Part>,
    /// Length of the meshes' unit, millimetres.
    pub millimetres: f64,
}

/// Named mesh of an [`Export`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Name; may be empty.
    pub name: String,
    /// The mesh. Each of its groups may have a material.
    pub mesh: TriangleMesh,
}

/// File as bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExportedFile {
    /// Name with ending.
    pub name: String,
    /// Contents.
    pub bytes: Vec<u8>,
}
