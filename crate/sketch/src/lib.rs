//! Strokes of a hand as curves of few nodes, and the text of a skeleton that is made of them.
//!
//! A [`Stroke`] gathers what a hand draws on the screen, [`fit()`] smooths it, [`create`] and
//! [`extend`] write it into a text; [`remove`], [`remove_curve`], [`cut`] and [`widen`] change what
//! is there. On a picture, [`Sight`] leads from places to points of the screen and back, [`drawn`]
//! finds the text's skeletons, [`edits`] makes changes of texts of gestures, and [`page`] is the
//! text that drawing begins with.
//!
//! ```
//! use glam::DVec3;
//! use sketch::{Limb, Sample, Start, create, fit};
//!
//! let sample = |i: u32| Sample {
//!     position: DVec3::new(f64::from(i), 0.0, 0.0),
//!     radius: 0.5,
//! };
//! let samples: Vec<Sample> = (0..100).map(sample).collect();
//! let nodes = fit(&samples, 0.1).unwrap();
//! let limb = Limb { start: Start::Free, nodes };
//! let text = create("", "clay", "animal", &[limb], 0.1).unwrap();
//! assert_eq!(text, "\
//! skeleton clay, animal {
//!   node n1 <0 0 0> radius 0.5
//!   node n2 <99 0 0> radius 0.5
//!   curve n1 n2
//! }
//! ");
//! ```

mod block;
pub mod drawn;
mod edit;
pub mod edits;
mod fit;
pub mod page;
mod sight;
mod stroke;

pub use block::{Block, CurveText, NodeText};
pub use drawn::Drawn;
pub use edit::{
    Limb, Start, create, cut, extend, free_name, insert, remove, remove_curve, widen,
    without_commands,
};
pub use fit::{MOST_NODES, Sample, fit};
pub use sight::Sight;
pub use stroke::{Mark, Stroke};
