//! Several pictures on one sheet.

use crate::limits::{MAX_PIXELS, MAX_SHEET, MAX_SIDE};
use crate::picture::check_room;
use crate::{Picture, Problem};

/// Colour between pictures of different sizes.
const BACKGROUND: [u8; 4] = [0, 0, 0, 255];

/// Pictures in rows on one sheet, each in its own size and in the middle of its place; all places
/// are as large as the largest picture. Without a number of `columns` about as many stand side by
/// side as below each other, but two side by side.
///
/// # Errors
/// If there are no pictures or more than [`MAX_SHEET`], if `columns` is 0, or if the sheet would be
/// larger than a picture may be.
pub fn collage(pictures: &[Picture], columns: Option<usize>) -> Result<Picture, Problem> {
    collage_at_most(pictures, columns, MAX_PIXELS)
}

/// [`collage`] for whoever has less memory: a sheet of more than `max_pixels` is refused.
///
/// # Errors
/// Fails as [`collage`] does.
pub fn collage_at_most(
    pictures: &[Picture],
    columns: Option<usize>,
    max_pixels: u64,
) -> Result<Picture, Problem> {
    let count = pictures.len();
    if !(1..=MAX_SHEET).contains(&count) {
        return Err(Problem::SheetCount(count));
    }
    let columns = match columns {
        Some(0) => return Err(Problem::NoColumns),
        Some(columns) => columns.min(count),
        None => (1..).find(|n| n * n >= count).unwrap_or(count),
    };
    let rows = count.div_ceil(columns);
    let [width, height] =
        [Picture::width, Picture::height].map(|side| pictures.iter().map(side).max().unwrap_or(1));
    let whole = [(width, columns), (height, rows)].map(|(cell, n)| u64::from(cell) * n as u64);
    let [sheet_width, sheet_height] = whole.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    if sheet_width > MAX_SIDE || sheet_height > MAX_SIDE {
        return Err(Problem::Size(whole[0], whole[1]));
    }
    check_room(sheet_width, sheet_height, max_pixels)?;
    let mut sheet = Picture::filled(sheet_width, sheet_height, BACKGROUND)?;
    let mut places = (0..rows as u32).flat_map(|y| (0..columns as u32).map(move |x| (x, y)));
    for (picture, (x, y)) in pictures.iter().zip(&mut places) {
        sheet.put(
            x * width + (width - picture.width()) / 2,
            y * height + (height - picture.height()) / 2,
            picture,
        );
    }
    Ok(sheet)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, height: u32, level: u8) -> Picture {
        Picture::filled(width, height, [level, level, level, 255]).expect("a picture")
    }

    #[test]
    fn two_stand_side_by_side_and_five_in_two_rows() {
        let pictures: Vec<Picture> = (1..=5).map(|level| picture(4, 2, level)).collect();
        let two = collage(&pictures[..2], None).expect("a sheet");
        assert_eq!(two.size(), [8, 2]);
        let five = collage(&pictures, None).expect("a sheet");
        assert_eq!(five.size(), [12, 4]);
        assert_eq!(five.pixel(0, 0), Some([1, 1, 1, 255]));
        assert_eq!(five.pixel(11, 1), Some([3, 3, 3, 255]));
        assert_eq!(five.pixel(7, 3), Some([5, 5, 5, 255]));
        assert_eq!(five.pixel(11, 3), Some(BACKGROUND));
        assert_eq!(
            collage(&pictures, Some(99)).expect("a sheet").size(),
            [20, 2]
        );
        assert_eq!(
            collage(&pictures, Some(1)).expect("a sheet").size(),
            [4, 10]
        );
    }

    #[test]
    fn smaller_pictures_stand_in_the_middle() {
        let sheet = collage(&[picture(4, 4, 1), picture(2, 2, 2)], None).expect("a sheet");
        assert_eq!(sheet.pixel(4, 0), Some(BACKGROUND));
        assert_eq!(sheet.pixel(5, 1), Some([2, 2, 2, 255]));
        assert_eq!(sheet.pixel(6, 2), Some([2, 2, 2, 255]));
        assert_eq!(sheet.pixel(7, 3), Some(BACKGROUND));
    }

    #[test]
    fn limits() {
        assert_eq!(collage(&[], None), Err(Problem::SheetCount(0)));
        let dots = vec![picture(1, 1, 1); MAX_SHEET + 1];
        assert_eq!(
            collage(&dots, None),
            Err(Problem::SheetCount(MAX_SHEET + 1))
        );
        assert_eq!(collage(&dots[..2], Some(0)), Err(Problem::NoColumns));
        let wide = vec![picture(65_535, 1, 1); 2];
        assert_eq!(collage(&wide, None), Err(Problem::Size(131_070, 1)));
        // A wide and a tall one: every place is as large as both.
        let cross = [picture(60_000, 1, 1), picture(1, 60_000, 1)];
        assert!(matches!(
            collage(&cross, Some(1)),
            Err(Problem::Size(60_000, _))
        ));
    }
}
