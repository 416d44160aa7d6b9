//! Names of files as a text gives them: which may be read, and which may be written.

use picture::Format;
use std::path::{Component, Path};

/// Endings of the names of datasets, which nothing is written over.
pub const DATASETS: [&str; 4] = ["rat", "art", "ice", "dat"];

/// Whether a name is that of a dataset.
#[must_use]
pub fn is_dataset(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    DATASETS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(ending))
}

/// Whether a name stays in the folder that it starts from, as far as the name itself tells.
#[must_use]
pub fn stays_inside(name: &str) -> bool {
    Path::new(name)
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

/// A name without a `./` before it.
#[must_use]
pub fn plain(name: &str) -> &str {
    let mut name = name;
    while let Some(rest) = name.strip_prefix("./") {
        name = rest;
    }
    name
}

/// Message about a name that leads out of the folder.
#[must_use]
pub fn outside(name: &str) -> String {
    format!("{name} leads out of the dataset's folder; put the picture into that folder")
}

/// The format of a picture that is to be read.
///
/// # Errors
/// If the name leads out of the folder or does not tell a format.
pub fn for_reading(name: &str) -> Result<Format, String> {
    if !stays_inside(name) {
        return Err(outside(name));
    }
    Format::of(Path::new(name)).map_err(|problem| problem.to_string())
}

/// The format of a picture that is to be written.
///
/// # Errors
/// If the name leads out of the folder, is that of a dataset or does not tell a format.
pub fn for_writing(name: &str) -> Result<Format, String> {
    if stays_inside(name) && is_dataset(name) {
        return Err(format!(
            "{name} is a dataset and is not written over; choose a name ending in one of {}",
            Format::ENDINGS
        ));
    }
    for_reading(name)
}

/// `a/b.png` → (`a/b`, `.png`).
#[must_use]
pub fn split(name: &str) -> (&str, &str) {
    match name.rfind('.') {
        Some(dot) if !name[dot..].contains(['/', '\\']) => name.split_at(dot),
        _ => (name, ""),
    }
}
