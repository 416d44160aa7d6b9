//! The place of the page where a mesh is sculpted with virtual tools (`sculpt`), drawn by
//! `viewport`. What is done is written as a text of strokes, which is the truth: the page keeps it
//! like any other text.
//!
//! - [`Document`]: a text of strokes with the mesh that they make; undo and redo without limit.
//! - [`Brush`]: the tool in hand.
//! - [`Sculpting`] and [`show`]: the place, in all of an egui `Ui`; it lists [`Command`]s for the
//!   page.
//!
//! ```
//! use modeling::Document;
//!
//! let mut load = |name: &str| Err(format!("there is no {name}"));
//! let mut document = Document::open("strokes 1\nstart sphere 4 # a ball\n", &mut load)?;
//! document.carry_out(sculpt::Stroke::Refine(sculpt::Refinement::Propagate))?;
//! assert_eq!(document.text(), "strokes 1\nstart sphere 4 # a ball\nrefine propagate\n");
//! document.undo()?;
//! assert_eq!(document.text(), "strokes 1\nstart sphere 4 # a ball\n");
//! # Ok::<(), String>(())
//! ```

mod brush;
mod document;
mod drawn;
mod grip;
mod hand;
mod keys;
mod panel;
mod place;
mod state;

pub use brush::{Brush, Doing};
pub use document::Document;
pub use drawn::surface_of;
pub use keys::KEYS;
pub use place::show;
pub use state::{Command, Flesh, Outside, Sculpting};
