//! Pictures to trace and their finished tiles.

use scene::{Camera, Digger, Scene};
use std::sync::Arc;
use tracer::{Pass, Tile};
use worker::Kind;

/// Longest side of a tile in pixels: that of the squares for which the tracer collects nearby
/// primitives once for all pixels. Small enough that a tile takes milliseconds, large enough that
/// sending it takes a small share of that.
pub const TILE: u32 = 64;
/// Longest side of a tile of a small picture in pixels. There are many such pictures, so fewer
/// messages matter more.
pub const SMALL_TILE: u32 = 56;
/// Most workers, whatever the machine has: each holds its own copy of the scene.
pub const MAX_WORKERS: usize = 16;

/// A picture to trace.
#[derive(Clone, Copy, Debug)]
pub struct PictureJob<'a> {
    /// Scene to draw. With `settings.samples` 1 there is no [`Pass::Smooth`]: it would equal
    /// [`Pass::Full`].
    pub scene: &'a Arc<Scene>,
    /// The camera that sees it, if it is another than the scene's.
    pub camera: Option<Camera>,
    /// Width and height in pixels. A side of 0 gives an empty picture, finished at once.
    pub size: [u32; 2],
    /// The caller's number for it, given back with each tile.
    pub generation: u64,
    /// Meaning of its pixels.
    pub kind: Kind,
    /// Whether it is shown only once it is finished, as the small pictures of the lab are: then
    /// only the last pass is traced, and the app is not woken before the end.
    pub small: bool,
}

impl PictureJob<'_> {
    /// Whether it needs the root finders for comparison.
    #[must_use]
    pub fn compares(&self) -> bool {
        self.kind == Kind::Errors || self.scene.settings.digger != Digger::Hermite
    }
}

/// A finished tile.
#[derive(Clone, Debug, PartialEq)]
pub struct TileDone {
    /// The number of the [`PictureJob`].
    pub generation: u64,
    /// The pass in which it was traced.
    pub pass: Pass,
    /// The place in the picture. Each pass has the same tiles.
    pub tile: Tile,
    /// The pixels, four bytes each, whose meaning is the job's [`Kind`]; rows from the top.
    pub pixels: Vec<u8>,
}

/// Returns the number of workers to start on a machine with `cores` cores.
pub(crate) fn worker_count(cores: usize) -> usize {
    cores.clamp(1, MAX_WORKERS)
}
