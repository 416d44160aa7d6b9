//! The tests of `worker`, as one program: a module for each subject.

#[macro_use]
mod common;
mod pins;
mod same;
mod speed;
