//! The tests of `texture`, as one program: a module for each subject.

#[macro_use]
mod common;
mod bits;
mod layers;
mod mapping;
mod noise;
mod shading;
mod solids;
