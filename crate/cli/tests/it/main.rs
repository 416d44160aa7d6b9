//! The tests of `cli`, as one program: a module for each subject.

mod common;
mod fitting;
mod memory;
mod meshes;
mod probe_against_quadrature;
mod probe_contact;
mod program;
