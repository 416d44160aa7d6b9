//! Worker pools: which worker does what, in the page and in native tests.
//!
//! A [`Pool`] keeps one tracer per processor core: web workers in the page, threads in native
//! builds. [`Pool::start`] cuts the picture into small tiles, coarse first, then every pixel, both
//! from the centre of the picture to its edges, then anti-aliased, and assigns them; finished ones
//! are fetched with [`Pool::poll`]. Starting a picture cancels the one before.
//!
//! ```
//! # #[cfg(not(target_arch = "wasm32"))] {
//! let mut pool = pool::Pool::new(|| {});
//! let scene = scene::Scene::default();
//! pool.start(pool::Job {
//!     scene: &scene,
//!     size: [80, 60],
//!     generation: 1,
//!     kind: worker::Kind::Colours,
//!     small: true,
//! });
//! let mut pixels = 0;
//! while !pool.progress().finished {
//!     for tile in pool.poll() {
//!         pixels += tile.pixels.len() / 4;
//!     }
//! }
//! assert_eq!(pixels, 80 * 60);
//! # }
//! ```
//!
//! Decisions, and what happens when a worker dies or hangs, are in [`scheduler`], a state machine
//! that is tested without workers; `web_workers` and `threads` carry them out. [`Tools`] runs jobs that
//! draw nothing, such as reading a mesh, in a worker of its own, which [`supervisor`] replaces likewise.
//! [`Assembly`] puts the tiles of a picture together as they come.

pub mod assembly;
mod assign;
mod core;
pub mod job;
mod partition;
pub mod progress;
mod run;
pub mod scheduler;
mod shared_samples;
pub mod supervisor;
mod tool_jobs;
mod workers;

#[cfg(not(target_arch = "wasm32"))]
mod thread_pool;
#[cfg(not(target_arch = "wasm32"))]
mod thread_tools;
#[cfg(not(target_arch = "wasm32"))]
mod threads;
#[cfg(target_arch = "wasm32")]
mod web_pool;
#[cfg(target_arch = "wasm32")]
mod web_tools;
#[cfg(target_arch = "wasm32")]
mod web_workers;

pub use assembly::{Assembly, Change, Image};
pub use job::{Job, TileDone};
pub use progress::Progress;
pub use tool_jobs::ToolEvent;
#[cfg(not(target_arch = "wasm32"))]
pub use {thread_pool::Pool, thread_tools::Tools};
#[cfg(target_arch = "wasm32")]
pub use {web_pool::Pool, web_tools::Tools};

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
