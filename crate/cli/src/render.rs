//! `sinew render`: a dataset's picture as a PNG file.

use crate::{Outcome, files, report};
use clap::{Args, ValueEnum};
use serde_json::json;
use std::path::{Path, PathBuf};
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
    /// The picture to write (PNG)
    #[arg(short, long)]
    output: PathBuf,
    /// Width and height in pixels, instead of the dataset's `framesize`
    #[arg(short, long, num_args = 2, value_names = ["W", "H"])]
    resolution: Option<Vec<u32>>,
    /// At most N×N rays a pixel, instead of the dataset's `sample`
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
        if self
            .output
            .extension()
            .is_none_or(|extension| !extension.eq_ignore_ascii_case("png"))
        {
            return Err(format!(
                "{}: only PNG pictures are written; give the output a name ending in .png",
                self.output.display()
            ));
        }
        let mut loaded = files::load(&self.file)?;
        let clean = report::to_stderr(&loaded);
        let scene = &mut loaded.compiled.scene;
        if let Some(size) = &self.resolution {
            scene.settings.frame = [size[0], size[1]];
        }
        if let Some(samples) = self.samples {
            scene.settings.samples = samples;
        }
        if let Some(switch) = self.soft {
            scene.settings.soft = matches!(switch, Switch::On);
        }
        let [width, height] = scene.settings.frame;
        let largest = scene::Settings::MAX_FRAME;
        if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
            return Err(format!(
                "a picture of {width}×{height} pixels cannot be made: each side must be 1 to {largest}"
            ));
        }
        if !(1..=scene::Settings::MAX_SAMPLES).contains(&scene.settings.samples) {
            return Err(format!("-s takes 1 to {}", scene::Settings::MAX_SAMPLES));
        }
        let threads = match self.threads {
            Some(0) => return Err(String::from("--threads takes 1 or more")),
            Some(threads) => threads.min(1024),
            None => std::thread::available_parallelism().map_or(1, usize::from),
        };

        let start = Instant::now();
        let (pixels, stats) = tracer::render(
            scene,
            [width, height],
            threads,
            tracer::Pass::Smooth,
            &|_| (),
        );
        let trace = start.elapsed().as_secs_f64();
        let start = Instant::now();
        write_png(&self.output, width, height, &pixels)?;
        let write = start.elapsed().as_secs_f64();

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
                "threads": threads,
                "seconds": { "compile": loaded.compile_seconds, "trace": trace, "write": write },
            });
            println!("{summary}");
        } else {
            eprintln!(
                "{}: {width}×{height}, {} rays, {trace:.2} s on {threads} threads",
                self.output.display(),
                stats.primary_rays + stats.shadow_rays
            );
        }
        Ok(clean)
    }
}

fn write_png(path: &Path, width: u32, height: u32, rgba: &[u8]) -> Result<(), String> {
    let fail = |error: &dyn std::fmt::Display| format!("cannot write {}: {error}", path.display());
    let file = std::fs::File::create(path).map_err(|error| fail(&error))?;
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), width, height);
    // Every pixel is opaque, so the alpha channel would be a quarter of the file for nothing.
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let rgb: Vec<u8> = rgba
        .chunks_exact(4)
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    let mut writer = encoder.write_header().map_err(|error| fail(&error))?;
    writer
        .write_image_data(&rgb)
        .map_err(|error| fail(&error))?;
    writer.finish().map_err(|error| fail(&error))
}
