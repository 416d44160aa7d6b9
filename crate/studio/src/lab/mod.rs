//! The lab: eight small lessons, each one figure to take hold of, that show how a convolution
//! surface comes about. Each has its own link (`#lab=kernels`), and opening one leaves the open
//! work alone.
//!
//! A lesson keeps its own numbers, draws its figure with [`plot`] and can write a dataset that shows
//! the same thing in the editor. Small traced pictures come from [`pictures`], which lends the
//! workers from the main picture while that rests.

mod bench;
pub mod chart;
pub mod contour;
pub mod convolution;
pub mod formulas;
pub mod grid;
pub mod kernels;
mod page;
pub mod pictures;
pub mod plot;
pub mod profiles;
pub mod sample;
pub mod slice;
pub mod spans;
mod state;
pub mod superposition;
mod text;
mod tools;

pub use crate::lesson::Lesson;
pub use page::{Frame, show};
pub use state::{Lab, Report};
