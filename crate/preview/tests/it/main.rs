//! The tests of `preview`, as one program: a module for each subject.

mod common;
mod pictures;
mod refusals;
mod shaders;
mod traced;
