//! The lab: small lessons, each one figure to take hold of, that show how a convolution
//! surface comes about. Each has its own link (`#lab=kernels`), and opening one leaves the open
//! work alone.
//!
//! A lesson keeps its own numbers, draws its figure with [`plot`] and can write a dataset that
//! shows the same thing in the editor. Small traced pictures come from [`pictures`], which lends
//! the workers from the main picture while that rests. The page around the lab carries out its
//! [`Command`]s.
//!
//! ```
//! # #[cfg(not(target_arch = "wasm32"))] {
//! use lab::{Command, Lab, Lesson};
//! use std::{cell::RefCell, rc::Rc};
//!
//! let pool = Rc::new(RefCell::new(pool::Pool::new(|| {})));
//! let mut lab = Lab::new(pool, Lesson::of_hash("#lab=kernels"));
//! let frame = lab::Frame {
//!     dataset: lab::Dataset::default(),
//!     tracing: None,
//!     theme: widgets::theme::Choice::Dark,
//!     now: 0.0,
//! };
//! let mut commands: Vec<Command> = Vec::new();
//! let output = egui::Context::default().run_ui(egui::RawInput::default(), |ui| {
//!     lab::show(&mut lab, &frame, ui, &mut commands);
//! });
//! output.drop_without_applying_deltas();
//! assert_eq!(lab.report().map(|report| report.title), Some("Kernels"));
//! assert!(commands.is_empty());
//! # }
//! ```

mod bench;
mod command;
mod dataset;
mod figure;
pub mod formulas;
mod lesson;
mod lessons;
mod page;
pub mod pictures;
mod plane;
pub mod plot;
pub mod sample;
mod state;
mod tools;

pub use command::Command;
pub use dataset::Dataset;
pub use figure::Words;
pub use lesson::Lesson;
pub use page::{Frame, show};
pub use state::{Lab, Report};
