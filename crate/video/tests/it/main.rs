//! The tests of `video`, as one program: a module for each subject.

mod files;
