//! A picture: width, height and the bytes of its pixels.

use crate::Problem;
use crate::limits::{MAX_PIXELS, MAX_SIDE};

/// A picture of red, green, blue and opacity, each 0 … 255, rows from the top.
///
/// It has at least one pixel, and never more than [`MAX_PIXELS`]. Colours are not multiplied by
/// opacity.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl std::fmt::Debug for Picture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Picture({}×{})", self.width, self.height)
    }
}

impl Picture {
    /// A picture from its bytes, four for each pixel.
    ///
    /// # Errors
    /// If a side is 0 or more than [`MAX_SIDE`], if there are more than [`MAX_PIXELS`] pixels, or
    /// if the number of bytes is not four times that of the pixels.
    pub fn new(width: u32, height: u32, pixels: Vec<u8>) -> Result<Self, Problem> {
        let needed = 4 * check_size(width, height)?;
        let found = pixels.len() as u64;
        if needed != found {
            return Err(Problem::ByteCount { needed, found });
        }
        Ok(Self {
            width,
            height,
            pixels,
        })
    }

    /// A picture of one colour.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does if the size is not possible.
    pub fn filled(width: u32, height: u32, colour: [u8; 4]) -> Result<Self, Problem> {
        let count = usize::try_from(check_size(width, height)?)
            .map_err(|_| Problem::Size(width.into(), height.into()))?;
        Self::new(width, height, colour.repeat(count))
    }

    /// Pixels in a row, 1 … [`MAX_SIDE`].
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows, 1 … [`MAX_SIDE`].
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The bytes, four for each pixel, rows from the top.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// The bytes, given away.
    #[must_use]
    pub fn into_pixels(self) -> Vec<u8> {
        self.pixels
    }

    /// The pixel in a column and a row; `None` outside.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y as usize * self.width as usize + x as usize);
        self.pixels.get(at..at + 4)?.try_into().ok()
    }

    /// Whether nothing shows through.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.pixels.chunks_exact(4).all(|pixel| pixel[3] == 255)
    }

    /// The bytes without the opacity, three for each pixel.
    #[must_use]
    pub fn rgb(&self) -> Vec<u8> {
        self.pixels
            .chunks_exact(4)
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect()
    }

    /// Copies a picture onto this one with its upper left corner at (x, y); what falls outside is
    /// cut off.
    pub fn put(&mut self, x: u32, y: u32, other: &Self) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize;
        if columns == 0 {
            return;
        }
        let from = 4 * other.width as usize;
        let to = 4 * self.width as usize;
        let rows = self.pixels.chunks_exact_mut(to).skip(y as usize);
        for (row, source) in rows.zip(other.pixels.chunks_exact(from)) {
            let at = 4 * x as usize;
            row[at..at + 4 * columns].copy_from_slice(&source[..4 * columns]);
        }
    }

    pub(crate) fn pixels_mut(&mut self) -> &mut [u8] {
        &mut self.pixels
    }
}

/// The number of pixels of a picture of this size, if there may be one.
pub(crate) fn check_size(width: u32, height: u32) -> Result<u64, Problem> {
    let count = u64::from(width) * u64::from(height);
    let sides = 1..=MAX_SIDE;
    if !sides.contains(&width) || !sides.contains(&height) || count > MAX_PIXELS {
        return Err(Problem::Size(width.into(), height.into()));
    }
    Ok(count)
}

/// Checks a size like [`check_size`], and that it has at most `most` pixels.
pub(crate) fn check_room(width: u32, height: u32, most: u64) -> Result<u64, Problem> {
    let count = check_size(width, height)?;
    if count > most {
        let size = [width, height];
        return Err(Problem::NoRoom { size, most });
    }
    Ok(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        for (width, height) in [(0, 1), (1, 0), (65_536, 1), (8193, 8192), (65_535, 65_535)] {
            assert_eq!(
                check_size(width, height),
                Err(Problem::Size(width.into(), height.into()))
            );
            assert!(Picture::filled(width, height, [0; 4]).is_err());
        }
        assert_eq!(check_size(8192, 8192), Ok(MAX_PIXELS));
        assert_eq!(check_size(65_535, 1), Ok(65_535));
        assert_eq!(
            Picture::new(2, 2, vec![0; 15]),
            Err(Problem::ByteCount {
                needed: 16,
                found: 15
            })
        );
    }

    #[test]
    fn pixels_and_copies_stay_inside() {
        let mut sheet = Picture::filled(3, 2, [1, 2, 3, 255]).expect("a picture");
        let dot = Picture::filled(2, 2, [9, 9, 9, 255]).expect("a picture");
        sheet.put(2, 1, &dot);
        sheet.put(3, 0, &dot);
        sheet.put(0, 2, &dot);
        sheet.put(u32::MAX, u32::MAX, &dot);
        assert_eq!(sheet.pixel(2, 1), Some([9, 9, 9, 255]));
        assert_eq!(sheet.pixel(1, 1), Some([1, 2, 3, 255]));
        assert_eq!(sheet.pixel(2, 0), Some([1, 2, 3, 255]));
        assert_eq!(sheet.pixel(3, 0), None);
        assert_eq!(sheet.pixel(0, 2), None);
    }
}
