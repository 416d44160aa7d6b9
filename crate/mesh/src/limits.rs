//! The limits that keep any file harmless.

/// The largest file, bytes.
pub const MAX_BYTES: usize = 32 * 1024 * 1024;
/// Triangles of a mesh.
pub const MAX_TRIANGLES: usize = 200_000;
/// Corners of a mesh, and positions or normals in a file: three for each triangle.
pub const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;
/// Largest coordinate of a corner, of either sign. A mesh farther from everything would come out as
/// nothing.
pub const MAX_COORDINATE: f64 = 1e12;
/// Millimetres of the longest side of a mesh that is written: from a thousandth of a millimetre to
/// a thousand kilometres.
pub const MILLIMETRES: core::ops::RangeInclusive<f64> = 1e-3..=1e9;
/// Bytes of a GLB file's description (the rest is numbers).
pub const MAX_JSON: usize = 4 * 1024 * 1024;
/// Pixels of a picture of heights.
pub const MAX_PIXELS: usize = 4096 * 4096;
/// Triangles of a height field. A larger picture is averaged to a smaller grid.
pub const MAX_TERRA: usize = 2 * 256 * 256;
/// Half-edges of a half-edge mesh, free slots included: enough for 10,000,000 triangles.
pub const MAX_HALF_EDGES: usize = 60_000_000;
/// Materials in an MTL or 3MF file, and groups of a mesh.
pub const MAX_MATERIALS: usize = 10_000;
/// Bytes of the description in a 3MF file, unpacked.
pub const MAX_XML: usize = 64 * 1024 * 1024;
/// Beams of a lattice in a 3MF file, and balls.
pub const MAX_BEAMS: usize = 1_000_000;
/// Triangles of a file that is written.
pub const MAX_EXPORT_TRIANGLES: usize = 4_000_000;
