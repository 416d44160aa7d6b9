//! PNG files of one picture, and animated ones.

use crate::picture::{check_room, check_size};
use crate::timing::Timing;
use crate::{Picture, Problem};
use std::io::{Cursor, Write};

const NAME: &str = "PNG";

/// Bytes the decoder may use besides the picture: tables and texts of the file.
const MAX_BESIDES: usize = 16 << 20;

fn damage(why: &dyn std::fmt::Display) -> Problem {
    Problem::Damaged(NAME, why.to_string())
}

/// Reads width and height from the head of a file.
pub fn size(bytes: &[u8]) -> Result<[u32; 2], Problem> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    let header = decoder.read_header_info().map_err(|error| damage(&error))?;
    check_size(header.width, header.height)?;
    Ok([header.width, header.height])
}

/// Reads the first picture of a file, whatever its depth and kind of colour.
pub fn decode(bytes: &[u8], max_pixels: u64) -> Result<Picture, Problem> {
    let limits = png::Limits { bytes: MAX_BESIDES };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    decoder.set_ignore_text_chunk(true);
    let header = decoder.read_header_info().map_err(|error| damage(&error))?;
    let (width, height) = (header.width, header.height);
    check_room(width, height, max_pixels)?;
    let mut reader = decoder.read_info().map_err(|error| damage(&error))?;
    let size = reader
        .output_buffer_size()
        .ok_or(Problem::Size(width.into(), height.into()))?;
    let mut raw = vec![0; size];
    let frame = reader
        .next_frame(&mut raw)
        .map_err(|error| damage(&error))?;
    raw.truncate(frame.buffer_size());
    let pixels = match frame.color_type {
        png::ColorType::Rgba => raw,
        png::ColorType::Rgb => spread(&raw, |p: [u8; 3]| [p[0], p[1], p[2], 255]),
        png::ColorType::GrayscaleAlpha => spread(&raw, |p: [u8; 2]| [p[0], p[0], p[0], p[1]]),
        png::ColorType::Grayscale => spread(&raw, |p: [u8; 1]| [p[0], p[0], p[0], 255]),
        // The transformation above has replaced indices by colours.
        png::ColorType::Indexed => return Err(damage(&"its colours cannot be read")),
    };
    Picture::new(frame.width, frame.height, pixels)
}

fn spread<const N: usize>(raw: &[u8], pixel: fn([u8; N]) -> [u8; 4]) -> Vec<u8> {
    raw.as_chunks::<N>()
        .0
        .iter()
        .flat_map(|&p| pixel(p))
        .collect()
}

/// Writes a file; one of an opaque picture has no channel for opacity, which saves a quarter.
pub fn encode(picture: &Picture) -> Result<Vec<u8>, Problem> {
    let opaque = picture.is_opaque();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(colour_type(opaque));
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder
        .write_header()
        .map_err(|error| not_written(&error))?;
    if opaque {
        writer.write_image_data(&picture.rgb())
    } else {
        writer.write_image_data(picture.pixels())
    }
    .map_err(|error| not_written(&error))?;
    writer.finish().map_err(|error| not_written(&error))?;
    Ok(bytes)
}

fn colour_type(opaque: bool) -> png::ColorType {
    if opaque {
        png::ColorType::Rgb
    } else {
        png::ColorType::Rgba
    }
}

fn not_written(error: &png::EncodingError) -> Problem {
    Problem::NotWritten(NAME, error.to_string())
}

/// An animated file that is being written. What does not know animations shows the first frame.
pub struct Animated<W: Write> {
    writer: png::Writer<W>,
    opaque: bool,
}

impl<W: Write> Animated<W> {
    /// Begins a file for `frames` frames like `first`, which decides whether there is an opacity.
    pub fn begin(to: W, first: &Picture, frames: u32, timing: Timing) -> Result<Self, Problem> {
        let opaque = first.is_opaque();
        let mut encoder = png::Encoder::new(to, first.width(), first.height());
        encoder.set_color(colour_type(opaque));
        encoder.set_depth(png::BitDepth::Eight);
        let writer = encoder
            .set_animated(frames, u32::from(!timing.repeats))
            .and_then(|()| encoder.set_frame_delay(timing.delay, 100))
            .and_then(|()| encoder.write_header())
            .map_err(|error| not_written(&error))?;
        Ok(Self { writer, opaque })
    }

    /// Adds a frame.
    pub fn add(&mut self, frame: &Picture) -> Result<(), Problem> {
        if self.opaque {
            self.writer.write_image_data(&frame.rgb())
        } else {
            self.writer.write_image_data(frame.pixels())
        }
        .map_err(|error| not_written(&error))
    }

    /// Ends the file.
    pub fn finish(self) -> Result<(), Problem> {
        self.writer.finish().map_err(|error| not_written(&error))
    }
}
