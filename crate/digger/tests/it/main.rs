//! The tests of `digger`, as one program: a module for each subject.

mod root_finders;
