//! The tests of `rats`, as one program: a module for each subject. As wasm only the bits are
//! tested.

#[cfg(not(target_arch = "wasm32"))]
mod any_text;
#[cfg(not(target_arch = "wasm32"))]
mod commands;
#[cfg(not(target_arch = "wasm32"))]
mod deform;
#[cfg(not(target_arch = "wasm32"))]
mod diagnostics;
#[cfg(not(target_arch = "wasm32"))]
mod ends;
#[cfg(not(target_arch = "wasm32"))]
mod exact;
#[cfg(not(target_arch = "wasm32"))]
mod examples;
#[cfg(not(target_arch = "wasm32"))]
mod limits;
#[cfg(not(target_arch = "wasm32"))]
mod links;
#[cfg(not(target_arch = "wasm32"))]
mod looks;
#[cfg(not(target_arch = "wasm32"))]
mod motion;
mod platforms;
#[cfg(not(target_arch = "wasm32"))]
mod skeleton_files;
#[cfg(not(target_arch = "wasm32"))]
mod soft_shapes;
#[cfg(not(target_arch = "wasm32"))]
mod softened;
#[cfg(not(target_arch = "wasm32"))]
mod strokes;
