//! The tests of `tracer`, as one program: a module for each subject.

mod bodies;
mod certified;
mod energy;
mod examples;
mod folds;
mod glass;
mod hits;
mod judged;
mod looks;
mod paint;
mod picture;
mod povray;
mod room;
mod spread;
mod textures;
mod touching;
