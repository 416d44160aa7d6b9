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
    let indices = dithered(&palette, info.width as usize, &pixels);
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

/// Differences between a colour and the nearest of the palette that are not seen, of 255.
const UNSEEN: f32 = 3.0;

/// Indices of a palette for a picture's RGBA bytes. Where the palette has no colour near enough, as on a wide gradient of many hues, the
/// difference is handed on to the neighbours (Floyd and Steinberg 1976), so that no blotches are seen; elsewhere the bytes
/// stay even, which makes the file small.
fn dithered(palette: &color_quant::NeuQuant, width: usize, pixels: &[u8]) -> Vec<u8> {
    // Differences that the rest of this row and the next one have been handed, with a column on either side.
    let mut rows = [vec![[0.0_f32; 3]; width + 2], vec![[0.0; 3]; width + 2]];
    let colours = palette.color_map_rgb();
    let mut indices = Vec::with_capacity(pixels.len() / 4);
    for row in pixels.chunks_exact(4 * width) {
        for (x, pixel) in row.chunks_exact(4).enumerate() {
            let handed = rows[0][x + 1];
            let wanted: [f32; 3] = core::array::from_fn(|k| f32::from(pixel[k]) + handed[k]);
            let [r, g, b] = wanted.map(|c| c.clamp(0.0, 255.0).round() as u8);
            let index = palette.index_of(&[r, g, b, 255]);
            indices.push(index as u8);
            // Colours beyond those of the palette must not bleed far.
            let wanted = [r, g, b].map(f32::from);
            let rest: [f32; 3] =
                core::array::from_fn(|k| wanted[k] - f32::from(colours[3 * index + k]));
            if rest.iter().all(|c| c.abs() <= UNSEEN) {
                continue;
            }
            for (row, x, share) in [
                (0, x + 2, 7.0),
                (1, x, 3.0),
                (1, x + 1, 5.0),
                (1, x + 2, 1.0),
            ] {
                for k in 0..3 {
                    rows[row][x][k] += rest[k] * share / 16.0;
                }
            }
        }
        rows.swap(0, 1);
        rows[1].fill([0.0; 3]);
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A palette that is far too small, and one that has all colours.
    #[test]
    fn dithering_keeps_the_mean_and_touches_nothing_that_fits() {
        let ramp = |i: usize| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 128, 255];
        let pixels: Vec<u8> = (0..64 * 64).flat_map(ramp).collect();
        let palette = color_quant::NeuQuant::new(1, 64, &pixels);
        let colours = palette.color_map_rgb();
        let indices = dithered(&palette, 64, &pixels);
        // How far the means of squares of 4 by 4 pixels are off, so that blotches would be seen.
        let nearest = pixels.chunks_exact(4).map(|p| palette.index_of(p) as u8);
        let off = |indices: &[u8]| {
            let mut all = 0.0_f64;
            for (x, y) in (0..16).flat_map(|y| (0..16).map(move |x| (4 * x, 4 * y))) {
                let mut sum = [0.0; 3];
                for i in (0..16).map(|i| (y + i / 4) * 64 + x + i % 4) {
                    for k in 0..3 {
                        let shown = colours[3 * usize::from(indices[i]) + k];
                        sum[k] += (f64::from(shown) - f64::from(pixels[4 * i + k])) / 16.0;
                    }
                }
                all += sum.iter().map(|s| s * s).sum::<f64>() / 768.0;
            }
            all.sqrt()
        };
        let plain: Vec<u8> = nearest.collect();
        let (dithered, plain) = (off(&indices), off(&plain));
        assert!(dithered < 0.65 * plain, "{dithered} {plain}");
        let grey = |i: usize| {
            if i.is_multiple_of(2) {
                [10, 10, 10, 255]
            } else {
                [200, 200, 200, 255]
            }
        };
        let grey: Vec<u8> = (0..64 * 8).flat_map(grey).collect();
        let two = color_quant::NeuQuant::new(1, 64, &grey);
        let kept = self::dithered(&two, 64, &grey);
        let direct: Vec<u8> = grey
            .chunks_exact(4)
            .map(|p| two.index_of(p) as u8)
            .collect();
        assert_eq!(kept, direct);
    }
}
