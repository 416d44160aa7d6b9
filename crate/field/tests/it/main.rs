//! The tests of `field`, as one program: a module for each subject.

#[macro_use]
mod common;
mod blob;
mod blob_chain;
mod chart;
mod chart_figures;
mod composed;
mod conformance;
mod far_field;
mod far_out;
mod influence;
mod laws;
mod local;
mod logarithm;
mod real;
mod spans;
mod taper;
