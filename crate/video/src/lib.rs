//! Files of video that an encoder has made, such as that of a browser: [`webm`] and [`mp4`] put its
//! packets, one for each frame, into a file that players know.
//!
//! ```
//! use video::{Codec, Colours, Packet, Video};
//!
//! let packet = |frame: u64| Packet {
//!     time: frame * 40_000,
//!     is_key: frame == 0,
//!     bytes: vec![0x82, 0x49, 0x83, 0x42],
//! };
//! let video = Video {
//!     codec: Codec::Vp9,
//!     size: [640, 480],
//!     frame_time: 40_000,
//!     colours: Colours::BT709,
//!     packets: (0..25).map(packet).collect(),
//! };
//! let file = video::webm(&video)?;
//! assert!(file.starts_with(&[0x1a, 0x45, 0xdf, 0xa3]));
//! assert!(video::mp4(&video).is_err(), "MP4 files are made of H.264 alone");
//! # Ok::<(), video::Error>(())
//! ```

mod mp4;
mod webm;

use std::fmt;

pub use mp4::mp4;
pub use webm::webm;

/// The encoding of a video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Codec {
    /// VP8, for WebM.
    Vp8,
    /// VP9 with 8 bits a sample, for WebM.
    Vp9,
    /// H.264, for MP4. Its packets have no start codes but lengths before their units.
    H264 {
        /// The decoder configuration record (ISO/IEC 14496-15, 5.3.3.1).
        configuration: Vec<u8>,
    },
}

/// The meaning of a frame's numbers as colours, by the code points of ITU-T H.273.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colours {
    /// Colour primaries.
    pub primaries: u8,
    /// Transfer characteristics.
    pub transfer: u8,
    /// Matrix coefficients.
    pub matrix: u8,
    /// Whether all values of a byte are used.
    pub full_range: bool,
}

impl Colours {
    /// The colours of high-definition television.
    pub const BT709: Self = Self {
        primaries: 1,
        transfer: 1,
        matrix: 1,
        full_range: false,
    };
}

/// A frame as the encoder gives it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packet {
    /// The time at which it is shown, microseconds from the beginning.
    pub time: u64,
    /// Whether it can be decoded without those before.
    pub is_key: bool,
    /// The encoded frame.
    pub bytes: Vec<u8>,
}

/// An encoded video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Video {
    /// The encoding.
    pub codec: Codec,
    /// Width and height, pixels.
    pub size: [u16; 2],
    /// The time for which a frame is shown, microseconds.
    pub frame_time: u64,
    /// The meaning of its colours.
    pub colours: Colours,
    /// The frames, in the order in which they are decoded.
    pub packets: Vec<Packet>,
}

/// Why a file cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// The first frame is missing, or cannot be decoded by itself.
    NoStart,
    /// Width, height or the time of a frame is 0.
    Empty,
    /// The file would have 4 GiB, or the video would last more than a day.
    TooLong,
    /// A file of this kind is not made of videos that are encoded like this.
    Codec,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoStart => "the video has no frame to begin with",
            Self::Empty => "the video has no size or no frame rate",
            Self::TooLong => "the video is too long",
            Self::Codec => "this kind of file cannot hold the video",
        })
    }
}

impl std::error::Error for Error {}

/// Microseconds of a day.
const DAY: u64 = 86_400_000_000;

impl Video {
    fn check(&self) -> Result<(), Error> {
        if !self.packets.first().is_some_and(|first| first.is_key) {
            return Err(Error::NoStart);
        }
        if self.size.contains(&0) || self.frame_time == 0 {
            return Err(Error::Empty);
        }
        let bytes: usize = self.packets.iter().map(|packet| packet.bytes.len()).sum();
        if self.end() > DAY || bytes > u32::MAX as usize / 2 {
            return Err(Error::TooLong);
        }
        Ok(())
    }

    /// Returns the time at which the last frame ends, microseconds.
    fn end(&self) -> u64 {
        let last = self.packets.iter().map(|packet| packet.time).max();
        last.unwrap_or(0).saturating_add(self.frame_time)
    }
}
