//! The thumbnails of the gallery.

use crate::shell::{cargo, command, root, run, target};
use anyhow::{Context, Result, bail};
use std::path::PathBuf;

/// Width of a thumbnail in pixels; its height follows the picture's frame.
const WIDTH: u32 = 320;

/// The program `sinew`, built for speed.
pub fn sinew() -> Result<PathBuf> {
    run(&mut cargo(&["build", "--release", "--package", "cli"]))?;
    Ok(target()
        .join("release/sinew")
        .with_extension(std::env::consts::EXE_EXTENSION))
}

/// The datasets of the gallery, in the order of their names.
pub fn datasets() -> Result<Vec<PathBuf>> {
    let folder = root().join("www/examples");
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "rat"))
        .collect();
    files.sort();
    if files.is_empty() {
        bail!("{} holds no datasets", folder.display());
    }
    Ok(files)
}

/// Draws every dataset.
pub fn draw() -> Result<()> {
    let sinew = sinew()?;
    for dataset in datasets()? {
        let path = dataset.to_string_lossy();
        let scene = crate::shell::read(&mut command(&sinew, &["scene", &path]))
            .with_context(|| format!("{path} has errors; see: sinew check {path}"))?;
        let scene: serde_json::Value = serde_json::from_str(&scene)?;
        let side = |i: usize| {
            scene["settings"]["frame"][i]
                .as_f64()
                .filter(|side| *side > 0.0)
        };
        let (Some(width), Some(height)) = (side(0), side(1)) else {
            bail!("sinew scene {path} tells no frame size");
        };
        let height = (f64::from(WIDTH) * height / width).round().max(1.0);
        let picture = dataset.with_extension("png");
        run(&mut command(
            &sinew,
            &[
                "render",
                &path,
                "-o",
                &picture.to_string_lossy(),
                "-r",
                &WIDTH.to_string(),
                &height.to_string(),
                "-s",
                "4",
            ],
        ))?;
    }
    Ok(())
}
