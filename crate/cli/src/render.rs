//! `sinew render`: a dataset's picture in a file.

use crate::trace::{self, Wishes};
use crate::{Outcome, files, report};
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

#[derive(Clone, Copy, ValueEnum)]
enum Switch {
    On,
    Off,
}

/// `sinew render FILE -o OUT.png [-r W H] [-s N] [--threads N] [--soft on|off] [--json]`.
#[derive(Args)]
pub struct Render {
    /// The dataset
    file: PathBuf,
    /// The picture to write; its ending tells the format: png, tga, tif, gif or mtv. Of several
    /// `shoot`s, the last has this name, those before it OUT-1.png, OUT-2.png, …
    #[arg(short, long)]
    output: PathBuf,
    /// Width and height in pixels, instead of the dataset's `framesize`
    #[arg(short, long, num_args = 2, value_names = ["W", "H"])]
    resolution: Option<Vec<u32>>,
    /// The most rays a pixel, N×N, instead of the dataset's `sample`
    #[arg(short, long, value_name = "N")]
    samples: Option<u32>,
    /// Threads; default: as many as the machine has cores
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Draw the convolution surface, or the offset surfaces of its elements
    #[arg(long)]
    soft: Option<Switch>,
    /// Print counts and times as JSON on the standard output
    #[arg(long)]
    json: bool,
}

impl Render {
    /// Traces and writes the picture. With errors in the dataset the picture is made of what could
    /// be understood, and the result is false.
    pub fn run(&self) -> Outcome {
        trace::check_name(&self.output)?;
        let wishes = Wishes {
            size: self.resolution.as_ref().map(|size| [size[0], size[1]]),
            samples: self.samples,
            soft: self.soft.map(|switch| matches!(switch, Switch::On)),
            threads: self.threads,
        };
        let mut loaded = files::load(&self.file)?;
        let clean = report::to_stderr(&loaded);
        for (index, earlier) in loaded.compiled.earlier.iter_mut().enumerate() {
            let name = trace::number_name(&self.output, index + 1);
            let traced = wishes.trace(Arc::make_mut(&mut earlier.scene), &|_| ())?;
            trace::write(&name, &traced.picture)?;
            eprintln!("{}: the picture of an earlier `shoot`", name.display());
        }
        let scene = Arc::make_mut(&mut loaded.compiled.scene);
        let traced = wishes.trace(scene, &|_| ())?;
        let start = Instant::now();
        trace::write(&self.output, &traced.picture)?;
        let write = start.elapsed().as_secs_f64();

        let [width, height] = traced.picture.size();
        let stats = traced.stats;
        if self.json {
            let soft = scene
                .elements
                .iter()
                .filter(|element| scene.is_soft(element))
                .count();
            let summary = json!({
                "picture": { "width": width, "height": height, "samples": scene.settings.samples },
                "elements": { "soft": soft, "hard": scene.elements.len() - soft },
                "rays": { "primary": stats.primary_rays, "shadow": stats.shadow_rays },
                "field_evaluations": stats.field_evaluations,
                "threads": traced.threads,
                "seconds": {
                    "compile": loaded.compile_seconds,
                    "trace": traced.seconds,
                    "write": write,
                },
            });
            println!("{summary}");
        } else {
            eprintln!(
                "{}: {width}×{height}, {} rays, {:.2} s on {} threads",
                self.output.display(),
                stats.primary_rays + stats.shadow_rays,
                traced.seconds,
                traced.threads
            );
        }
        let jobs = loaded.compiled.tools.len();
        if jobs > 0 {
            eprintln!(
                "{jobs} of the dataset's commands work on pictures and were not carried out; \
                 `sinew {}` does so",
                self.file.display()
            );
        }
        Ok(clean)
    }
}
