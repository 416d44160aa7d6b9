//! Heights out of a picture: a PNG file, dark is low and bright is high.

use crate::error::{Error, fail};
use crate::limits::{MAX_BYTES, MAX_PIXELS};
use png::{BitDepth, ColorType, Decoder, Limits, Transformations};
use std::io::Cursor;

/// Grid of heights.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    width: usize,
    values: Vec<f32>,
}

impl Heights {
    /// Returns a grid of values, row by row from the top, each 0 … 1. `None` if they do not fill
    /// rows of this width, if there are none, or if one is not within 0 … 1.
    #[must_use]
    pub fn new(width: usize, values: Vec<f32>) -> Option<Self> {
        let is_full = width > 0 && !values.is_empty() && values.len().is_multiple_of(width);
        let is_sound = values.iter().all(|v| (0.0..=1.0).contains(v));
        (is_full && is_sound && values.len() <= MAX_PIXELS).then_some(Self { width, values })
    }

    /// Pixels across.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Pixels down.
    #[must_use]
    pub fn height(&self) -> usize {
        self.values.len() / self.width
    }

    /// The height at a pixel, from the left and from the top.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }
}

/// Reads a PNG picture of 8 or 16 bits a channel (or a palette, or fewer bits). Of a coloured one
/// the luminance counts (Rec. 709's weights, of the values as they are stored); opacity does not.
///
/// # Errors
/// If it is no PNG, is broken, or is over one of the [`crate::limits`].
pub fn heights(bytes: &[u8]) -> Result<Heights, Error> {
    if !bytes.starts_with(b"\x89PNG") {
        return fail("heights are read from PNG pictures, and this is none");
    }
    if bytes.len() > MAX_BYTES {
        return fail(format!(
            "this PNG has more than {} MB",
            MAX_BYTES / 1_000_000
        ));
    }
    let limits = Limits { bytes: MAX_BYTES };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(unread)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.saturating_mul(height) > MAX_PIXELS {
        return fail(format!(
            "this PNG has {width} by {height} pixels, more than the {MAX_PIXELS} that are taken"
        ));
    }
    let (colour, depth) = reader.output_color_type();
    let channels = match colour {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
        // Palettes have been expanded.
        ColorType::Indexed => return fail("this PNG has a palette that cannot be read"),
    };
    let size = if depth == BitDepth::Sixteen { 2 } else { 1 };
    let mut values = Vec::with_capacity(width * height);
    let mut add = |row: &[u8]| {
        let pixels = row.chunks_exact(channels * size);
        values.extend(pixels.map(|pixel| luminance(pixel, size, channels >= 3)));
    };
    if reader.info().interlaced {
        // Rows come in no order.
        let whole = reader.output_buffer_size().unwrap_or(usize::MAX);
        if whole > 8 * MAX_PIXELS {
            return fail("this PNG is too large");
        }
        let mut buffer = vec![0; whole];
        reader.next_frame(&mut buffer).map_err(unread)?;
        add(&buffer);
    } else {
        while let Some(row) = reader.next_row().map_err(unread)? {
            add(row.data());
        }
    }
    Heights::new(width, values).ok_or_else(|| Error("this PNG is cut off".into()))
}

/// Returns the luminance of a pixel, 0 … 1, whose channels have `size` bytes.
fn luminance(pixel: &[u8], size: usize, is_colored: bool) -> f32 {
    let mut channels = pixel.chunks_exact(size).map(|channel| match *channel {
        [high, low] => f32::from(u16::from_be_bytes([high, low])) / 65535.0,
        _ => f32::from(channel[0]) / 255.0,
    });
    let [r, g, b] = core::array::from_fn(|_| channels.next().unwrap_or(0.0));
    if is_colored {
        (0.2126 * r + 0.7152 * g + 0.0722 * b).min(1.0)
    } else {
        r
    }
}

fn unread(error: png::DecodingError) -> Error {
    Error(format!("this PNG cannot be read: {error}"))
}
