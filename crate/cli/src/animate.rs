//! `sinew animate`: a dataset whose variables change with the frames, as an animation. Several
//! machines can share the frames: each traces a part, and the parts are merged.

use crate::files::Loaded;
use crate::trace::Wishes;
use crate::{Outcome, files, report, whole};
use clap::Args;
use picture::animation::{self, Timing, Writer};
use picture::limits::MAX_FRAMES;
use picture::{Format, Picture};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// `sinew animate FILE -o OUT.png|OUT.gif --frames N|A..B [--fps F] [--once] [-r W H] [-s N]
/// [--threads N]`, or `sinew animate --merge PART.png … -o OUT.png|OUT.gif [--fps F] [--once]`.
#[derive(Args)]
pub struct Animate {
    /// The dataset; its variables change by `+=` and `*=`
    #[arg(required_unless_present = "merge")]
    file: Option<PathBuf>,
    /// The animation to write: PNG, or GIF with its 256 colours
    #[arg(short, long)]
    output: PathBuf,
    /// Number of frames, or a part of them: A..B is frame A, the next ones, and not B; the first
    /// frame is 0
    #[arg(short, long, value_name = "N|A..B", required_unless_present = "merge")]
    frames: Option<Frames>,
    /// Put together PNG animations, in this order: with the parts 0..A and A..B the same bytes as
    /// all frames in one go
    #[arg(long, num_args = 1.., value_name = "PART", conflicts_with_all = ["file", "frames",
        "resolution", "samples", "threads"])]
    merge: Vec<PathBuf>,
    /// Frames a second; default: those of the dataset's `motion`, or of the first part, else 25
    #[arg(long, value_name = "F")]
    fps: Option<f64>,
    /// Stop after the last frame instead of beginning again
    #[arg(long)]
    once: bool,
    /// Mix the colours that a GIF lacks from dots
    #[arg(long)]
    dither: bool,
    /// Width and height in pixels, instead of the dataset's `framesize`
    #[arg(short, long, num_args = 2, value_names = ["W", "H"])]
    resolution: Option<Vec<u32>>,
    /// The most rays a pixel, N×N, instead of the dataset's `sample`
    #[arg(short, long, value_name = "N")]
    samples: Option<u32>,
    /// Threads; default: as many as the machine has cores
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

/// Frames to trace, the first of a film being 0.
#[derive(Clone)]
struct Frames(Range<u32>);

impl std::str::FromStr for Frames {
    type Err = String;

    /// Reads `N`, the frames 0 … N − 1, or `A..B`, the frames A … B − 1.
    fn from_str(text: &str) -> Result<Self, String> {
        let (first, end) = text.split_once("..").unwrap_or(("0", text));
        match (first.parse(), end.parse()) {
            (Ok(first), Ok(end)) if first < end && end <= MAX_FRAMES => Ok(Self(first..end)),
            _ => Err(format!(
                "it takes 1 to {MAX_FRAMES}, or a part of them as 0..50, then 50..100"
            )),
        }
    }
}

impl Animate {
    /// Traces frame by frame and writes the animation. With errors in the dataset the frames are
    /// made of what could be understood, and the result is false.
    pub fn run(&self) -> Outcome {
        let format = Format::of(&self.output);
        let format = format
            .ok()
            .filter(|format| matches!(format, Format::Png | Format::Gif));
        let format = format.ok_or_else(|| {
            let name = self.output.display();
            format!("{name}: the name of an animation must end in .png or .gif")
        })?;
        match (&self.file, &self.frames) {
            (Some(file), Some(Frames(frames))) => self.trace(file, frames.clone(), format),
            _ => self.merge(format),
        }
    }

    /// Traces frames of a dataset to an animation of this format.
    fn trace(&self, file: &Path, frames: Range<u32>, format: Format) -> Outcome {
        let mut loaded = files::load(file)?;
        if !loaded.compiled.animated {
            report::to_stderr(&loaded);
            return Err(format!(
                "nothing of {} changes with the frames; let a variable grow, \
                 e.g. `var angle = 0 += 5`, or move a skeleton by `motion`",
                file.display()
            ));
        }
        let timing = self.timing(loaded.compiled.rate)?;
        let mut clean = report::to_stderr(&loaded);
        // All frames have one size, even if the text changes `framesize`.
        let size = self.resolution.as_ref().map(|size| [size[0], size[1]]);
        let size = size.unwrap_or(loaded.compiled.scene.settings.frame);
        let pictures = frames.clone().map(|frame| {
            if frame > 0 {
                loaded.compiled =
                    rats::compile_at(&loaded.project, &loaded.assets, f64::from(frame));
                // The other frames would repeat the first one's messages.
                if clean && !report::is_clean(&loaded) {
                    eprintln!("in frame {frame}:");
                    clean = report::to_stderr(&loaded);
                }
            }
            self.trace_frame(&mut loaded, size, &format!("frame {frame} of {frames:?}"))
        });
        self.write(format, timing, frames.len(), pictures)?;
        Ok(clean)
    }

    /// Traces the picture of a compiled frame, and tells the time that it took.
    fn trace_frame(
        &self,
        loaded: &mut Loaded,
        size: [u32; 2],
        name: &str,
    ) -> Result<Picture, String> {
        let wishes = Wishes {
            size: Some(size),
            samples: self.samples,
            soft: None,
            threads: self.threads,
        };
        let traced = wishes.trace(Arc::make_mut(&mut loaded.compiled.scene), &|_| ())?;
        eprintln!("{name}: {:.2} s", traced.seconds);
        Ok(traced.picture)
    }

    /// Puts parts together to an animation of this format, as quick as the first of them.
    fn merge(&self, format: Format) -> Outcome {
        // The file's head tells the number of frames, so that all parts are read twice.
        let (mut count, mut rate) = (0, None);
        for part in &self.merge {
            count += read_part(part)?.try_fold(0, |count, frame| frame.map(|_| count + 1))?;
            if rate.is_none() {
                rate = first_rate(part)?;
            }
        }
        let pictures = self.merge.iter().flat_map(|part| match read_part(part) {
            Ok(frames) => frames,
            Err(sentence) => Box::new(std::iter::once(Err(sentence))),
        });
        self.write(format, self.timing(rate)?, count, pictures)?;
        Ok(true)
    }

    /// Returns the timing asked for; `rate`: frames a second where nothing is asked for.
    fn timing(&self, rate: Option<f64>) -> Result<Timing, String> {
        let rate = self.fps.or(rate).unwrap_or(25.0);
        Timing::new(rate, !self.once).map_err(|problem| problem.to_string())
    }

    /// Writes an animation of `count` pictures, as they come.
    fn write(
        &self,
        format: Format,
        timing: Timing,
        count: usize,
        mut pictures: impl Iterator<Item = Result<Picture, String>>,
    ) -> Result<(), String> {
        let mut size = [0; 2];
        whole::write(&self.output, |file| {
            let first = pictures.next().ok_or("there are no frames")??;
            size = first.size();
            let frames = u32::try_from(count).unwrap_or(u32::MAX);
            let mut writer = Writer::begin(file, format, &first, frames, timing, self.dither)
                .map_err(|problem| problem.to_string())?;
            for picture in pictures {
                writer
                    .add(&picture?)
                    .map_err(|problem| problem.to_string())?;
            }
            writer.finish().map_err(|problem| problem.to_string())
        })?;
        let [width, height] = size;
        eprintln!(
            "{}: {count} frames of {width}×{height}",
            self.output.display()
        );
        Ok(())
    }
}

/// Returns the frames of a part.
///
/// # Errors
/// If it cannot be read or is no PNG animation. A damaged frame is an error in its place.
fn read_part(path: &Path) -> Result<Box<dyn Iterator<Item = Result<Picture, String>>>, String> {
    let path = path.to_path_buf();
    let frames = animation::frames(part_bytes(&path)?, Format::Png);
    let frames = frames.map_err(|problem| format!("{}: {problem}", path.display()))?;
    Ok(Box::new(frames.map(move |frame| {
        frame.map_err(|problem| format!("{}: {problem}", path.display()))
    })))
}

/// Returns the frames a second of a part, by its first frame, if it tells.
fn first_rate(path: &Path) -> Result<Option<f64>, String> {
    let told = animation::frames(part_bytes(path)?, Format::Png).map(|mut frames| {
        let _ = frames.next();
        frames.delay()
    });
    let delay = told.map_err(|problem| format!("{}: {problem}", path.display()))?;
    Ok((delay > 0.0).then(|| 1.0 / delay))
}

/// Returns the bytes of a part.
fn part_bytes(path: &Path) -> Result<Vec<u8>, String> {
    if !matches!(Format::of(path), Ok(Format::Png)) {
        let name = path.display();
        return Err(format!(
            "{name}: parts of an animation are PNG, which keeps all colours"
        ));
    }
    std::fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}
