//! The tests of `rats`, as one program: a module for each subject.

mod any_text;
mod commands;
mod deform;
mod diagnostics;
mod examples;
mod limits;
mod links;
mod looks;
mod motion;
mod platforms;
mod strokes;
