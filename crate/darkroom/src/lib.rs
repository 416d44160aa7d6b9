//! The TOOLS group of the language, carried out: `collage`, `resize`, `diff`, `animate` …
//!
//! The language only lists the jobs ([`rats::Tool`]), and the crate `picture` only computes. Here a
//! [`Bench`] reads the pictures that a job names, works, and writes the results. Where pictures lie is
//! the affair of a [`Shelf`]: a folder for the program, the files of the open work for the page.
//! Both do the same and say the same.
//!
//! A text may come from a stranger. Names that lead out of the text's own folder, and names of
//! datasets for a result, are refused before a shelf sees them ([`name`]). A job goes on in steps of at
//! most one picture each, so that a page can draw itself in between.

mod bench;
pub mod name;
mod shelf;
mod work;

pub use bench::{Bench, Done, Step, write};
pub use shelf::{Shelf, Target};

#[cfg(test)]
mod tests;
