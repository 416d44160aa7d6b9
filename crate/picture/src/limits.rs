//! The limits of pictures and animations. Each has its own sentence and its own test.

/// Pixels of a picture, 64 Mi (8192 × 8192): 256 MB.
pub const MAX_PIXELS: u64 = 64 << 20;
/// Width or height of a picture, which is what TGA and GIF files can hold.
pub const MAX_SIDE: u32 = 65_535;
/// Pixels of what stands between the two passes of resizing (old width times new height), which
/// needs four times the memory of a picture.
pub const MAX_BETWEEN: u64 = 32 << 20;
/// Frames of an animation.
pub const MAX_FRAMES: u32 = 10_000;
/// Pixels of all frames of an animation that is read, since a short file can hold a great many.
pub const MAX_ANIMATION: u64 = 1 << 30;
/// Pictures on one sheet.
pub const MAX_SHEET: usize = 4096;
/// Points of a plotted line.
pub const MAX_POINTS: usize = 256;
/// Colours of a palette.
pub const MAX_SWATCHES: usize = 4096;
