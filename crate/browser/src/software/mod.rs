//! Draws the window on the processor, for browsers with neither WebGPU nor WebGL2, and for those
//! that emulate a graphics card on the processor.
//!
//! eframe only paints with a GPU. So it is given a wgpu device that does nothing (`device`), while
//! a plugin of egui (`screen`) paints egui's shapes ([`painter`]) and puts them on the canvas.

#[cfg(target_arch = "wasm32")]
mod device;
#[cfg(target_arch = "wasm32")]
mod screen;

#[cfg(target_arch = "wasm32")]
pub use device::setup;
#[cfg(target_arch = "wasm32")]
pub use screen::install;
