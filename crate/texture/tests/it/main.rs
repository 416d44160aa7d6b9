//! The tests of `texture`, as one program: a module for each subject. As wasm, where only bits
//! can differ, they are compared.

mod bits;
#[cfg(not(target_arch = "wasm32"))]
mod common;
#[cfg(not(target_arch = "wasm32"))]
mod layers;
#[cfg(not(target_arch = "wasm32"))]
mod mapping;
#[cfg(not(target_arch = "wasm32"))]
mod noise;
#[cfg(not(target_arch = "wasm32"))]
mod shading;
#[cfg(not(target_arch = "wasm32"))]
mod solids;
