//! Image operations: runs the commands of the language's TOOLS group (`collage`, `resize`, `diff`,
//! `animate` …).
//!
//! The language lists the jobs ([`rats::Tool`]), and the crate `picture` computes. A [`Bench`]
//! reads the pictures that a job names, runs it, and writes the results. A [`Shelf`] is the store
//! of pictures: a folder for the program, the files of the open work for the page. Both have the
//! same results and messages.
//!
//! ```
//! use darkroom::{Bench, Shelf, Step, Target};
//!
//! /// A store without pictures.
//! struct Empty;
//!
//! impl Shelf for Empty {
//!     fn read(&self, name: &str) -> Result<Vec<u8>, String> {
//!         Err(format!("there is no {name}"))
//!     }
//!     fn create(&self, name: &str) -> Result<Box<dyn Target>, String> {
//!         Err(format!("cannot write {name}"))
//!     }
//! }
//!
//! let play = rats::Tool::Play { file: "film.png".into() };
//! let mut bench = Bench::new(Empty, vec![play]);
//! let mut failed = 0;
//! while let Some(step) = bench.step() {
//!     failed += usize::from(matches!(step, Step::Finished(Err(_))));
//! }
//! assert_eq!(failed, 1);
//! ```
//!
//! A text may be untrusted: names that lead out of its own folder, and names of datasets for a
//! result, are refused before a shelf sees them ([`name`]). A job runs in steps of at most one
//! picture each, so that a page can draw in between.

mod bench;
mod files;
pub mod name;
mod shelf;
mod work;

pub use bench::{Bench, Step};
pub use files::{Done, write};
pub use shelf::{Shelf, Target};

#[cfg(test)]
mod tests;
