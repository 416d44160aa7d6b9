//! The tests of `fit`, as one program: a module for each subject.

mod recovery;
mod sibson;
