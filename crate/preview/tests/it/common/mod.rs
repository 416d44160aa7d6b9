//! Helpers of the draft's tests: devices, and pictures read back.

pub mod scenes;
pub mod traced;
