//! The workers that trace the picture.
//!
//! A [`Pool`] keeps one tracer per processor core: web workers in the page, threads in native
//! builds (tests). [`Pool::start`] cuts the picture into small tiles, coarse first, then every
//! pixel, both from the centre of the picture to its edges, then anti-aliased, and hands them out;
//! finished ones are fetched with [`Pool::poll`]. Starting a picture cancels the one before.
//!
//! Who does what, and what happens when a worker dies or hangs, is decided in [`scheduler`], which
//! knows nothing of workers and is tested by itself; `browser` and `threads` carry it out.

mod core;
mod deal;
mod hearsay;
pub mod progress;
mod run;
pub mod scheduler;
mod share;

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(target_arch = "wasm32")]
pub use browser::Pool;
#[cfg(not(target_arch = "wasm32"))]
mod threads;
#[cfg(not(target_arch = "wasm32"))]
pub use threads::Pool;

pub use progress::Progress;

use scene::Scene;
use tracer::{Pass, Tile};
use worker::Kind;

/// Longest side of a tile in pixels: that of the squares in which the tracer finds out once for all pixels
/// what is near. Small enough that a tile takes milliseconds, large enough that sending it takes a small
/// share of that.
pub const TILE: u32 = 64;
/// The same for small pictures, of which there are many: fewer messages matter more.
pub const SMALL_TILE: u32 = 56;
/// Most workers, whatever the machine has: each holds its own copy of the scene.
pub const MAX_WORKERS: usize = 16;

/// A picture to trace.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// What to draw. With `settings.samples` 1 there is no [`Pass::Smooth`]: it would equal
    /// [`Pass::Full`].
    pub scene: &'a Scene,
    /// Width and height in pixels. A side of 0 gives an empty picture, finished at once.
    pub size: [u32; 2],
    /// The caller's number for it, given back with each tile.
    pub generation: u64,
    /// What its pixels tell.
    pub kind: Kind,
    /// Whether it is seen only once it is finished, as the small pictures of the lab are: then only
    /// the last pass is traced, and the app is not woken before the end.
    pub small: bool,
}

/// A finished tile.
#[derive(Clone, Debug, PartialEq)]
pub struct TileDone {
    /// The number of the [`Job`].
    pub generation: u64,
    /// How finely it was traced.
    pub pass: Pass,
    /// Where it belongs. Each pass has the same tiles.
    pub tile: Tile,
    /// Four bytes each, for what the job's [`Kind`] says; rows from the top.
    pub pixels: Vec<u8>,
}

/// How many workers to start on a machine with so many cores.
fn worker_count(cores: usize) -> usize {
    cores.clamp(1, MAX_WORKERS)
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
