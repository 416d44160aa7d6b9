//! Wishes about the film.

use browser::recording::Kind;
use document::player::Playback;

/// Quality of the frames of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Traced frames, as large as the picture.
    #[default]
    Traced,
    /// Frames that the card draws, with so many pixels along the shorter side.
    Draft(u32),
}

impl Quality {
    /// Pixels of the shorter side that there are to choose from.
    pub const LINES: [u32; 4] = [240, 480, 720, 1080];
}

/// Wishes about the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmWish {
    /// Play it, or pause it.
    Play,
    /// Show a frame.
    SetFrame(u32),
    /// Set the number of frames.
    SetLength(u32),
    /// Set the number of frames that are shown in a second.
    SetRate(u16),
    /// Choose what follows the last frame.
    SetPlayback(Playback),
    /// Choose how the frames of a file are made.
    SetQuality(Quality),
    /// Write all frames to a file.
    Save(Kind),
    /// Stop writing them.
    Stop,
}
