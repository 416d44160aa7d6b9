//! Helpers of the draft's tests: devices, read-back of pictures, and independent definitions of shapes.

#![allow(dead_code, reason = "no test uses all of it")]

pub mod gpu;
pub mod reference;
pub mod scenes;
