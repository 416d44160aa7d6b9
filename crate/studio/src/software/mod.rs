//! Draws the window on the processor, for browsers with neither WebGPU nor WebGL2, and for those that have
//! the processor pretend to be a graphics card.
//!
//! eframe only paints with a GPU. So it is given a wgpu device that does nothing (`device`),
//! while a plugin of egui (`screen`) takes the shapes that egui wants painted, and puts them on
//! the canvas. `painter` finds the tiles of the window that changed since the last frame and
//! redraws them alone; `shape` says which pixels triangles and rectangles cover, `raster` fills
//! them, and `texture` keeps the pictures. The last two follow egui's own shader: colours are sRGB
//! values multiplied by their alpha, and are blended as such.

#[cfg(target_arch = "wasm32")]
mod device;
pub mod painter;
mod raster;
#[cfg(target_arch = "wasm32")]
mod screen;
mod shape;
mod texture;

#[cfg(target_arch = "wasm32")]
pub use device::setup;
#[cfg(target_arch = "wasm32")]
pub use screen::install;
