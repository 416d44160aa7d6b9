//! The tests of `skeleton`, as one program: a module for each subject.

mod curves;
mod weights;
