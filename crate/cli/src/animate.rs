//! `sinew animate`: a dataset whose variables change with the frames, as an animation.

use crate::trace::Wishes;
use crate::{Outcome, files, report, whole};
use clap::Args;
use picture::Format;
use picture::animation::{Timing, Writer};
use picture::limits::MAX_FRAMES;
use std::path::PathBuf;
use std::sync::Arc;

/// `sinew animate FILE -o OUT.png|OUT.gif --frames N [--fps F] [--once] [-r W H] [-s N] [--threads
/// N]`.
#[derive(Args)]
pub struct Animate {
    /// The dataset; its variables change by `+=` and `*=`
    file: PathBuf,
    /// The animation to write: PNG, or GIF with its 256 colours
    #[arg(short, long)]
    output: PathBuf,
    /// Number of frames
    #[arg(short, long, value_name = "N")]
    frames: u32,
    /// Frames a second; default: those of the dataset's `motion`, else 25
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
        if !(1..=MAX_FRAMES).contains(&self.frames) {
            return Err(format!("--frames takes 1 to {MAX_FRAMES}"));
        }
        let wishes = Wishes {
            size: self.resolution.as_ref().map(|size| [size[0], size[1]]),
            samples: self.samples,
            soft: None,
            threads: self.threads,
        };
        let mut loaded = files::load(&self.file)?;
        let fps = self.fps.or(loaded.compiled.rate).unwrap_or(25.0);
        let timing = Timing::new(fps, !self.once).map_err(|problem| problem.to_string())?;
        if !loaded.compiled.animated {
            report::to_stderr(&loaded);
            return Err(format!(
                "nothing of {} changes with the frames; let a variable grow, \
                 e.g. `var angle = 0 += 5`, or move a skeleton by `motion`",
                self.file.display()
            ));
        }
        let mut clean = report::to_stderr(&loaded);
        let size = wishes.size.unwrap_or(loaded.compiled.scene.settings.frame);
        whole::write(&self.output, |file| {
            let mut file = Some(file);
            let mut writer = None;
            for frame in 0..self.frames {
                if frame > 0 {
                    loaded.compiled =
                        rats::compile_at(&loaded.project, &loaded.assets, f64::from(frame));
                    // The other frames would repeat the first one's messages.
                    if clean && !report::is_clean(&loaded) {
                        eprintln!("in frame {frame}:");
                        clean = report::to_stderr(&loaded);
                    }
                }
                // All frames have one size, even if the text changes `framesize`.
                let wishes = Wishes {
                    size: Some(size),
                    ..wishes
                };
                let traced = wishes.trace(Arc::make_mut(&mut loaded.compiled.scene), &|_| ())?;
                let picture = &traced.picture;
                match (&mut writer, file.take()) {
                    (None, Some(file)) => {
                        let begun =
                            Writer::begin(file, format, picture, self.frames, timing, self.dither);
                        writer = Some(begun.map_err(|problem| problem.to_string())?);
                    }
                    (Some(writer), _) => {
                        writer.add(picture).map_err(|problem| problem.to_string())?
                    }
                    (None, None) => {}
                }
                eprintln!(
                    "frame {} of {}: {:.2} s",
                    frame + 1,
                    self.frames,
                    traced.seconds
                );
            }
            writer.map_or(Ok(()), |writer| {
                writer.finish().map_err(|problem| problem.to_string())
            })
        })?;
        let [width, height] = size;
        eprintln!(
            "{}: {} frames of {width}×{height}",
            self.output.display(),
            self.frames
        );
        Ok(clean)
    }
}
