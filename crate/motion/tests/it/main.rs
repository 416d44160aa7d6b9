//! The tests of `motion`, as one program: a module for each subject.

mod field;
mod physics;
mod platforms;
