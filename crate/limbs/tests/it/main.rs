//! The tests of `limbs`, as one program: a module for each subject.

mod any_bytes;
mod common;
mod lines;
mod molecules;
mod odd;
mod recipe;
mod shape;
mod swc;
mod three_mf;
mod trees;
mod vtk;
mod write;
