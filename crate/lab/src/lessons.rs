//! The lessons, each in a file of its own, and their list.

mod centreline;
mod chart;
mod contact;
mod convolution;
mod fitting;
mod grid;
mod kernels;
mod profiles;
mod sculpting;
mod slice;
mod spans;
mod superposition;
mod textures;

use crate::lesson::{Entry, entry};

/// The lessons, in the order of the page.
pub static ALL: &[Entry] = &[
    entry::<kernels::Kernels>(&kernels::WORDS),
    entry::<convolution::Convolution>(&convolution::WORDS),
    entry::<slice::Slice>(&slice::WORDS),
    entry::<grid::Grid>(&grid::WORDS),
    entry::<profiles::Profiles>(&profiles::WORDS),
    entry::<chart::Chart>(&chart::WORDS),
    entry::<superposition::Superposition>(&superposition::WORDS),
    entry::<spans::Spans>(&spans::WORDS),
    entry::<contact::Contact>(&contact::WORDS),
    entry::<sculpting::Sculpting>(&sculpting::WORDS),
    entry::<fitting::Fitting>(&fitting::WORDS),
    entry::<textures::Textures>(&textures::WORDS),
    entry::<centreline::Centreline>(&centreline::WORDS),
];
