//! Skeletons of straight limbs, and the files that people have them in. Knows neither scenes nor
//! fields.
//!
//! - [`Graph`]: nodes with radii, [`Limb`]s between them with a radius at either end, names of
//!   their kinds, and remarks about what a file says otherwise.
//! - [`read`] makes one of the bytes of a file: SWC, 3MF with beam lattices, VTK's polygonal data,
//!   tables of a tree's cylinders, OBJ and PLY with lines, molecules in XYZ and PDB.
//! - [`Builder`] makes one of limbs from elsewhere.
//! - [`Graph::scale`], [`Graph::thicken`], [`Graph::merge`], [`Graph::simplify`] change one;
//!   [`Graph::facts`] counts its parts, cycles and ends.
//! - [`Recipe`]: all that is done to a file which takes long, as data.
//! - [`Graph::write_swc`], [`Graph::write_obj`], [`Graph::write_block`] write one.
//!
//! ```
//! let swc = b"1 1 0 0 0 5 -1\n2 3 0 8 0 1.5 1\n3 3 0 20 0 1 2\n";
//! let graph = limbs::read("n.swc", swc, &limbs::Reading::default())?.unwrap();
//! assert_eq!(graph.limbs.len(), 2);
//! assert!(graph.nodes[0].is_ball, "a soma of one node is a ball");
//! assert_eq!(graph.limbs[0].radii, [1.5, 1.5], "a branch keeps its radius at the soma");
//! # Ok::<(), limbs::Error>(())
//! ```
//!
//! Files are untrusted: every count is checked against the bytes that are there and against
//! [`limits`] before memory is allocated for it, and errors are sentences with a line.

mod build;
mod draft;
mod error;
mod graph;
pub mod limits;
mod merge;
mod read;
mod recipe;
mod simplify;
mod tidy;
mod write;

pub use build::Builder;
pub use error::{Error, Remark};
pub use graph::{Cap, Clip, Facts, Graph, Group, Limb, Node, Side};
pub use read::{Reading, read};
pub use recipe::Recipe;
pub use simplify::Chain;
pub use write::Written;
