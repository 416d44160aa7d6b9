//! Colours to look at.

use crate::limits::MAX_SWATCHES;
use crate::{Picture, Problem, collage};

/// Side of a colour that stands alone, pixels.
const ALONE: u32 = 128;
/// Side of a colour among others, pixels.
const AMONG_OTHERS: u32 = 24;

/// Squares of colour in rows, each red, green, blue in 0 … 1; what lies beyond is taken as the
/// nearest that can be shown.
///
/// # Errors
/// If there are no colours or more than [`MAX_SWATCHES`].
pub fn swatches(colours: &[[f32; 3]]) -> Result<Picture, Problem> {
    if !(1..=MAX_SWATCHES).contains(&colours.len()) {
        return Err(Problem::SwatchCount(colours.len()));
    }
    let side = if colours.len() == 1 {
        ALONE
    } else {
        AMONG_OTHERS
    };
    let squares = colours
        .iter()
        .map(|colour| {
            // `as` takes what is not a number as 0.
            let [r, g, b] = colour.map(|level| (level * 255.0).round().clamp(0.0, 255.0) as u8);
            Picture::filled(side, side, [r, g, b, 255])
        })
        .collect::<Result<Vec<_>, _>>()?;
    collage(&squares, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_stand_in_rows() {
        let one = swatches(&[[1.0, 0.5, 0.0]]).expect("a picture");
        assert_eq!(one.size(), [128, 128]);
        assert_eq!(one.pixel(64, 64), Some([255, 128, 0, 255]));
        let many = swatches(&[[0.0; 3], [1.0; 3], [9.0, -1.0, f32::NAN]]).expect("a picture");
        assert_eq!(many.size(), [48, 48]);
        assert_eq!(many.pixel(30, 5), Some([255; 4]));
        assert_eq!(many.pixel(5, 30), Some([255, 0, 0, 255]));
        assert_eq!(swatches(&[]), Err(Problem::SwatchCount(0)));
        let few_too_many = vec![[0.0; 3]; MAX_SWATCHES + 1];
        assert!(swatches(&few_too_many).is_err());
    }
}
