//! The tests of `contact`, as one program: a module for each subject.

mod bulge;
mod folded;
mod squashed;
mod volume;
