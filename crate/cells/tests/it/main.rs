//! The tests of `cells`, as one program: a module for each subject.

mod work;
