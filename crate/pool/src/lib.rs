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
//! let scene = std::sync::Arc::new(scene::Scene::default());
//! pool.start(pool::PictureJob {
//!     scene: &scene,
//!     camera: None,
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
//! [`Tools`] carries out jobs that take long and draw nothing, such as reading a mesh, and gives a
//! [`Ticket`] for the result of each.
//!
//! Decisions, and what happens when a worker dies or hangs, are in three state machines that are
//! tested without workers: [`life`], the life of any worker; [`scheduler`], the tiles of the
//! tracing workers; [`queue`], the jobs of a tools worker. `web` and
//! `threads` carry them out. [`Assembly`] puts the tiles of a picture together as they come.

pub mod assembly;
mod assign;
pub mod clock;
mod core;
mod forecast;
pub mod job;
pub mod life;
mod partition;
mod pool;
pub mod progress;
pub mod queue;
mod run;
pub mod scheduler;
mod shared_samples;
mod tickets;
mod workers;

#[cfg(not(target_arch = "wasm32"))]
mod threads;
#[cfg(target_arch = "wasm32")]
mod web;
#[cfg(not(target_arch = "wasm32"))]
use threads as platform;
#[cfg(target_arch = "wasm32")]
use web as platform;

pub use assembly::{Assembly, Change, Image};
pub use job::{PictureJob, TileDone};
pub use pool::Pool;
pub use progress::Progress;
pub use tickets::{Ticket, Tools};
#[cfg(target_arch = "wasm32")]
pub use web::set_folder;

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
