//! JPEG files.
//!
//! The decoder uses no vector instructions of the processor, so that textures have the same bits
//! on every machine.

use crate::picture::{check_room, check_size};
use crate::{Picture, Problem};
use jpeg_decoder::{Decoder, Error, PixelFormat};

fn damage(error: &Error) -> Problem {
    Problem::Damaged("JPEG", error.to_string())
}

/// A decoder, the size and the kind of pixels of a file.
type Opened<'a> = (Decoder<&'a [u8]>, [u32; 2], PixelFormat);

/// Reads the head of a file.
fn open(bytes: &[u8]) -> Result<Opened<'_>, Problem> {
    let mut decoder = Decoder::new(bytes);
    decoder.read_info().map_err(|error| damage(&error))?;
    let info = decoder
        .info()
        .ok_or_else(|| Problem::Damaged("JPEG", String::from("it has no head")))?;
    let size = [info.width, info.height].map(u32::from);
    Ok((decoder, size, info.pixel_format))
}

/// Reads width and height from the head of a file.
pub fn size(bytes: &[u8]) -> Result<[u32; 2], Problem> {
    let (_, size, _) = open(bytes)?;
    check_size(size[0], size[1])?;
    Ok(size)
}

/// Reads a picture.
pub fn decode(bytes: &[u8], max_pixels: u64) -> Result<Picture, Problem> {
    let (mut decoder, [width, height], format) = open(bytes)?;
    let pixels = check_room(width, height, max_pixels)?;
    decoder.set_max_decoding_buffer_size(pixels as usize * format.pixel_bytes());
    let values = decoder.decode().map_err(|error| damage(&error))?;
    let rgba = values.chunks_exact(format.pixel_bytes());
    let rgba = rgba.flat_map(|pixel| match *pixel {
        [grey] => [grey, grey, grey, 255],
        [red, green, blue] => [red, green, blue, 255],
        [a, b] => {
            let grey = (u16::from_ne_bytes([a, b]) >> 8) as u8;
            [grey, grey, grey, 255]
        }
        [cyan, magenta, yellow, black] => {
            let light = u16::from(255 - black);
            let [red, green, blue] =
                [cyan, magenta, yellow].map(|ink| (u16::from(255 - ink) * light / 255) as u8);
            [red, green, blue, 255]
        }
        _ => [0, 0, 0, 255],
    });
    Picture::new(width, height, rgba.collect())
}
