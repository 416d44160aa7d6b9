//! The tests of `studio`, as one program: a module for each subject.

mod card;
mod draw;
mod driver;
mod editor;
mod files;
mod film;
mod fonts;
mod hands;
mod lab;
mod sliders;
mod software;
mod tray;
mod window;
mod works;
