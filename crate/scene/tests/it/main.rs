//! The tests of `scene`, as one program: a module for each subject.

mod curves;
mod scene;
