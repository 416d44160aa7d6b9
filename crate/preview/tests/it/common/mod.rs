//! Helpers of the draft's tests: devices, read-back of pictures, and independent definitions of
//! shapes.

pub mod gpu;
pub mod reference;
pub mod scenes;
pub mod traced;
