//! Why something could not be done with a picture.

use crate::limits::{
    MAX_ANIMATION, MAX_BETWEEN, MAX_FRAMES, MAX_PIXELS, MAX_POINTS, MAX_SHEET, MAX_SIDE,
    MAX_SWATCHES,
};
use std::fmt;

/// Why something could not be done; shown as one sentence that says what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Problem {
    /// A picture of this width and height has no pixels or too many.
    Size(u64, u64),
    /// A picture of this width and height is larger than whoever reads it has room for.
    NoRoom {
        /// Width and height.
        size: [u32; 2],
        /// The number of pixels for which there is room.
        most: u64,
    },
    /// The bytes are not four for each pixel.
    ByteCount {
        /// The number of bytes that are needed.
        needed: u64,
        /// The number of bytes that are there.
        found: u64,
    },
    /// The sizes of two pictures differ, and should not.
    DifferentSizes([u32; 2], [u32; 2]),
    /// Resizing would need too much memory on the way.
    TooMuchBetween,
    /// The number of pictures for a sheet is not 1 … [`MAX_SHEET`].
    SheetCount(usize),
    /// The number of columns of a sheet is 0.
    NoColumns,
    /// The number of points is not 2 … [`MAX_POINTS`].
    PointCount(usize),
    /// A value to plot is not a number.
    NotFinite,
    /// The number of colours is not 1 … [`MAX_SWATCHES`].
    SwatchCount(usize),
    /// The number of frames is not 1 … [`MAX_FRAMES`].
    FrameCount(u32),
    /// More or fewer frames were given than announced.
    FramesAnnounced {
        /// The number of frames that was announced.
        announced: u32,
        /// The number of frames that were given.
        given: u32,
    },
    /// The frames of an animation have more than [`MAX_ANIMATION`] pixels.
    AnimationTooLarge,
    /// Frames in a second outside the range that files can hold.
    Speed,
    /// The ending of the file's name is not that of a known format.
    UnknownFormat(String),
    /// The format cannot hold animations.
    NoAnimation(&'static str),
    /// The bytes are not a file of this format, or a damaged one; the second string says what is
    /// wrong.
    Damaged(&'static str, String),
    /// The file could not be made; the second string says why.
    NotWritten(&'static str, String),
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(width, height) => write!(
                f,
                "a picture of {width}×{height} pixels cannot be: \
                 sides are 1 to {MAX_SIDE}, and {MAX_PIXELS} pixels is the limit"
            ),
            Self::NoRoom {
                size: [width, height],
                most,
            } => write!(
                f,
                "{width}×{height} are more pixels than there is room for; {most} is the limit here"
            ),
            Self::ByteCount { needed, found } => {
                write!(f, "the picture needs {needed} bytes, {found} were given")
            }
            Self::DifferentSizes([w, h], [v, g]) => write!(
                f,
                "the pictures must have the same size, but they have {w}×{h} and {v}×{g} pixels; \
                 resize one of them first"
            ),
            Self::TooMuchBetween => write!(
                f,
                "resizing needs too much memory: old width times new height may be {MAX_BETWEEN} \
                 pixels; resize in two steps"
            ),
            Self::SheetCount(count) => write!(
                f,
                "a sheet holds 1 to {MAX_SHEET} pictures, {count} were given"
            ),
            Self::NoColumns => write!(f, "a sheet needs at least one column"),
            Self::PointCount(count) => {
                write!(f, "a line has 2 to {MAX_POINTS} points, {count} were given")
            }
            Self::NotFinite => write!(f, "only finite numbers can be plotted"),
            Self::SwatchCount(count) => write!(
                f,
                "a palette has 1 to {MAX_SWATCHES} colours, {count} were given"
            ),
            Self::FrameCount(count) => write!(
                f,
                "an animation has 1 to {MAX_FRAMES} frames, {count} were given"
            ),
            Self::FramesAnnounced { announced, given } => write!(
                f,
                "the animation was to have {announced} frames, {given} were given"
            ),
            Self::AnimationTooLarge => write!(
                f,
                "the animation is too large: all frames together may have {MAX_ANIMATION} pixels"
            ),
            Self::Speed => write!(f, "an animation shows 0.01 to 100 frames a second"),
            Self::UnknownFormat(name) => write!(
                f,
                "{name}: the name must end in one of {}",
                crate::file::Format::ENDINGS
            ),
            Self::NoAnimation(format) => write!(
                f,
                "{format} files cannot hold animations; choose a name ending in .png or .gif"
            ),
            Self::Damaged(format, why) => {
                write!(f, "this is not a {format} file, or a damaged one: {why}")
            }
            Self::NotWritten(format, why) => write!(f, "the {format} file cannot be made: {why}"),
        }
    }
}

impl std::error::Error for Problem {}
