//! The limits that keep any file harmless.

/// Bytes of a file.
pub const MAX_BYTES: usize = 64 * 1024 * 1024;
/// Bytes of numbers or text that are unpacked from a file.
pub const MAX_UNPACKED: usize = 128 * 1024 * 1024;
/// Limbs of a graph.
pub const MAX_LIMBS: usize = 200_000;
/// Nodes of a graph.
pub const MAX_NODES: usize = 2 * MAX_LIMBS;
/// Points that a file lists, used by limbs or not.
pub const MAX_POINTS: usize = 2_000_000;
/// Limbs that a file lists, those included that are listed twice.
pub const MAX_LISTED: usize = 2_000_000;
/// Names of types and materials.
pub const MAX_GROUPS: usize = 10_000;
/// Bytes of such a name; of longer ones the beginning is kept.
pub const MAX_NAME: usize = 200;
/// Largest coordinate and radius, of either sign.
pub const MAX_COORDINATE: f64 = mesh::limits::MAX_COORDINATE;
/// Remarks about single lines; those beyond are counted.
pub const MAX_REMARKS: usize = 50;
