//! The page: an egui app that edits a dataset, shows the draft and the traced picture, and shares
//! them.
//!
//! The user's work ([`session`], [`history`], [`picture`], [`storage`], [`share`]) does not depend
//! on windows and is tested without one. [`app::App`] connects it to the widgets.

pub mod app;
pub mod asset;
pub mod backend;
mod bar;
#[cfg(target_arch = "wasm32")]
pub mod boot;
#[cfg(target_arch = "wasm32")]
pub mod crash;
mod download;
#[cfg(target_arch = "wasm32")]
pub mod emulation;
#[cfg(target_arch = "wasm32")]
pub mod entry;
pub mod examples;
pub mod export;
pub mod film;
pub mod fit;
#[cfg(target_arch = "wasm32")]
mod frames;
pub mod help;
pub mod history;
pub mod intake;
mod keys;
pub mod layout;
mod lessons;
pub mod notice;
mod numerals;
pub mod page;
pub mod panel;
pub mod picture;
pub mod platform;
mod problems;
pub mod project_file;
pub mod reading;
pub mod render;
pub mod scripts;
mod sculpt;
pub mod session;
pub mod settings;
pub mod share;
pub mod size;
pub mod sliders;
pub mod software;
pub mod stage;
mod status;
pub mod storage;
pub mod text;
mod thumbnail;
pub mod tray;
pub mod wish;
pub mod work;
pub mod works;

pub use backend::Backend;
pub use widgets::{clock, fonts, icon, places, screen, slider, theme};
