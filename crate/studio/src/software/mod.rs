//! Draws the window on the processor, for browsers with neither WebGPU nor WebGL2, and for those
//! that have the processor pretend to be a graphics card.
//!
//! eframe only paints with a GPU. So it is given a wgpu device that does nothing
//! (`device`), while a plugin of egui (`screen`) takes the shapes that egui wants painted, has them
//! drawn ([`painter`]), and puts them on the canvas.

#[cfg(target_arch = "wasm32")]
mod device;
#[cfg(target_arch = "wasm32")]
mod screen;

#[cfg(target_arch = "wasm32")]
pub use device::setup;
#[cfg(target_arch = "wasm32")]
pub use screen::install;
