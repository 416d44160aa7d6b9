//! The tests of `archive`, as one program: a module for each subject.

mod archives;
