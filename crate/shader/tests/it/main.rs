//! Tests of the formulas in WGSL: they are those of `field`.

mod files;
mod gpu;
mod values;
