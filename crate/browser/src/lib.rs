//! The browser around the page: address, storage, clock, files from and for the user, encoders of
//! videos, and the window on the best backend that there is.
//!
//! Natively, in tests, the services have stand-ins in memory, one for each thread.

mod backend;
#[cfg(target_arch = "wasm32")]
pub mod boot;
#[cfg(target_arch = "wasm32")]
pub mod emulation;
#[cfg(target_arch = "wasm32")]
mod encoder;
#[cfg(target_arch = "wasm32")]
pub mod frames;
#[cfg(not(target_arch = "wasm32"))]
mod native;
pub mod recording;
#[cfg(target_arch = "wasm32")]
pub mod software;
pub mod voice;
#[cfg(target_arch = "wasm32")]
mod web;

pub use backend::{Backend, is_processor};
#[cfg(target_arch = "wasm32")]
pub use encoder::*;
#[cfg(not(target_arch = "wasm32"))]
pub use native::*;
#[cfg(target_arch = "wasm32")]
pub use web::*;
