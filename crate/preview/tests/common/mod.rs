//! What the draft's tests share: devices to draw on, pictures read back, and shapes defined anew.

#![allow(dead_code, reason = "no test uses all of it")]

pub mod gpu;
pub mod reference;
pub mod scenes;
