//! The limits that keep any text harmless.

/// Faces of a sculpture.
pub const MAX_FACES: usize = 2_000_000;
/// Vertices of one face that the start or a deletion makes.
pub const MAX_SIDES: usize = 100_000;
/// Bytes of a text of strokes.
pub const MAX_BYTES: usize = 4 * 1024 * 1024;
/// Lines of a text that are strokes.
pub const MAX_STROKES: usize = 100_000;
/// Points of one path.
pub const MAX_POINTS: usize = 100_000;
/// Steps between two points of a path: beyond, the steps become longer.
pub const MAX_STEPS: f64 = 64.0;
/// Levels of smoothing, or of growth of a region, in one stroke.
pub const MAX_LEVELS: u32 = 100;
/// Largest coordinate, semi-axis and range in a text.
pub const LARGEST: f64 = 1e6;
/// Smallest semi-axis.
pub const SMALLEST: f64 = 1e-6;
/// Largest coordinate of a vertex: a motion beyond is left out.
pub const FARTHEST: f64 = 1e9;
/// Vertices that all strokes of a replay may visit together, unless the caller says otherwise.
pub const MAX_WORK: u64 = 2_000_000_000;
/// Bytes that undo keeps; older steps are replayed.
pub const MAX_UNDO: usize = 256 * 1024 * 1024;
