//! Animations: frames of one size, shown one after the other.
//!
//! Frames go one by one through a [`Writer`] and come one by one from [`frames`], so that an
//! animation needs the memory of one frame.

#[cfg(feature = "formats")]
pub use crate::formats::Frames;
use crate::limits::MAX_FRAMES;
pub use crate::timing::Timing;
use crate::{Format, Picture, Problem, png_file};
#[cfg(feature = "formats")]
use crate::{formats, limits::MAX_PIXELS};
use std::io::Write;

/// Returns the order in which `count` frames run forth and back, each end shown once: 0 1 2 3 2 1.
pub fn mirror(count: usize) -> impl Iterator<Item = usize> {
    (0..count).chain((1..count.saturating_sub(1)).rev())
}

/// An animation that is being written to a file.
///
/// A `Writer` that is dropped before [`Writer::finish`] leaves a file that is cut off.
pub struct Writer<W: Write> {
    kind: Kind<W>,
    size: [u32; 2],
    announced: u32,
    given: u32,
}

enum Kind<W: Write> {
    Png(png_file::Animated<W>),
    #[cfg(feature = "formats")]
    Gif(formats::AnimatedGif<W>),
}

impl<W: Write> Writer<W> {
    /// Begins a file with its first frame. `frames` counts all of them; all must have the size of
    /// the first, and none shows anything through if the first does not. `dither` mixes colours
    /// from dots where the format has only 256 of them.
    ///
    /// # Errors
    /// If there are no frames or more than [`MAX_FRAMES`], if the format cannot hold animations, or
    /// if writing fails.
    pub fn begin(
        to: W,
        format: Format,
        first: &Picture,
        frames: u32,
        timing: Timing,
        dither: bool,
    ) -> Result<Self, Problem> {
        if !(1..=MAX_FRAMES).contains(&frames) {
            return Err(Problem::FrameCount(frames));
        }
        let kind = match format {
            Format::Png => Kind::Png(png_file::Animated::begin(to, first, frames, timing)?),
            #[cfg(feature = "formats")]
            Format::Gif => Kind::Gif(formats::AnimatedGif::begin(to, timing, dither)?),
            other => return Err(Problem::NoAnimation(other.name())),
        };
        // Without the feature nothing asks whether to dither.
        let _ = dither;
        let mut writer = Self {
            kind,
            size: first.size(),
            announced: frames,
            given: 0,
        };
        writer.add(first)?;
        Ok(writer)
    }

    /// Adds the next frame.
    ///
    /// # Errors
    /// If it is one too many or of another size, or if writing fails.
    pub fn add(&mut self, frame: &Picture) -> Result<(), Problem> {
        if frame.size() != self.size {
            return Err(Problem::DifferentSizes(self.size, frame.size()));
        }
        self.given += 1;
        if self.given > self.announced {
            return Err(self.wrong_count());
        }
        match &mut self.kind {
            Kind::Png(file) => file.add(frame),
            #[cfg(feature = "formats")]
            Kind::Gif(file) => file.add(frame),
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If frames are missing, or if writing fails.
    pub fn finish(self) -> Result<(), Problem> {
        if self.given != self.announced {
            return Err(self.wrong_count());
        }
        match self.kind {
            Kind::Png(file) => file.finish(),
            // Its last byte is written when it is dropped, which happens here.
            #[cfg(feature = "formats")]
            Kind::Gif(_) => Ok(()),
        }
    }

    fn wrong_count(&self) -> Problem {
        Problem::FramesAnnounced {
            announced: self.announced,
            given: self.given,
        }
    }
}

/// The frames of a PNG or GIF file, each as it is seen, i.e. laid over those before.
///
/// # Errors
/// If the bytes are not of this format, or if the format cannot hold animations. A frame that is
/// damaged or that leads over a limit is the last one, and is an error itself.
#[cfg(feature = "formats")]
pub fn frames<'a>(bytes: impl AsRef<[u8]> + 'a, format: Format) -> Result<Frames<'a>, Problem> {
    frames_at_most(bytes, format, MAX_PIXELS)
}

/// [`frames`] for whoever has less memory: frames of more than `max_pixels` are refused.
///
/// # Errors
/// Fails as [`frames`] does.
#[cfg(feature = "formats")]
pub fn frames_at_most<'a>(
    bytes: impl AsRef<[u8]> + 'a,
    format: Format,
    max_pixels: u64,
) -> Result<Frames<'a>, Problem> {
    formats::frames(bytes, format, max_pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forth_and_back() {
        assert_eq!(mirror(0).collect::<Vec<_>>(), []);
        assert!(mirror(1).eq([0]));
        assert!(mirror(2).eq([0, 1]));
        assert!(mirror(4).eq([0, 1, 2, 3, 2, 1]));
    }

    #[test]
    fn speeds() {
        fn delay(speed: f64) -> Result<u16, Problem> {
            Timing::new(speed, true).map(|timing| timing.delay)
        }
        assert_eq!(delay(25.0), Ok(4));
        assert_eq!(delay(100.0), Ok(1));
        assert_eq!(delay(0.01), Ok(10_000));
        for speed in [0.0, -1.0, 101.0, f64::NAN, f64::INFINITY] {
            assert_eq!(delay(speed), Err(Problem::Speed));
        }
    }
}
