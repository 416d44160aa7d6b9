//! An animated work: which of its frames is on show, playing them one after another, and saving them as
//! an animated PNG.

use crate::picture::Image;
use std::cell::RefCell;
use std::io::Write;
use std::rc::Rc;

/// Most frames of a film.
pub const MAX_FRAMES: u32 = 240;
/// Largest film that is saved, pixels over all frames.
pub const MAX_PIXELS: u64 = 120_000_000;
/// Frames in a second, played and saved.
pub const RATE: u16 = 12;

/// Which frames there are and whether they are played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Player {
    /// How many frames the film has.
    pub count: u32,
    /// When the last frame came, seconds, while the film is played.
    playing: Option<f64>,
}

impl Default for Player {
    fn default() -> Self {
        Self {
            count: 2 * u32::from(RATE),
            playing: None,
        }
    }
}

impl Player {
    /// Whether the film is played.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// Plays, or pauses.
    pub fn toggle(&mut self, now: f64) {
        self.playing = match self.playing {
            Some(_) => None,
            None => Some(now),
        };
    }

    /// Pauses.
    pub fn pause(&mut self) {
        self.playing = None;
    }

    /// The frame to show after `frame` if its time has come. `ready` is whether that one could be seen.
    pub fn next(&mut self, frame: u32, ready: bool, now: f64) -> Option<u32> {
        let came = self.playing?;
        if !ready || now - came < 1.0 / f64::from(RATE) {
            return None;
        }
        self.playing = Some(now);
        Some((frame + 1) % self.count.max(1))
    }

    /// Seconds until [`Player::next`] may have something to say.
    #[must_use]
    pub fn wait(&self, now: f64) -> Option<f64> {
        Some((self.playing? + 1.0 / f64::from(RATE) - now).max(0.0))
    }
}

/// Bytes that are still written to while someone else waits for them.
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

/// A film on its way into a file, frame by frame, so that only the finished frames take memory.
pub struct Recording {
    bytes: Bytes,
    writer: Option<png::Writer<Bytes>>,
    size: [u32; 2],
    count: u32,
    done: u32,
    /// The frame that was on show before.
    pub before: u32,
}

impl Recording {
    /// Begins a film of `count` frames of a size.
    ///
    /// # Errors
    /// If it would be too large.
    pub fn begin(count: u32, size: [u32; 2], before: u32) -> Result<Self, String> {
        let pixels = u64::from(size[0]) * u64::from(size[1]) * u64::from(count);
        if count == 0 || count > MAX_FRAMES || pixels > MAX_PIXELS {
            return Err(format!(
                "{count} frames of {} × {} pixels are too many for one file: {MAX_FRAMES} frames and {} million pixels are the limits. Choose fewer frames or a smaller picture.",
                size[0],
                size[1],
                MAX_PIXELS / 1_000_000
            ));
        }
        Ok(Self {
            bytes: Bytes::default(),
            writer: None,
            size,
            count,
            done: 0,
            before,
        })
    }

    /// The frame that comes next.
    #[must_use]
    pub fn next(&self) -> u32 {
        self.done
    }

    /// How far it is, in words.
    #[must_use]
    pub fn words(&self) -> String {
        format!(
            "Saving the film: frame {} of {}.",
            self.done + 1,
            self.count
        )
    }

    /// Takes the next frame. Gives the file after the last one.
    ///
    /// # Errors
    /// If the frame has another size than the film.
    pub fn add(&mut self, image: &Image) -> Result<Option<Vec<u8>>, String> {
        if image.size != self.size {
            return Err(String::from("The size of the picture changed."));
        }
        let mut writer = match self.writer.take() {
            Some(writer) => writer,
            None => self.open().map_err(|error| error.to_string())?,
        };
        writer
            .write_image_data(&image.rgba)
            .map_err(|error| error.to_string())?;
        self.done += 1;
        if self.done < self.count {
            self.writer = Some(writer);
            return Ok(None);
        }
        writer.finish().map_err(|error| error.to_string())?;
        Ok(Some(self.bytes.0.take()))
    }

    fn open(&self) -> Result<png::Writer<Bytes>, png::EncodingError> {
        let [width, height] = self.size;
        let mut encoder = png::Encoder::new(self.bytes.clone(), width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(self.count, 0)?;
        encoder.set_frame_delay(1, RATE)?;
        encoder.write_header()
    }
}

/// A film that is being saved.
pub(crate) struct Saving {
    pub(crate) recording: Recording,
    /// The text it is of.
    pub(crate) revision: u64,
    /// The size of the picture that tests asked for before.
    pub(crate) forced: Option<[u32; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_at_their_rate_and_begin_again() {
        let mut player = Player {
            count: 3,
            ..Player::default()
        };
        assert_eq!(player.next(0, true, 9.0), None, "nothing is played");
        player.toggle(10.0);
        assert_eq!(player.next(0, true, 10.01), None);
        assert_eq!(player.next(0, false, 11.0), None, "it was not seen yet");
        assert_eq!(player.next(0, true, 11.0), Some(1));
        assert!(player.wait(11.0).is_some_and(|wait| wait < 0.1));
        assert_eq!(player.next(2, true, 12.0), Some(0));
        player.toggle(12.1);
        assert_eq!((player.is_playing(), player.wait(13.0)), (false, None));
    }

    #[test]
    fn a_film_is_an_animated_png() {
        let image = |value: u8| Image {
            size: [3, 2],
            rgba: vec![value; 24],
        };
        let mut film = Recording::begin(3, [3, 2], 0).unwrap();
        assert_eq!(film.add(&image(1)).unwrap(), None);
        assert!(film.words().contains("frame 2 of 3"));
        let large = Image {
            size: [2, 2],
            rgba: vec![0; 16],
        };
        assert!(film.add(&large).is_err());
        assert_eq!(film.add(&image(2)).unwrap(), None);
        let bytes = film.add(&image(3)).unwrap().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let control = reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        let mut rgba = vec![0; 24];
        for value in 1..=3 {
            reader.next_frame(&mut rgba).unwrap();
            assert_eq!(rgba, [value; 24]);
        }
    }

    #[test]
    fn too_long_a_film_is_refused() {
        assert!(Recording::begin(MAX_FRAMES + 1, [2, 2], 0).is_err());
        assert!(Recording::begin(24, [4000, 4000], 0).is_err());
        assert!(Recording::begin(24, [800, 600], 0).is_ok());
    }
}
