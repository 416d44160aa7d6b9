//! The tests of `worker`, as one program: a module for each subject.

mod bits;
mod common;
mod pins;
#[cfg(not(target_arch = "wasm32"))]
mod same;
mod speed;
