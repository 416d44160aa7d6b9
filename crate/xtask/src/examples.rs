//! The thumbnails of the gallery.

use crate::shell::{Build, cargo, command, root, run, target};
use anyhow::{Context, Result, bail};
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

/// The pixels that a thumbnail fits into: those of the gallery's cards, 4:3.
const BOX: [f64; 2] = [272.0, 204.0];
/// Colours of a thumbnail. They travel inside the app, where every kB counts.
const COLOURS: usize = 256;

/// The program `sinew`, built for speed.
pub fn sinew() -> Result<PathBuf> {
    run(&mut cargo(&["build", "--release", "--package", "cli"]))?;
    Ok(target()
        .join("release/sinew")
        .with_extension(std::env::consts::EXE_EXTENSION))
}

/// The program `sinew` that draws pictures: built for speed, or the one that the variable `SINEW` of the environment names, as each
/// build draws the same.
pub fn program() -> Result<PathBuf> {
    match std::env::var_os("SINEW") {
        Some(path) => Ok(PathBuf::from(path)),
        None => sinew(),
    }
}

/// The same built in another way.
pub fn sinew_built(build: Build) -> Result<PathBuf> {
    let mut cargo = cargo(&["build", "--release", "--package", "cli"]);
    run(cargo.envs(build.settings()))?;
    Ok(build
        .target()
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

/// Draws the thumbnails of all datasets, or of those named without their extension.
pub fn draw(names: &[String]) -> Result<()> {
    let sinew = program()?;
    let all = datasets()?;
    let stem = |path: &PathBuf| {
        path.file_stem()
            .map(|stem| stem.to_string_lossy().into_owned())
    };
    if let Some(name) = names
        .iter()
        .find(|name| !all.iter().any(|path| stem(path).as_ref() == Some(name)))
    {
        bail!("there is no www/examples/{name}.rat");
    }
    for dataset in all {
        if names.is_empty() || stem(&dataset).is_some_and(|stem| names.contains(&stem)) {
            draw_into(&sinew, &dataset, &dataset.with_extension("png"), BOX)?;
        }
    }
    Ok(())
}

/// Draws a dataset to a PNG file with a palette, as large as fits into a box of pixels.
pub fn draw_into(sinew: &Path, dataset: &Path, picture: &Path, within: [f64; 2]) -> Result<()> {
    let path = dataset.to_string_lossy();
    let scene = crate::shell::read(&mut command(sinew, &["scene", &path]))
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
    let scale = (within[0] / width).min(within[1] / height);
    let [width, height] = [width, height].map(|side| (scale * side).round().max(1.0).to_string());
    let to = picture.to_string_lossy();
    let size = ["-r", &width, &height, "-s", "4"];
    run(command(sinew, &["render", &path, "-o", &to]).args(size))?;
    reduce(picture).with_context(|| picture.display().to_string())
}

/// The size of the pictures in the reference page.
const REFERENCE: [u32; 2] = [240, 180];

/// Writes the reference page and draws the pictures of its examples.
pub fn reference() -> Result<()> {
    let sinew = program()?;
    let folder = root().join("www/reference");
    if folder.exists() {
        std::fs::remove_dir_all(&folder)?;
    }
    std::fs::create_dir_all(&folder)?;
    let example = ["run", "--package", "assist", "--example", "reference_texts"];
    run(cargo(&example).arg("--").arg(&folder))?;
    let mut texts: Vec<PathBuf> = std::fs::read_dir(&folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    texts.sort();
    let [width, height] = REFERENCE.map(|side| side.to_string());
    for text in texts {
        let picture = text.with_extension("png");
        let [text, to] = [&text, &picture].map(|path| path.to_string_lossy());
        let size = ["-r", &width, &height, "-s", "3"];
        run(command(&sinew, &["render", &text, "-o", &to]).args(size))?;
        reduce(&picture).with_context(|| to.to_string())?;
    }
    let page = ["test", "--package", "assist", "--test", "reference"];
    run(cargo(&page).env("UPDATE_EXPECT", "1"))
}

/// A picture's size and kind, and its bytes.
pub fn read_picture(path: &Path) -> Result<(png::OutputInfo, Vec<u8>)> {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
    decoder.set_transformations(png::Transformations::ALPHA);
    let mut reader = decoder.read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().context("too large")?];
    let info = reader.next_frame(&mut pixels)?;
    pixels.truncate(info.buffer_size());
    Ok((info, pixels))
}

/// Writes a picture of RGB bytes.
pub fn write_picture(path: &Path, width: u32, rgb: &[u8]) -> Result<()> {
    let height = rgb.len() / (3 * width as usize);
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, width, u32::try_from(height)?);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    Ok(writer.finish()?)
}

/// Writes a picture anew with a palette, which takes less than half the bytes.
fn reduce(path: &Path) -> Result<()> {
    let (info, pixels) = read_picture(path)?;
    if (info.color_type, info.bit_depth) != (png::ColorType::Rgba, png::BitDepth::Eight) {
        bail!("not a picture of 8 bits a channel");
    }
    let palette = color_quant::NeuQuant::new(1, COLOURS, &pixels);
    let indices: Vec<u8> = pixels
        .chunks_exact(4)
        .map(|pixel| palette.index_of(pixel) as u8)
        .collect();
    let mut encoder =
        png::Encoder::new(BufWriter::new(File::create(path)?), info.width, info.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    // Neighbouring indices have nothing to do with each other.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&indices)?;
    Ok(writer.finish()?)
}
