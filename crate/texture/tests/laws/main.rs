//! Laws of textures and of the closed forms of shading.
#[macro_use]
mod common;

mod bits;
mod layers;
mod mapping;
mod noise;
mod shading;
mod solids;
