//! The tests of `field`, as one program: a module for each subject. As wasm, where only bits can
//! differ, they are compared, and speed is measured.

mod bits;
#[cfg(not(target_arch = "wasm32"))]
mod blob;
#[cfg(not(target_arch = "wasm32"))]
mod blob_chain;
#[cfg(not(target_arch = "wasm32"))]
mod chart;
mod chart_figures;
#[cfg(not(target_arch = "wasm32"))]
mod composed;
#[cfg(not(target_arch = "wasm32"))]
mod conformance;
#[cfg(not(target_arch = "wasm32"))]
mod far_field;
#[cfg(not(target_arch = "wasm32"))]
mod far_out;
#[cfg(not(target_arch = "wasm32"))]
mod influence;
#[cfg(not(target_arch = "wasm32"))]
mod laws;
#[cfg(not(target_arch = "wasm32"))]
mod local;
#[cfg(not(target_arch = "wasm32"))]
mod logarithm;
#[cfg(not(target_arch = "wasm32"))]
mod real;
#[cfg(not(target_arch = "wasm32"))]
mod sliced;
#[cfg(not(target_arch = "wasm32"))]
mod spans;
#[cfg(not(target_arch = "wasm32"))]
mod taper;
