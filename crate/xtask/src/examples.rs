//! The thumbnails of the gallery, and the pictures of the reference.

use crate::pictures::{self, program, size_within};
use crate::shell::{cargo, command, files, root, run, target, words};
use anyhow::{Result, bail};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The pixels that a thumbnail fits into: those of the gallery's cards, 4:3.
const THUMBNAIL: [f64; 2] = [272.0, 204.0];
/// Half the size of a picture in a page of 1440 × 900 points.
const HALF: [f64; 2] = [400.0, 300.0];
/// Seconds that one thread of the program may take at [`HALF`] the size, if two workers of the page
/// are to draw the whole picture within 15 s: it has four times the pixels, and wasm takes up to
/// 1.7 times as long.
const PATIENCE: f64 = 15.0 * 2.0 / (4.0 * 1.7);
/// The list of examples that take longer, one a line.
const SLOW: &str = "crate/document/src/slow.txt";
/// The size of a picture in the reference.
const REFERENCE: [u32; 2] = [240, 180];

/// Draws the thumbnails of all datasets, or of those named without their extension, and lists which
/// of them take long. The machine should have nothing else to do.
pub fn draw(names: &[String]) -> Result<()> {
    let mut datasets = files(&root().join("www/examples"), "rat")?;
    let folder = root().join("www/examples");
    let list = root().join(SLOW);
    let mut slow = keep_names(&fs::read_to_string(&list)?, &datasets);
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
        let name = dataset.file_stem().unwrap_or_default().to_string_lossy();
        if seconds(&sinew, &dataset)? > PATIENCE {
            slow.insert(name.into_owned());
        } else {
            slow.remove(&*name);
        }
    }
    let lines: String = slow.iter().map(|name| format!("{name}\n")).collect();
    Ok(fs::write(list, lines)?)
}

/// Returns those names of a list, one a line, that files have without their extension.
fn keep_names(list: &str, files: &[PathBuf]) -> BTreeSet<String> {
    let lines = list.lines().filter(|line| {
        let mut stems = files.iter().filter_map(|file| file.file_stem());
        stems.any(|stem| stem == *line)
    });
    lines.map(str::to_owned).collect()
}

/// Measures how long one thread takes to draw a dataset at [`HALF`] the size, as finely as its text
/// says.
fn seconds(sinew: &Path, dataset: &Path) -> Result<f64> {
    let size = size_within(sinew, dataset, HALF)?.map(|side| side.to_string());
    let picture = target().join("slow.png");
    let begun = Instant::now();
    let mut render = command(
        sinew,
        &["render", "--threads", "1", "-r", &size[0], &size[1]],
    );
    run(render.arg(dataset).arg("-o").arg(picture))?;
    Ok(begun.elapsed().as_secs_f64())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_example_that_is_gone_leaves_the_list() {
        let files = ["examples/coils.rat", "examples/tide.rat"].map(PathBuf::from);
        let kept = keep_names("coils\ngone\ntid\n", &files);
        assert_eq!(kept, BTreeSet::from([String::from("coils")]));
    }
}
