//! The tests of `motion`, as one program: a module for each subject. As wasm only the bits are
//! tested.

#[cfg(not(target_arch = "wasm32"))]
mod field;
#[cfg(not(target_arch = "wasm32"))]
mod physics;
mod platforms;
