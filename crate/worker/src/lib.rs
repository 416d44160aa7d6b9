//! Tiles on request.
//!
//! The page cuts a picture into tiles and sends [`Request`]s to its workers; a worker keeps them in
//! an [`Engine`], does one step of work at a time and sends [`Answer`]s. Between two steps it looks
//! at new requests, so queued tiles of an older picture are never begun. The same engine runs
//! on a thread in native builds. The part for web workers is in `entry`, which is compiled
//! only into the worker's own wasm (feature `entry`).

pub mod engine;
#[cfg(all(target_arch = "wasm32", feature = "entry"))]
mod entry;
pub mod errors;
pub mod message;

pub use engine::{Engine, Step};
pub use message::{Answer, Kind, Order, Request};
