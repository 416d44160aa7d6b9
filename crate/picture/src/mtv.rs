//! The format of Mark VandeWettering's ray tracer: a line `width height`, then three bytes a pixel.

use crate::picture::{check_room, check_size};
use crate::{Picture, Problem};
use std::iter;

/// Longest first line, bytes: two numbers, a space and the ends of lines of two systems.
const MAX_LINE: usize = 24;

fn damage(why: String) -> Problem {
    Problem::Damaged("MTV", why)
}

/// Reads width and height from the first line.
pub fn size(bytes: &[u8]) -> Result<[u32; 2], Problem> {
    let ([width, height], _) = head(bytes)?;
    check_size(width, height)?;
    Ok([width, height])
}

/// The first line, and what comes after it.
fn head(bytes: &[u8]) -> Result<([u32; 2], &[u8]), Problem> {
    let end = bytes
        .iter()
        .take(MAX_LINE)
        .position(|byte| *byte == b'\n')
        .ok_or_else(|| damage(String::from("it does not begin with a line `width height`")))?;
    let (line, rest) = (&bytes[..end], &bytes[end + 1..]);
    let numbers: Vec<Option<u32>> = std::str::from_utf8(line)
        .unwrap_or_default()
        .split_ascii_whitespace()
        .map(|word| word.parse().ok())
        .collect();
    let [Some(width), Some(height)] = numbers[..] else {
        return Err(damage(String::from("its first line is not `width height`")));
    };
    Ok(([width, height], rest))
}

/// Reads a file. Bytes behind the last pixel are left alone, as other programs do.
pub fn decode(bytes: &[u8], max_pixels: u64) -> Result<Picture, Problem> {
    let ([width, height], rest) = head(bytes)?;
    let count = check_room(width, height, max_pixels)?;
    let needed = 3 * count;
    let Some(rgb) = usize::try_from(needed).ok().and_then(|n| rest.get(..n)) else {
        return Err(damage(format!(
            "{width}×{height} pixels need {needed} bytes, it has {}",
            rest.len()
        )));
    };
    let pixels = rgb
        .chunks_exact(3)
        .flat_map(|pixel| pixel.iter().copied().chain(iter::once(255)))
        .collect();
    Picture::new(width, height, pixels)
}

/// Writes a file. The format knows no opacity.
pub fn encode(picture: &Picture) -> Vec<u8> {
    let mut bytes = format!("{} {}\n", picture.width(), picture.height()).into_bytes();
    bytes.extend(picture.rgb());
    bytes
}
