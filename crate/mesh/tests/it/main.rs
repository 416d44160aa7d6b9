//! The tests of `mesh`, as one program: a module for each subject.

mod any_bytes;
mod bvh;
mod common;
mod exports;
mod formats;
mod half_edge;
mod intersect;
mod odd;
mod rigs;
mod simplify;
mod solids;
