//! The tests of `sculpt`, as one program: a module for each subject. As wasm only the bits are
//! tested.

#[cfg(not(target_arch = "wasm32"))]
mod bad_input;
#[cfg(not(target_arch = "wasm32"))]
mod creatures;
mod platforms;
#[cfg(not(target_arch = "wasm32"))]
mod random;
#[cfg(not(target_arch = "wasm32"))]
mod refinements;
#[cfg(not(target_arch = "wasm32"))]
mod scripts;
mod strokes;
#[cfg(not(target_arch = "wasm32"))]
mod sweeps;
#[cfg(not(target_arch = "wasm32"))]
mod tools;
