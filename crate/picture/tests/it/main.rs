//! The tests of `picture`, as one program: a module for each subject.

mod files;
