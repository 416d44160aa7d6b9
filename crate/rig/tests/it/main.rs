//! The tests of `rig`, as one program: a module for each subject.

mod rigs;
