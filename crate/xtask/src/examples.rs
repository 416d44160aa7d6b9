//! The thumbnails of the gallery, and the pictures of the reference.

use crate::pictures::{self, program, size_within};
use crate::shell::{cargo, files, root, run, words};
use anyhow::{Result, bail};
use std::fs;

/// The pixels that a thumbnail fits into: those of the gallery's cards, 4:3.
const THUMBNAIL: [f64; 2] = [272.0, 204.0];
/// The size of a picture in the reference.
const REFERENCE: [u32; 2] = [240, 180];

/// Draws the thumbnails of all datasets, or of those named without their extension.
pub fn draw(names: &[String]) -> Result<()> {
    let mut datasets = files(&root().join("www/examples"), "rat")?;
    let folder = root().join("www/examples");
    for name in names {
        if !datasets.contains(&folder.join(name).with_extension("rat")) {
            bail!("there is no www/examples/{name}.rat");
        }
    }
    datasets.retain(|dataset| {
        let stem = dataset.file_stem().unwrap_or_default();
        names.is_empty() || names.iter().any(|name| stem == name.as_str())
    });
    let sinew = program()?;
    for dataset in datasets {
        let size = size_within(&sinew, &dataset, THUMBNAIL)?;
        pictures::draw(&sinew, &dataset, &dataset.with_extension("png"), size, "4")?;
    }
    Ok(())
}

/// Writes the reference page and draws the pictures of its examples.
pub fn reference() -> Result<()> {
    let sinew = program()?;
    let folder = root().join("www/reference");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    let texts = words("run --package assist --example reference_texts --");
    run(cargo(&texts).arg(&folder))?;
    for text in files(&folder, "rat")? {
        pictures::draw(&sinew, &text, &text.with_extension("png"), REFERENCE, "3")?;
    }
    let page = words("test --package assist --test it reference::");
    run(cargo(&page).env("UPDATE_EXPECT", "1"))
}
