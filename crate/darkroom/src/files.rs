//! The files of a shelf: reading and writing pictures, and what is said of them.

use crate::{Shelf, Target, name};
use picture::{Format, Picture, Problem, file, resize};

/// A job that is done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// A sentence that says what was done.
    pub said: String,
    /// The files that the job wrote, or that it was to show.
    pub files: Vec<String>,
}

/// Returns a problem in words.
pub(crate) fn say(problem: Problem) -> String {
    problem.to_string()
}

/// The bytes of a file, and its format.
pub(crate) fn bytes(shelf: &dyn Shelf, from: &str) -> Result<(Vec<u8>, Format), String> {
    let format = name::for_reading(from)?;
    Ok((shelf.read(from)?, format))
}

/// A picture of the shelf.
pub(crate) fn read(shelf: &dyn Shelf, from: &str) -> Result<Picture, String> {
    let (bytes, format) = bytes(shelf, from)?;
    file::decode_at_most(&bytes, format, shelf.most_pixels())
        .map_err(|problem| format!("{from}: {problem}"))
}

/// Begins a file of the shelf.
pub(crate) fn create(shelf: &dyn Shelf, to: &str) -> Result<(Box<dyn Target>, Format), String> {
    let format = name::for_writing(to)?;
    Ok((shelf.create(to)?, format))
}

/// Writes a picture, and says so.
///
/// # Errors
/// If the name is refused or the file cannot be written.
pub fn write(shelf: &dyn Shelf, to: &str, picture: &Picture) -> Result<String, String> {
    let (mut target, format) = create(shelf, to)?;
    let bytes = file::encode(picture, format).map_err(say)?;
    target
        .write_all(&bytes)
        .map_err(|error| format!("cannot write {to}: {error}"))?;
    target.keep()?;
    let [width, height] = picture.size();
    Ok(format!("wrote {to}, {width}×{height}"))
}

/// Refuses a picture of more pixels than there is room for.
fn check_room(shelf: &dyn Shelf, size: [u64; 2]) -> Result<(), String> {
    let most = shelf.most_pixels();
    let [width, height] = size;
    if width.saturating_mul(height) > most {
        let size = size.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        return Err(say(Problem::NoRoom { size, most }));
    }
    Ok(())
}

/// Resizes a picture within the room of the shelf, which must also hold what is between the two
/// passes.
pub(crate) fn resize_within_room(
    shelf: &dyn Shelf,
    of: &str,
    picture: &Picture,
    size: [u32; 2],
) -> Result<Picture, String> {
    let [width, height] = size.map(u64::from);
    check_room(shelf, [width, height])
        .and_then(|()| check_room(shelf, [u64::from(picture.width()), height]))
        .and_then(|()| resize(picture, size[0], size[1]).map_err(say))
        .map_err(|sentence| format!("{of}: {sentence}"))
}

/// `film.gif: GIF, 3 frames of 8×6`.
pub(crate) fn measures(file: &str, format: Format, frames: usize, size: [u32; 2]) -> String {
    let number = match frames {
        1 => String::new(),
        _ => format!("{frames} frames of "),
    };
    let [width, height] = size;
    format!("{file}: {}, {number}{width}×{height}", format.name())
}
