//! A film on its way into a file, frame by frame.
//!
//! Frames are encoded as they come from the tracer. Those that a film shows a second time, on its
//! way back, are kept as PNG files until then.

use crate::VideoEncoder;
use ::picture::animation::{Timing, Writer};
use ::picture::{Format, Picture, file};
use document::picture::Image;
use document::player::{MAX_FRAMES, Playback, Player};
use std::cell::RefCell;
use std::io::Write;
use std::rc::Rc;
use video::{Codec, Colours, Video};

/// Largest film that is saved: sum of the pixels of all frames of the file.
pub const MAX_PIXELS: u64 = 120_000_000;

/// Most frames that wait for a video's encoder while it is given another one.
const WAITING: usize = 4;

/// A kind of file for films.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Animated PNG.
    Png,
    /// GIF, with 256 colours a frame.
    Gif,
    /// WebM.
    WebM,
    /// MP4.
    Mp4,
}

impl Kind {
    /// The kinds in the order of the menu.
    pub const ALL: [Self; 4] = [Self::Mp4, Self::WebM, Self::Gif, Self::Png];

    /// Returns the name in the menu.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Png => "Animated PNG",
            Self::Gif => "GIF",
            Self::WebM => "WebM",
            Self::Mp4 => "MP4",
        }
    }

    /// Returns advantages and drawbacks in a few words.
    #[must_use]
    pub fn facts(self) -> &'static str {
        match self {
            Self::Png => "exactly the colours of the frames; browsers play it",
            Self::Gif => "everything plays it; 256 colours a frame",
            Self::WebM => "a small video; browsers play it",
            Self::Mp4 => "a small video; phones and televisions play it",
        }
    }

    /// Returns the extension of the file's name.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Gif => "gif",
            Self::WebM => "webm",
            Self::Mp4 => "mp4",
        }
    }

    /// Returns the media type.
    #[must_use]
    pub fn mime(self) -> &'static str {
        match self {
            Self::Png => "image/apng",
            Self::Gif => "image/gif",
            Self::WebM => "video/webm",
            Self::Mp4 => "video/mp4",
        }
    }

    /// Whether the browser must have an encoder for it.
    #[must_use]
    pub fn is_video(self) -> bool {
        matches!(self, Self::WebM | Self::Mp4)
    }

    /// Returns the size of frames for pictures of a size: the sides of a video's frames are even.
    #[must_use]
    pub fn size(self, size: [u32; 2]) -> [u32; 2] {
        if self.is_video() {
            size.map(|side| (side & !1).max(2))
        } else {
            size
        }
    }
}

/// An encoder of videos that the browser has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VideoFormat {
    /// The kind of file for its videos.
    pub kind: Kind,
    /// The browser's name of the codec, such as `vp09.00.51.08`.
    pub codec: String,
}

/// Bytes of a file, shared by its writer and the recording.
#[derive(Clone, Default)]
struct Bytes(Rc<RefCell<Vec<u8>>>);

impl Write for Bytes {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

enum Sink {
    /// A file of pictures, which is begun with the first one.
    Pictures(Bytes, Option<Writer<Bytes>>),
    Video(VideoEncoder),
}

/// A film on its way into a file.
pub struct Recording {
    /// The kind of file.
    pub kind: Kind,
    sink: Sink,
    size: [u32; 2],
    count: u32,
    rate: u16,
    playback: Playback,
    /// Number of frames that were traced.
    traced: u32,
    /// Number of frames that were written to the file.
    written: u32,
    /// Frames that come again, as PNG files.
    kept: Vec<Vec<u8>>,
    /// Time of the start, seconds.
    start: f64,
}

impl Recording {
    /// Begins a film with pictures of a size. For a video `formats` must have an encoder.
    ///
    /// # Errors
    /// If it would be too large, or the browser has no encoder.
    pub fn begin(
        kind: Kind,
        player: &Player,
        size: [u32; 2],
        formats: &[VideoFormat],
        now: f64,
    ) -> Result<Self, String> {
        let (count, length) = (player.count, player.playback.length(player.count));
        let pixels = u64::from(size[0]) * u64::from(size[1]) * u64::from(length);
        if count == 0 || count > MAX_FRAMES || pixels > MAX_PIXELS {
            return Err(format!(
                "{length} frames of {} × {} pixels are too many for one file: \
                    {MAX_FRAMES} frames and {} million pixels are the limits. \
                    Choose fewer frames or smaller ones.",
                size[0],
                size[1],
                MAX_PIXELS / 1_000_000
            ));
        }
        let sink = if kind.is_video() {
            let format = formats.iter().find(|format| format.kind == kind);
            let format = format.ok_or("This browser has no encoder for such a video.")?;
            Sink::Video(VideoEncoder::new(&format.codec, size, player.rate)?)
        } else {
            Sink::Pictures(Bytes::default(), None)
        };
        Ok(Self {
            kind,
            sink,
            size,
            count,
            rate: player.rate,
            playback: player.playback,
            traced: 0,
            written: 0,
            kept: Vec::new(),
            start: now,
        })
    }

    /// Returns the frame to trace next; `None` once all are traced.
    #[must_use]
    pub fn next_frame(&self) -> Option<u32> {
        (self.traced < self.count).then_some(self.traced)
    }

    /// Returns the fraction of frames that are traced, 0 … 1. Encoding takes little time beside it.
    #[must_use]
    pub fn fraction(&self) -> f32 {
        self.traced as f32 / self.count as f32
    }

    /// Returns the progress in words.
    #[must_use]
    pub fn words(&self, now: f64) -> String {
        let Some(frame) = self.next_frame() else {
            return format!("Writing the {} file", self.kind.label());
        };
        let mut words = format!("Frame {} of {}", frame + 1, self.count);
        if frame > 0 {
            let left = (now - self.start) / f64::from(frame) * f64::from(self.count - frame);
            words.push_str(&format!(" · {} left", document::numerals::duration(left)));
        }
        words
    }

    /// Adds the frame that was to be traced next.
    ///
    /// # Errors
    /// If it has another size than the film, or cannot be encoded.
    pub fn add(&mut self, image: &Image) -> Result<(), String> {
        if image.size != self.size {
            return Err(String::from("The size of the picture changed."));
        }
        let [width, height] = image.size;
        let picture = Picture::new(width, height, image.rgba.clone());
        let picture = picture.map_err(|problem| problem.to_string())?;
        self.write(&picture)?;
        let last = self.count - 1;
        if self.playback == Playback::Mirror && (1..last).contains(&self.traced) {
            let small = file::encode(&picture, Format::Png);
            self.kept
                .push(small.map_err(|problem| problem.to_string())?);
        }
        self.traced += 1;
        Ok(())
    }

    /// Does a part of the work that is left once all frames are traced. Returns the file when it is
    /// complete; until then call it again soon.
    ///
    /// # Errors
    /// If encoding fails.
    pub fn finish(&mut self) -> Result<Option<Vec<u8>>, String> {
        if let Sink::Video(encoder) = &self.sink
            && encoder.waiting() > WAITING
        {
            return Ok(None);
        }
        if let Some(small) = self.kept.pop() {
            let picture = file::decode(&small, Format::Png).map_err(|p| p.to_string())?;
            self.write(&picture)?;
            return Ok(None);
        }
        match &mut self.sink {
            Sink::Pictures(bytes, writer) => {
                if let Some(writer) = writer.take() {
                    writer.finish().map_err(|problem| problem.to_string())?;
                }
                Ok(Some(bytes.0.take()))
            }
            Sink::Video(encoder) => {
                let Some(encoded) = encoder.finish()? else {
                    return Ok(None);
                };
                let video = Video {
                    codec: encoded.codec,
                    size: self.size.map(|side| side as u16),
                    frame_time: frame_time(self.rate),
                    colours: encoded.colours,
                    packets: encoded.packets,
                };
                let file = match self.kind {
                    Kind::Mp4 => video::mp4(&video),
                    _ => video::webm(&video),
                };
                file.map(Some).map_err(|error| error.to_string())
            }
        }
    }

    /// Writes a frame to the file, or gives it to the encoder.
    fn write(&mut self, picture: &Picture) -> Result<(), String> {
        match &mut self.sink {
            Sink::Pictures(_, Some(writer)) => writer.add(picture).map_err(say)?,
            Sink::Pictures(bytes, writer) => {
                let format = match self.kind {
                    Kind::Gif => Format::Gif,
                    _ => Format::Png,
                };
                let repeats = self.playback != Playback::Once;
                let timing = Timing::new(f64::from(self.rate), repeats).map_err(say)?;
                let length = self.playback.length(self.count);
                let new = Writer::begin(bytes.clone(), format, picture, length, timing, true);
                *writer = Some(new.map_err(say)?);
            }
            Sink::Video(encoder) => {
                let time = u64::from(self.written) * frame_time(self.rate);
                // A player can jump to each second of the film.
                let is_key = self.written.is_multiple_of(u32::from(self.rate.max(1)));
                encoder.encode(picture, time, is_key)?;
            }
        }
        self.written += 1;
        Ok(())
    }
}

/// Returns a problem in words.
fn say(problem: ::picture::Problem) -> String {
    problem.to_string()
}

/// Returns the time for which a frame is shown, microseconds.
fn frame_time(rate: u16) -> u64 {
    1_000_000 / u64::from(rate.max(1))
}

/// A video from a browser's encoder.
pub struct EncodedVideo {
    /// The codec.
    pub codec: Codec,
    /// The meaning of the colours.
    pub colours: Colours,
    /// The frames.
    pub packets: Vec<video::Packet>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn player(count: u32, playback: Playback) -> Player {
        let mut player = Player::default();
        (player.count, player.playback) = (count, playback);
        player
    }

    /// Returns a picture with a colour of its own for each frame.
    fn image(frame: u32) -> Image {
        Image {
            size: [6, 4],
            rgba: [40 * frame as u8, 200, 90, 255].repeat(24),
        }
    }

    fn record(kind: Kind, count: u32, playback: Playback) -> Vec<u8> {
        let formats = crate::native_formats();
        let player = player(count, playback);
        let mut film = Recording::begin(kind, &player, [6, 4], &formats, 0.0).unwrap();
        while let Some(frame) = film.next_frame() {
            assert_eq!(film.fraction(), frame as f32 / count as f32);
            film.add(&image(frame)).unwrap();
        }
        for _ in 0..99 {
            if let Some(bytes) = film.finish().unwrap() {
                return bytes;
            }
        }
        panic!("it is never finished");
    }

    fn reds(bytes: &[u8], name: &str) -> Vec<u8> {
        let format = Format::of(Path::new(name)).unwrap();
        let frames = ::picture::animation::frames(bytes, format).unwrap();
        frames
            .map(|frame| frame.unwrap().pixel(2, 2).unwrap()[0])
            .collect()
    }

    #[test]
    fn films_of_pictures_have_all_frames_in_order() {
        let there = [0, 40, 80, 120];
        let back = [0, 40, 80, 120, 80, 40];
        for (playback, expected) in [
            (Playback::Once, &there[..]),
            (Playback::Loop, &there),
            (Playback::Mirror, &back),
        ] {
            let bytes = record(Kind::Png, 4, playback);
            assert_eq!(reds(&bytes, "a.png"), expected);
            let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
                .read_info()
                .unwrap();
            let control = reader.info().animation_control().unwrap();
            let plays = u32::from(playback == Playback::Once);
            assert_eq!(
                (control.num_frames, control.num_plays),
                (expected.len() as u32, plays)
            );
            reader.next_frame(&mut [0; 96]).unwrap();
            let bytes = record(Kind::Gif, 4, playback);
            assert!(bytes.starts_with(b"GIF89a"));
            let repeats = bytes.windows(8).any(|part| part == b"NETSCAPE");
            assert_eq!(repeats, playback != Playback::Once);
            for (found, expected) in reds(&bytes, "a.gif").iter().zip(expected) {
                assert!(found.abs_diff(*expected) < 8, "{found} {expected}");
            }
        }
        assert_eq!(reds(&record(Kind::Png, 1, Playback::Mirror), "a.png"), [0]);
    }

    #[test]
    fn videos_have_all_frames_in_order() {
        let bytes = record(Kind::WebM, 4, Playback::Mirror);
        assert!(bytes.starts_with(&[0x1a, 0x45, 0xdf, 0xa3]));
        // The stand-in for an encoder makes PNG files.
        let count = |bytes: &[u8]| {
            let starts = bytes.windows(4).filter(|four| four == b"\x89PNG");
            starts.count()
        };
        assert_eq!(count(&bytes), 6);
        assert_eq!(count(&record(Kind::Mp4, 3, Playback::Loop)), 3);
        assert_eq!(Kind::WebM.size([33, 1]), [32, 2]);
        assert_eq!(Kind::Gif.size([33, 1]), [33, 1]);
    }

    #[test]
    fn films_that_cannot_be_saved_are_refused() {
        let trouble = |kind, count, playback, size| {
            Recording::begin(kind, &player(count, playback), size, &[], 0.0).err()
        };
        for (count, playback, size, is_refused) in [
            (MAX_FRAMES + 1, Playback::Loop, [2, 2], true),
            (24, Playback::Loop, [4000, 4000], true),
            (24, Playback::Loop, [2000, 2000], false),
            // The way back counts, too.
            (24, Playback::Mirror, [2000, 2000], true),
        ] {
            let trouble = trouble(Kind::Png, count, playback, size);
            assert_eq!(trouble.is_some(), is_refused, "{count} {size:?}");
        }
        let encoder = trouble(Kind::WebM, 24, Playback::Loop, [800, 600]).unwrap();
        assert!(encoder.contains("no encoder"), "{encoder}");
        let player = player(2, Playback::Loop);
        let mut film = Recording::begin(Kind::Png, &player, [6, 4], &[], 0.0).unwrap();
        let large = Image {
            size: [2, 2],
            rgba: vec![0; 16],
        };
        assert!(film.add(&large).is_err());
        film.add(&image(0)).unwrap();
        assert_eq!(film.words(10.0), "Frame 2 of 2 · 10 s left");
    }
}
