//! Sculpting of polygon meshes with virtual tools, after Bill and Lodha (1995). Knows meshes and
//! fields, no pages.
//!
//! - [`Clay`]: a mesh of polygons with masks, colours and a region; refinements, smoothing, holes
//!   and deletions.
//! - [`Tool`]: a superquadric that pushes, pulls, smooths, masks, paints or chooses along a path
//!   ([`Sweep`]); [`Decay`] spreads its motion over neighbours. [`Body`]: a body of a model as a
//!   tool.
//! - [`Script`]: strokes as text, the truth about a sculpture; [`COMMANDS`] is its grammar.
//! - [`Sculpture`]: strokes carried out, with undo; [`replay`] carries a text out without it.
//!
//! ```
//! use sculpt::{Script, replay};
//!
//! let text = "
//! strokes 1
//! start sphere 6
//! symmetry x
//! pull sphere 0.3 0.3 0.3 cusp 0.6 : 0.5 0 0.9, 0.6 0 1.6   # two horns
//! region sphere 0.5 0.5 0.5 : 0.5 0 1.2
//! loop
//! ";
//! let script: Script = text.trim_start().parse()?;
//! let mut load = |name: &str| Err(format!("there is no {name}"));
//! let clay = replay(&script, &mut load, 1_000_000, |_, _, _| ())?;
//! assert!(clay.mesh().is_closed());
//! let top = clay.mesh().vertices().map(|v| clay.mesh().position(v).z);
//! assert!(top.fold(0.0, f64::max) > 1.4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The same strokes give the same bits everywhere: only `libm`, no order of hashes, no threads. A
//! tool searches vertices in a grid that is updated with every vertex that moves, so a step costs
//! what it touches.
//!
//! Files, from the ground: `tool` and `solid` (what is inside), `grid` (which vertices are near),
//! `spread` (decay along edges), `clay` (the state), `editor` (edits that keep masks and colours),
//! `refine`, `smooth`, `holes`, `region`, `drag` (a tool at work), `stroke`, `parse`, `write`,
//! `script`, `sculpture`.

mod clay;
mod decay;
mod delta;
mod drag;
mod editor;
mod error;
mod grammar;
mod grid;
mod holes;
pub mod limits;
mod parse;
mod perform;
mod refine;
mod region;
mod script;
mod sculpture;
mod smooth;
mod solid;
mod spread;
mod start;
mod stroke;
mod tool;
mod write;

pub use clay::{Clay, Region};
pub use decay::Decay;
pub use drag::Drag;
pub use error::Error;
pub use grammar::{COMMANDS, Command, DECAY, PATH, TOOL};
pub use holes::Deletion;
pub use perform::Loader;
pub use refine::Refinement;
pub use region::{Choice, RegionChange};
pub use script::{Diagnostic, Script};
pub use sculpture::{Sculpture, replay};
pub use solid::{Body, Solid};
pub use start::{Shape, Start};
pub use stroke::{Action, Beginning, Constraint, MaskChange, PathPoint, Stroke, Sweep};
pub use tool::{Form, Tool};
