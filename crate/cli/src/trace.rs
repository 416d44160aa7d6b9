//! Traces a scene to a picture in a file, as several subcommands need it.

use crate::whole;
use picture::{Format, Picture, file};
use scene::{Scene, Settings};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Options of the command line that override the dataset.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wishes {
    /// Width and height, pixels.
    pub size: Option<[u32; 2]>,
    /// The most rays a pixel, n×n.
    pub samples: Option<u32>,
    /// Whether soft shapes blend.
    pub soft: Option<bool>,
    /// Threads; `None`: as many as the machine has cores.
    pub threads: Option<usize>,
}

/// A picture and what it took.
pub struct Traced {
    /// The picture.
    pub picture: Picture,
    /// Counts of the work.
    pub stats: tracer::Stats,
    /// Time, seconds.
    pub seconds: f64,
    /// Threads used.
    pub threads: usize,
}

impl Wishes {
    /// Changes a scene's settings to these.
    ///
    /// # Errors
    /// If a size or a number of rays is out of its range.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), String> {
        let settings = &mut scene.settings;
        settings.frame = self.size.unwrap_or(settings.frame);
        if let Some(samples) = self.samples {
            (settings.samples, settings.block) = (samples, 1);
        }
        settings.soft = self.soft.unwrap_or(settings.soft);
        let [width, height] = settings.frame;
        let largest = Settings::MAX_FRAME;
        if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
            return Err(format!(
                "a picture of {width}×{height} pixels cannot be made: \
                 each side must be 1 to {largest}"
            ));
        }
        if !(1..=Settings::MAX_SAMPLES).contains(&settings.samples) {
            return Err(format!("-s takes 1 to {}", Settings::MAX_SAMPLES));
        }
        Ok(())
    }

    /// Traces a scene as asked for. `progress` is called from any thread with the share done, 0 …
    /// 1.
    ///
    /// # Errors
    /// Fails as [`Self::apply`] does, or if the number of threads is 0.
    pub fn trace(
        &self,
        scene: &mut Scene,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Traced, String> {
        self.apply(scene)?;
        let threads = match self.threads {
            Some(0) => return Err(String::from("--threads takes 1 or more")),
            Some(threads) => threads.min(1024),
            None => std::thread::available_parallelism().map_or(1, usize::from),
        };
        let start = Instant::now();
        let size = scene.settings.frame;
        let picture = digger::picture(scene, size);
        let (pixels, stats) = tracer::render(&picture, threads, tracer::Pass::Smooth, progress);
        let seconds = start.elapsed().as_secs_f64();
        let picture =
            Picture::new(size[0], size[1], pixels).map_err(|problem| problem.to_string())?;
        Ok(Traced {
            picture,
            stats,
            seconds,
            threads,
        })
    }
}

/// Checks that a name given on the command line is that of a picture, before hours are spent on it.
///
/// # Errors
/// If the name's ending is not that of a known format.
pub fn check_name(path: &Path) -> Result<(), String> {
    Format::of(path).map_or_else(|problem| Err(problem.to_string()), |_| Ok(()))
}

/// Returns the name of the n-th of several pictures; the last one has the name itself:
/// `out.png`, 2 → `out-2.png`.
pub fn number_name(path: &Path, number: usize) -> PathBuf {
    let [stem, ending] = [path.file_stem(), path.extension()]
        .map(|part| part.unwrap_or_default().to_string_lossy().into_owned());
    path.with_file_name(format!("{stem}-{number}.{ending}"))
}

/// Writes a picture in the format of the name's ending.
///
/// # Errors
/// If the ending is not that of a known format, or if the file cannot be written.
pub fn write(path: &Path, picture: &Picture) -> Result<(), String> {
    let format = Format::of(path).map_err(|problem| problem.to_string())?;
    let bytes = file::encode(picture, format)
        .map_err(|problem| format!("cannot write {}: {problem}", path.display()))?;
    whole::write(path, |file| {
        file.write_all(&bytes).map_err(|error| error.to_string())
    })
}
