//! Pictures that the program `sinew` draws, and their files.

use crate::shell::{Build, cargo, command, read, run, target, words};
use anyhow::{Context, Result, bail};
use color_quant::NeuQuant;
use png::{BitDepth, ColorType};
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

/// Builds the program `sinew` for speed, in the usual way or as `build` says.
pub fn sinew(build: Option<Build>) -> Result<PathBuf> {
    let mut cargo = cargo(&words("build --release --package cli"));
    run(cargo.envs(build.into_iter().flat_map(Build::settings)))?;
    let folder = build.map_or_else(target, Build::target);
    let program = folder.join("release/sinew");
    Ok(program.with_extension(std::env::consts::EXE_EXTENSION))
}

/// Returns the program `sinew` that draws pictures: the one that the environment variable `SINEW`
/// names, as each build draws the same, else one built for speed.
pub fn program() -> Result<PathBuf> {
    std::env::var_os("SINEW").map_or_else(|| sinew(None), |path| Ok(path.into()))
}

/// Draws a dataset to a PNG file with a palette, with n×n rays a pixel.
pub fn draw(program: &Path, text: &Path, picture: &Path, size: [u32; 2], n: &str) -> Result<()> {
    let [width, height] = size.map(|side| side.to_string());
    let mut render = command(program, &["render", "-s", n, "-r", &width, &height]);
    run(render.arg(text).arg("-o").arg(picture))?;
    reduce(picture).with_context(|| picture.display().to_string())
}

/// Computes the size of a dataset's picture that fits into a box of pixels.
pub fn size_within(sinew: &Path, dataset: &Path, within: [f64; 2]) -> Result<[u32; 2]> {
    let path = dataset.to_string_lossy();
    let scene = read(&mut command(sinew, &["scene", &path]))
        .with_context(|| format!("{path} has errors; see: sinew check {path}"))?;
    let scene: serde_json::Value = serde_json::from_str(&scene)?;
    let frame = &scene["settings"]["frame"];
    let (Some(width), Some(height)) = (frame[0].as_f64(), frame[1].as_f64()) else {
        bail!("sinew scene {path} tells no frame size");
    };
    let scale = (within[0] / width).min(within[1] / height);
    Ok([width, height].map(|side| (scale * side).round().max(1.0) as u32))
}

/// Reads a picture's size and kind, and its bytes.
pub fn read_picture(path: &Path) -> Result<(png::OutputInfo, Vec<u8>)> {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
    decoder.set_transformations(png::Transformations::ALPHA);
    let mut reader = decoder.read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().context("too large")?];
    let info = reader.next_frame(&mut pixels)?;
    pixels.truncate(info.buffer_size());
    Ok((info, pixels))
}

/// Writes a picture of RGB bytes, or if there is a palette, of its indices.
pub fn write_picture(
    path: &Path,
    width: u32,
    bytes: &[u8],
    palette: Option<Vec<u8>>,
) -> Result<()> {
    let channels = if palette.is_some() { 1 } else { 3 };
    let height = u32::try_from(bytes.len())? / (channels * width);
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), width, height);
    encoder.set_color(ColorType::Rgb);
    if let Some(palette) = palette {
        encoder.set_color(ColorType::Indexed);
        encoder.set_palette(palette);
        encoder.set_compression(png::Compression::High);
        // Neighbouring indices have nothing to do with each other.
        encoder.set_filter(png::Filter::NoFilter);
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    Ok(writer.finish()?)
}

/// Returns the number of pixels that differ, and their largest difference in a channel.
pub fn difference(a: &[u8], b: &[u8], channels: usize) -> (usize, u8) {
    let pixels = a.chunks_exact(channels).zip(b.chunks_exact(channels));
    let most = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max();
    (pixels.filter(|(a, b)| a != b).count(), most.unwrap_or(0))
}

/// Writes a picture anew with a palette, which takes less than half the bytes: pictures travel
/// inside the app, where every kB counts.
fn reduce(path: &Path) -> Result<()> {
    let (info, pixels) = read_picture(path)?;
    if (info.color_type, info.bit_depth) != (ColorType::Rgba, BitDepth::Eight) {
        bail!("not a picture of 8 bits a channel");
    }
    let palette = NeuQuant::new(1, 256, &pixels);
    let indices = dither(&palette, info.width as usize, &pixels);
    write_picture(path, info.width, &indices, Some(palette.color_map_rgb()))
}

/// Largest invisible difference between a colour and the nearest of the palette, of 255.
const UNSEEN: f32 = 3.0;

/// Returns indices of a palette for a picture's RGBA bytes. Where the palette has no colour near
/// enough, as on a wide gradient of many hues, the difference is passed on to the neighbours (Floyd
/// and Steinberg 1976), so that no blotches are seen; elsewhere the bytes stay even, which makes
/// the file small.
fn dither(palette: &NeuQuant, width: usize, pixels: &[u8]) -> Vec<u8> {
    let colours = palette.color_map_rgb();
    // Differences passed on to each pixel, with a column on either side and a row below.
    let stride = width + 2;
    let mut passed = vec![[0.0_f32; 3]; stride * (pixels.len() / 4 / width + 1)];
    let mut indices = Vec::with_capacity(pixels.len() / 4);
    for (i, pixel) in pixels.chunks_exact(4).enumerate() {
        let at = stride * (i / width) + i % width + 1;
        // Colours beyond those of the palette must not bleed far.
        let wanted = [0, 1, 2].map(|k| {
            (f32::from(pixel[k]) + passed[at][k])
                .clamp(0.0, 255.0)
                .round()
        });
        let [r, g, b] = wanted.map(|c| c as u8);
        let index = palette.index_of(&[r, g, b, 255]);
        indices.push(index as u8);
        let rest = [0, 1, 2].map(|k| wanted[k] - f32::from(colours[3 * index + k]));
        if rest.iter().all(|c| c.abs() <= UNSEEN) {
            continue;
        }
        for (ahead, share) in [
            (1, 7.0),
            (stride - 1, 3.0),
            (stride, 5.0),
            (stride + 1, 1.0),
        ] {
            for k in 0..3 {
                passed[at + ahead][k] += rest[k] * share / 16.0;
            }
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(palette: &NeuQuant, pixels: &[u8]) -> Vec<u8> {
        let pixels = pixels.chunks_exact(4);
        pixels.map(|pixel| palette.index_of(pixel) as u8).collect()
    }

    /// Tests a palette that is far too small, and one that has all colours.
    #[test]
    fn dithering_keeps_the_mean_and_touches_nothing_that_fits() {
        let pixels: Vec<u8> = (0..64 * 64)
            .flat_map(|i| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 128, 255])
            .collect();
        let palette = NeuQuant::new(1, 64, &pixels);
        let colours = palette.color_map_rgb();
        // Error of the sums of red in squares of 4 by 4 pixels, which is seen as blotches.
        let errors = [dither(&palette, 64, &pixels), nearest(&palette, &pixels)];
        let [dithered, plain] = errors.map(|indices| {
            let mut sums = [0; 256];
            for (i, index) in indices.into_iter().enumerate() {
                let shown = i32::from(colours[3 * usize::from(index)]);
                sums[i / 256 * 16 + i % 64 / 4] += shown - i32::from(pixels[4 * i]);
            }
            f64::from(sums.map(|sum| sum * sum).iter().sum::<i32>()).sqrt()
        });
        assert!(dithered < 0.65 * plain, "{dithered}");
        let grey = [10, 10, 10, 255, 200, 200, 200, 255].repeat(256);
        let two = NeuQuant::new(1, 64, &grey);
        assert_eq!(dither(&two, 64, &grey), nearest(&two, &grey));
    }

    #[test]
    fn pixels_that_differ_are_counted() {
        let a = [0, 1, 2, 255, 9, 9, 9, 255, 0, 0, 0, 255];
        let b = [0, 4, 1, 255, 9, 9, 9, 255, 1, 0, 0, 255];
        assert_eq!(difference(&a, &a, 4), (0, 0));
        assert_eq!(difference(&a, &b, 4), (2, 3));
    }
}
