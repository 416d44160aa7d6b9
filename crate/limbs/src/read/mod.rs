//! Readers of files.

mod any;
mod csv;
mod elements;
mod molecule;
mod obj;
mod ply;
mod polydata;
mod radii;
mod swc;
mod three_mf;
mod vtk;
mod vtp;

use glam::DVec3;

pub use any::{Reading, read};
pub(crate) use obj::RADII_IN_VT;
pub(crate) use swc::TYPES;

/// Reads three words as a place; `None` if they are no numbers.
fn place<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<DVec3> {
    let mut numbers = words.map_while(|word| word.parse().ok());
    Some(DVec3::new(
        numbers.next()?,
        numbers.next()?,
        numbers.next()?,
    ))
}
