//! The tests of `metaballs`, as one program: a module for each subject.

mod common;
mod function;
