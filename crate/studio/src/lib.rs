//! The page: an egui app that edits a dataset, shows the draft and the traced picture, and shares
//! them.
//!
//! What the user works on ([`session`], [`history`], [`picture`], [`storage`], [`share`]) knows
//! nothing of windows and is tested without one. [`app::App`] ties it to the widgets.

pub mod backend;
#[cfg(target_arch = "wasm32")]
pub mod boot;
pub mod history;
pub mod indent;
pub mod picture;
pub mod pool;
pub mod session;
pub mod software;
pub mod storage;

pub use backend::Backend;
