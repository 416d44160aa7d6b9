//! An entry of the tray: a result, or the reason why there is none.

use ::picture::animation::{self, Frames};
use ::picture::{Format, Picture, Problem, file, resize};
use document::asset;
use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use std::path::Path;
use std::sync::Arc;

use document::desk::MAX_PIXELS;

/// Longest side of a thumbnail, pixels.
const THUMBNAIL: u32 = 256;

/// An entry of the tray.
pub struct Item {
    /// Index of the job that made it.
    pub job: usize,
    /// The command that made it.
    pub command: &'static str,
    /// Message of the job.
    pub message: String,
    /// Visible content.
    pub content: Content,
}

/// Visible content.
pub enum Content {
    /// A picture or an animation.
    File(Film),
    /// A job that has no picture.
    Sentence,
    /// A job that could not be done.
    Refused,
}

/// The file of a picture or an animation.
pub struct Film {
    /// The file's name.
    pub name: String,
    /// The content.
    pub bytes: Arc<[u8]>,
    /// The decoded picture, once it was needed; the inner option is `None` if it is damaged.
    pub look: Option<Option<Look>>,
}

/// Facts and thumbnail of a picture.
#[derive(Clone)]
pub struct Look {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Whether there is more than one frame.
    pub moves: bool,
    /// The first frame, small.
    pub thumbnail: TextureHandle,
}

impl Item {
    /// Returns the file, if there is one.
    #[must_use]
    pub fn film(&self) -> Option<&Film> {
        match &self.content {
            Content::File(film) => Some(film),
            _ => None,
        }
    }

    /// Whether the job could not be done.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        matches!(self.content, Content::Refused)
    }

    /// Returns the title: the file's name, or the command's.
    #[must_use]
    pub fn title(&self) -> &str {
        self.film().map_or(self.command, |film| &film.name)
    }
}

impl Film {
    /// Returns the format by the name.
    fn format(&self) -> Result<Format, Problem> {
        Format::of(Path::new(&self.name))
    }

    /// Returns the media type of the file.
    #[must_use]
    pub fn mime(&self) -> &'static str {
        match self.format() {
            Ok(Format::Png) => "image/png",
            Ok(Format::Gif) => "image/gif",
            Ok(Format::Tif) => "image/tiff",
            Ok(Format::Jpg) => "image/jpeg",
            _ => "application/octet-stream",
        }
    }

    /// Returns size, format and length in a few words.
    #[must_use]
    pub fn facts(&self) -> String {
        let kind = self.format().map_or("", Format::name);
        let bytes = asset::size(self.bytes.len());
        match &self.look {
            Some(Some(look)) => {
                let [width, height] = look.size;
                let moves = if look.moves { ", an animation" } else { "" };
                format!("{width} × {height} pixels, {kind}{moves}, {bytes}")
            }
            _ => format!("{kind}, {bytes}"),
        }
    }

    /// Returns the frames from the first one on; `None` if the format has only one or it cannot be
    /// read.
    #[must_use]
    pub fn frames(&self) -> Option<Frames<'static>> {
        let format = self.format().ok()?;
        matches!(format, Format::Png | Format::Gif)
            .then(|| animation::frames_at_most(self.bytes.clone(), format, MAX_PIXELS).ok())?
    }

    /// Returns the first frame, and whether there are more.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn first(&self) -> Result<(Picture, bool), Problem> {
        if let Some(mut frames) = self.frames()
            && let Some(first) = frames.next()
        {
            return Ok((first?, frames.next().is_some()));
        }
        let picture = file::decode_at_most(&self.bytes, self.format()?, MAX_PIXELS)?;
        Ok((picture, false))
    }

    /// Decodes the first frame, unless that was done before. Returns whether it did.
    pub fn decode(&mut self, ctx: &Context) -> bool {
        if self.look.is_some() {
            return false;
        }
        let look = self.first().map(|(picture, moves)| Look {
            size: picture.size(),
            moves,
            thumbnail: texture(ctx, &picture, THUMBNAIL),
        });
        self.look = Some(look.ok());
        true
    }
}

/// Makes a texture of a picture, shrunk if a side is longer than `longest`.
pub fn texture(ctx: &Context, picture: &Picture, longest: u32) -> TextureHandle {
    let longest = longest.min(ctx.input(|input| input.max_texture_side) as u32);
    let small = shrink(picture, longest);
    let picture = small.as_ref().unwrap_or(picture);
    let size = picture.size().map(|side| side as usize);
    let pixels = ColorImage::from_rgba_unmultiplied(size, picture.pixels());
    ctx.load_texture("result", pixels, TextureOptions::LINEAR)
}

/// Shrinks a picture so that its longer side is `longest`; `None` if it is no longer than that.
fn shrink(picture: &Picture, longest: u32) -> Option<Picture> {
    let [width, height] = picture.size();
    let larger = width.max(height);
    if larger <= longest {
        return None;
    }
    let [width, height] = [width, height].map(|side| {
        let side = u64::from(side) * u64::from(longest) / u64::from(larger);
        (side as u32).max(1)
    });
    resize(picture, width, height).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_shown_small_and_keep_their_proportions() {
        for (size, expected) in [
            ([1024, 512], Some([256, 128])),
            ([256, 256], None),
            ([4000, 3], Some([256, 1])),
        ] {
            let picture = Picture::filled(size[0], size[1], [9, 9, 9, 255]).unwrap();
            let small = shrink(&picture, 256).map(|picture| picture.size());
            assert_eq!(small, expected);
        }
    }
}
