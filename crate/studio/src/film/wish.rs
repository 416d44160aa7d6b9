//! Wishes about the film.

use browser::recording::Kind;
use document::player::Playback;

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
    /// Write all frames to a file.
    Save(Kind),
    /// Stop writing them.
    Stop,
}
