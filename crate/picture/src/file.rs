//! Pictures as the bytes of files, and back.

use crate::limits::MAX_PIXELS;
use crate::{Picture, Problem, mtv, png_file};
use std::ffi::OsStr;
use std::path::Path;

/// A format of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Portable Network Graphics; holds animations.
    Png,
    /// Mark VandeWettering's ray tracer.
    Mtv,
    /// Truevision TGA.
    #[cfg(feature = "formats")]
    Tga,
    /// Tagged Image File Format.
    #[cfg(feature = "formats")]
    Tif,
    /// Graphics Interchange Format, 256 colours; holds animations.
    #[cfg(feature = "formats")]
    Gif,
    /// Joint Photographic Experts Group: photographs, whose colours it keeps nearly.
    #[cfg(feature = "formats")]
    Jpg,
}

impl Format {
    /// The endings of names, for messages.
    #[cfg(feature = "formats")]
    pub const ENDINGS: &str = ".png, .jpg, .tga, .tif, .gif, .mtv";
    /// The endings of names, for messages.
    #[cfg(not(feature = "formats"))]
    pub const ENDINGS: &str = ".png, .mtv";

    /// Returns the format of a file's name by its ending, in capitals or not.
    ///
    /// # Errors
    /// If the name has none of the [`Self::ENDINGS`] (`.jpeg` and `.tiff` are known as well).
    pub fn of(path: &Path) -> Result<Self, Problem> {
        let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        match ending.to_ascii_lowercase().as_str() {
            "png" => Ok(Self::Png),
            "mtv" => Ok(Self::Mtv),
            #[cfg(feature = "formats")]
            "tga" => Ok(Self::Tga),
            #[cfg(feature = "formats")]
            "tif" | "tiff" => Ok(Self::Tif),
            #[cfg(feature = "formats")]
            "gif" => Ok(Self::Gif),
            #[cfg(feature = "formats")]
            "jpg" | "jpeg" => Ok(Self::Jpg),
            _ => Err(Problem::UnknownFormat(path.display().to_string())),
        }
    }

    /// Common name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Mtv => "MTV",
            #[cfg(feature = "formats")]
            Self::Tga => "TGA",
            #[cfg(feature = "formats")]
            Self::Tif => "TIFF",
            #[cfg(feature = "formats")]
            Self::Gif => "GIF",
            #[cfg(feature = "formats")]
            Self::Jpg => "JPEG",
        }
    }
}

/// Reads a picture; of an animation the first frame.
///
/// # Errors
/// If the bytes are not of this format, or hold a picture that is too large.
pub fn decode(bytes: &[u8], format: Format) -> Result<Picture, Problem> {
    decode_at_most(bytes, format, MAX_PIXELS)
}

/// [`decode`] for whoever has less memory: a picture of more than `max_pixels` is refused before
/// any memory is set aside for it.
///
/// # Errors
/// Fails as [`decode`] does.
pub fn decode_at_most(bytes: &[u8], format: Format, max_pixels: u64) -> Result<Picture, Problem> {
    match format {
        Format::Png => png_file::decode(bytes, max_pixels),
        Format::Mtv => mtv::decode(bytes, max_pixels),
        #[cfg(feature = "formats")]
        Format::Tga | Format::Tif | Format::Gif => {
            crate::formats::decode(bytes, format, max_pixels)
        }
        #[cfg(feature = "formats")]
        Format::Jpg => crate::jpeg::decode(bytes, max_pixels),
    }
}

/// Reads width and height from the head of a file. The rest of the file may be damaged all the
/// same.
///
/// # Errors
/// If the bytes are not of this format, or the picture is too large.
pub fn size(bytes: &[u8], format: Format) -> Result<[u32; 2], Problem> {
    match format {
        Format::Png => png_file::size(bytes),
        Format::Mtv => mtv::size(bytes),
        #[cfg(feature = "formats")]
        Format::Tga | Format::Tif | Format::Gif => crate::formats::size(bytes, format),
        #[cfg(feature = "formats")]
        Format::Jpg => crate::jpeg::size(bytes),
    }
}

/// The bytes of a file. TGA, TIFF and PNG keep opacity, MTV and JPEG drop it,
/// GIF keeps 256 colours, JPEG keeps colours nearly.
///
/// # Errors
/// If the format cannot hold the picture.
pub fn encode(picture: &Picture, format: Format) -> Result<Vec<u8>, Problem> {
    match format {
        Format::Png => png_file::encode(picture),
        Format::Mtv => Ok(mtv::encode(picture)),
        #[cfg(feature = "formats")]
        _ => crate::formats::encode(picture, format),
    }
}
