//! The page: an egui app that edits a dataset, shows the draft and the traced picture, and shares
//! them.
//!
//! The user's work ([`session`], [`history`], [`picture`], [`storage`], [`share`]) does not depend
//! on windows and is tested without one. [`app::App`] connects it to the widgets.

mod act;
mod apart;
pub mod app;
mod arrivals;
pub mod asset;
pub mod asset_view;
pub mod backend;
pub mod bar;
#[cfg(target_arch = "wasm32")]
pub mod boot;
pub mod code;
pub mod command;
#[cfg(target_arch = "wasm32")]
pub mod crash;
mod download;
pub mod draft;
mod draw;
pub mod editor;
#[cfg(target_arch = "wasm32")]
pub mod emulation;
#[cfg(target_arch = "wasm32")]
pub mod entry;
pub mod examples;
pub mod files;
pub mod film;
mod fit_panel;
mod fitting;
#[cfg(target_arch = "wasm32")]
mod frames;
pub mod gallery;
#[cfg(target_arch = "wasm32")]
pub mod handle;
pub mod hands;
pub mod help;
pub mod history;
pub mod indent;
pub mod intake;
pub mod keyboard;
pub mod lamp;
pub mod layout;
mod live;
pub mod marks;
pub mod mesh_export;
mod mesh_panel;
pub mod notice;
mod numerals;
mod outside;
pub mod pad;
pub mod pencil;
pub mod picture;
pub mod platform;
pub mod problems;
pub mod project_file;
pub mod reading;
pub mod recording;
pub mod reference;
pub mod render;
pub mod report;
pub mod request;
mod screening;
mod sculpting;
pub mod session;
pub mod settings;
pub mod share;
pub mod size;
pub mod sliders;
pub mod software;
pub mod status;
pub mod storage;
mod thumbnail;
pub mod timeline;
pub mod tray;
pub mod view;
pub mod work;

pub use backend::Backend;
pub use widgets::{clock, fonts, icon, places, screen, slider, theme};
