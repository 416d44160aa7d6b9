//! The page: an egui app that edits a dataset, shows the draft and the traced picture, and shares
//! them.
//!
//! The user's work is in crate `document`, which knows no window, the browser in crate `browser`.
//! Here are the panels: each has its state, its widgets, its wishes and what they do in a file or a
//! folder ([`panel`], [`panels`]). [`page::Page`] is what they share;
//! [`app::App`] ticks and shows them, and has their [`wish`]es carried out.

pub mod app;
mod bar;
mod clicks;
#[cfg(target_arch = "wasm32")]
pub mod crash;
mod download;
#[cfg(target_arch = "wasm32")]
pub mod entry;
pub mod export;
pub mod film;
pub mod first;
pub mod fit;
pub mod help;
mod keys;
pub mod layout;
mod lessons;
pub mod notice;
pub mod page;
pub mod panel;
pub mod panels;
mod problems;
pub mod render;
pub mod scripts;
mod sculpt;
pub mod settings;
pub mod sliders;
pub mod stage;
mod status;
pub mod text;
mod thumbnail;
pub mod tray;
pub mod wish;
pub mod works;

pub use widgets::{fonts, icon, places, screen, slider, theme};
