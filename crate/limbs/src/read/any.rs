//! The reader of any format.

use super::{csv, molecule, obj, ply, swc, three_mf, vtk, vtp};
use crate::error::{Error, fail};
use crate::graph::Graph;
use crate::limits::MAX_BYTES;

/// Choices that a file leaves to its reader.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading<'a> {
    /// Radius where a file gives none at all.
    pub radius: Option<f64>,
    /// Name of the array or column of radii; `None` for the usual ones.
    pub radii: Option<&'a str>,
    /// Whether atoms that are near enough are joined by limbs.
    pub bonds: bool,
}

/// Reads a skeleton. The format follows from the ending of the file's name, in any case: `.swc`,
/// `.3mf`, `.vtp`, `.vtk`, `.csv`, `.obj`, `.ply`, `.xyz`, `.pdb`.
///
/// Returns `None` if the file is of a format that may hold a skeleton, but holds something else: a
/// mesh or points.
///
/// # Errors
/// If the file is of none of these formats, is broken, has no limbs, or is over one of the
/// [`crate::limits`].
pub fn read(name: &str, bytes: &[u8], reading: &Reading<'_>) -> Result<Option<Graph>, Error> {
    if bytes.len() > MAX_BYTES {
        return fail(format!(
            "this file has {} MB, more than the {} MB that are taken",
            bytes.len() / 1_000_000,
            MAX_BYTES / 1_000_000
        ));
    }
    let name = name.to_ascii_lowercase();
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    match ending {
        "3mf" => three_mf::read(bytes, reading),
        "csv" => csv::read(bytes, reading).map(Some),
        "obj" => obj::read(bytes, reading),
        "pdb" | "ent" => molecule::read_pdb(bytes, reading).map(Some),
        "ply" => ply::read(bytes, reading),
        "swc" => swc::read(bytes, reading).map(Some),
        "vtk" => vtk::read(bytes, reading).map(Some),
        "vtp" => vtp::read(bytes, reading).map(Some),
        "xyz" => molecule::read_xyz(bytes, reading),
        _ => fail(
            "skeletons are read from .swc, .3mf, .vtp, .vtk, .csv, .obj, .ply, .xyz and .pdb files",
        ),
    }
}
