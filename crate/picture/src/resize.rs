//! A picture in another size.

use crate::limits::MAX_BETWEEN;
use crate::picture::check_size;
use crate::{Picture, Problem};
use image::imageops::{self, FilterType};
use image::{ImageBuffer, Rgba};

/// A picture in another size, filtered with the cubic of Catmull and Rom.
///
/// That filter keeps edges sharp, and it is a polynomial, so the result is the same on every
/// machine. Colours are mixed as they are stored; the edge of something that shows through is
/// tinged with the colour behind it.
///
/// # Errors
/// If the new size is not possible, or if old width times new height is more than [`MAX_BETWEEN`].
pub fn resize(picture: &Picture, width: u32, height: u32) -> Result<Picture, Problem> {
    check_size(width, height)?;
    if picture.size() == [width, height] {
        return Ok(picture.clone());
    }
    if u64::from(picture.width()) * u64::from(height) > MAX_BETWEEN {
        return Err(Problem::TooMuchBetween);
    }
    let [old_width, old_height] = picture.size();
    let source = ImageBuffer::<Rgba<u8>, &[u8]>::from_raw(old_width, old_height, picture.pixels())
        .ok_or(Problem::Size(old_width.into(), old_height.into()))?;
    let resized = imageops::resize(&source, width, height, FilterType::CatmullRom);
    Picture::new(width, height, resized.into_raw())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_colour_stays_one_colour() {
        let colour = [200, 100, 7, 255];
        let picture = Picture::filled(7, 5, colour).expect("a picture");
        for (width, height) in [(1, 1), (14, 10), (3, 40), (7, 5)] {
            let resized = resize(&picture, width, height).expect("resized");
            assert_eq!(
                Ok(resized),
                Picture::filled(width, height, colour),
                "{width}×{height}"
            );
        }
    }

    #[test]
    fn half_the_size_is_the_mean() {
        // Stripes of one pixel, black and white: what is left is gray, not one of the two.
        let pixels = (0..64 * 64)
            .flat_map(|i| [[0, 0, 0, 255], [255; 4]][i % 2])
            .collect();
        let stripes = Picture::new(64, 64, pixels).expect("a picture");
        let half = resize(&stripes, 32, 32).expect("resized");
        let middle = half.pixel(16, 16).expect("inside");
        assert!((120..=136).contains(&middle[0]), "{middle:?}");
    }

    #[test]
    fn memory_is_bounded() {
        let tall = Picture::filled(1, 60_000, [0; 4]).expect("a picture");
        assert!(resize(&tall, 1, 30_000).is_ok());
        let wide = Picture::filled(60_000, 1, [0; 4]).expect("a picture");
        assert_eq!(resize(&wide, 1, 60_000), Err(Problem::TooMuchBetween));
        assert_eq!(resize(&wide, 0, 5), Err(Problem::Size(0, 5)));
        assert_eq!(
            resize(&wide, 60_000, 60_000),
            Err(Problem::Size(60_000, 60_000))
        );
    }
}
