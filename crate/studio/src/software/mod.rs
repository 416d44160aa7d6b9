//! Draws the window on the processor, for browsers with neither WebGPU nor WebGL2.
//!
//! eframe only paints with a GPU, so it is given a wgpu device that does nothing ([`device`]),
//! while a plugin ([`screen`]) takes what egui wants painted.

#[cfg(target_arch = "wasm32")]
mod device;
#[cfg(target_arch = "wasm32")]
pub use device::setup;

#[cfg(target_arch = "wasm32")]
pub fn install(_: &egui::Context) {}
