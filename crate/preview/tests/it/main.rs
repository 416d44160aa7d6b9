//! The tests of `preview`, as one program: a module for each subject.

mod common;
mod pictures;
mod shaders;
mod shapes;
mod sheet;
mod traced;
