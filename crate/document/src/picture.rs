//! Pixels and files of a traced picture.

pub use pool::Image;
use tracer::Tile;

/// Returns the RGBA pixels of a tile of a picture.
#[must_use]
pub fn cut(image: &Image, tile: Tile) -> Vec<u8> {
    let width = image.size[0] as usize;
    let mut rgba = Vec::with_capacity((tile.width * tile.height * 4) as usize);
    for y in tile.y..tile.y + tile.height {
        let start = (y as usize * width + tile.x as usize) * 4;
        rgba.extend_from_slice(&image.rgba[start..start + tile.width as usize * 4]);
    }
    rgba
}

/// Encodes the picture as a PNG file.
///
/// # Errors
/// Only if the encoder refuses the size.
pub fn png(image: &Image) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.size[0], image.size[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&image.rgba)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cut_and_png_agree_with_the_pixels() {
        let image = Image {
            size: [4, 2],
            rgba: (0..32).collect(),
        };
        let tile = Tile {
            x: 2,
            y: 0,
            width: 2,
            height: 2,
        };
        assert_eq!(
            cut(&image, tile),
            [8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31]
        );
        let bytes = png(&image).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut rgba = vec![0; 32];
        reader.next_frame(&mut rgba).unwrap();
        assert_eq!(rgba, image.rgba);
    }
}
