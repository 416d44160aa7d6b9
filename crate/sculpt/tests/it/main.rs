//! The tests of `sculpt`, as one program: a module for each subject.

mod bad_input;
mod common;
mod creatures;
mod platforms;
mod random;
mod refinements;
mod scripts;
mod sweeps;
mod tools;
