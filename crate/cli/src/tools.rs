//! The TOOLS group of the language: jobs on the pictures in a dataset's folder.
//!
//! A dataset may come from a stranger, so a job reads and writes nothing outside the folder of the
//! dataset, not even through a link that lies in it, and never writes over a dataset. It does write
//! over pictures of the name that the text gives, as a second run of the same text must.

use crate::{files, trace};
use picture::animation::{self, Timing, Writer};
use picture::combine::{self, remains};
use picture::{Format, Picture, collage, file, plot, resize, swatches};
use rats::tool::{Playback, Shown, Tool};
use std::collections::HashSet;
use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Largest file of a picture that is read, bytes.
const MAX_FILE: u64 = 512 << 20;
/// Frames a second, where the text says nothing.
const SPEED: f64 = 12.0;

/// Carries out the jobs of a text in order, in the dataset's folder. Each gives a sentence that says what was
/// done, or why it could not be; one that fails does not keep the others from being tried.
pub fn carry_out(tools: &[Tool], folder: &Path) -> Vec<Result<String, String>> {
    let mut bench = Bench::new(folder);
    tools.iter().map(|tool| bench.job(tool)).collect()
}

/// Writes a picture under a name that a text gives, in the dataset's folder, and says so.
///
/// # Errors
/// If the name leads out of the folder, is that of a dataset or of no known format, or if writing fails.
pub fn save(folder: &Path, name: &str, picture: &Picture) -> Result<String, String> {
    Bench::new(folder).write(name, picture)
}

/// Where the jobs are done.
struct Bench {
    folder: PathBuf,
    /// Names that this run has given to results for which the text has no name.
    taken: HashSet<String>,
}

impl Bench {
    fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_path_buf(),
            taken: HashSet::new(),
        }
    }

    fn job(&mut self, tool: &Tool) -> Result<String, String> {
        match tool {
            Tool::Animate {
                files,
                playback,
                dither,
            } => {
                let order: Vec<usize> = match playback {
                    Playback::Mirror => animation::mirrored(files.len()).collect(),
                    Playback::Once | Playback::Loop => (0..files.len()).collect(),
                };
                // Dots are of use only where colours are few.
                let ending = if *dither { "gif" } else { "png" };
                let to = self.fresh("animation", ending);
                let repeats = *playback != Playback::Once;
                let timing = Timing::new(SPEED, repeats).map_err(|problem| problem.to_string())?;
                self.animation(files, &order, None, timing, *dither, &to)
            }
            Tool::Fli { files, speed, size } => {
                let order: Vec<usize> = (0..files.len()).collect();
                let timing = Timing::new(speed.unwrap_or(SPEED), true)
                    .map_err(|problem| problem.to_string())?;
                let to = self.fresh("fli", "gif");
                self.animation(files, &order, *size, timing, false, &to)
            }
            Tool::Play { file } => self.describe(file),
            Tool::Split { file, pattern } => self.split(file, pattern.as_deref()),
            Tool::Collage { columns, files } => {
                let pictures = files
                    .iter()
                    .map(|name| self.read(name))
                    .collect::<Result<Vec<_>, _>>()?;
                let columns = columns.map(|columns| columns as usize);
                let sheet = collage(&pictures, columns).map_err(|problem| problem.to_string())?;
                let to = self.fresh("collage", "png");
                self.write(&to, &sheet)
            }
            Tool::Convert { from, to } => {
                let picture = self.read(from)?;
                self.write(to, &picture)
            }
            Tool::Resize {
                file,
                width,
                height,
            } => {
                let resized = resize(&self.read(file)?, *width, *height)
                    .map_err(|problem| format!("{file}: {problem}"))?;
                let (stem, ending) = split_name(file);
                self.write(&format!("{stem}-{width}x{height}{ending}"), &resized)
            }
            Tool::Diff { a, b, save } => self.combine("diff", combine::diff, a, b, save.as_deref()),
            Tool::And { a, b, save } => self.combine("and", combine::and, a, b, save.as_deref()),
            Tool::Xor { a, b, save } => self.combine("xor", combine::xor, a, b, save.as_deref()),
            Tool::Show { what } => match what {
                Shown::File(file) => self.describe(file),
                Shown::Colour { name, rgb } => {
                    let to = self.fresh("colour", "png");
                    let said = self.swatches(&to, &[*rgb])?;
                    Ok(format!("{name}: {said}"))
                }
                Shown::Palette(colours) => {
                    let to = self.fresh("palette", "png");
                    self.swatches(&to, colours)
                }
            },
            Tool::Table { values } => {
                let line = plot(values).map_err(|problem| problem.to_string())?;
                let to = self.fresh("table", "png");
                self.write(&to, &line)
            }
        }
    }

    /// A name for a result that the text does not name: `table.png`, and `table-2.png` for the second of
    /// this run.
    fn fresh(&mut self, stem: &str, ending: &str) -> String {
        let names = (1..).map(|number| match number {
            1 => format!("{stem}.{ending}"),
            _ => format!("{stem}-{number}.{ending}"),
        });
        for name in names {
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
        unreachable!("numbers do not end")
    }

    /// The bytes of a file of the folder, and its format.
    fn bytes(&self, name: &str) -> Result<(Vec<u8>, Format), String> {
        let path = files::inside(&self.folder, name).ok_or_else(|| outside(name))?;
        let format = Format::of(&path).map_err(|problem| problem.to_string())?;
        let fail = |error| format!("cannot read {name}: {error}");
        let real = path.canonicalize().map_err(fail)?;
        if !real.starts_with(self.canonical()?) {
            return Err(outside(name));
        }
        let size = real.metadata().map_err(fail)?.len();
        if size > MAX_FILE {
            return Err(format!(
                "{name} has {size} bytes; the limit for a picture is {MAX_FILE}"
            ));
        }
        Ok((std::fs::read(real).map_err(fail)?, format))
    }

    fn read(&self, name: &str) -> Result<Picture, String> {
        let (bytes, format) = self.bytes(name)?;
        file::decode(&bytes, format).map_err(|problem| format!("{name}: {problem}"))
    }

    fn canonical(&self) -> Result<PathBuf, String> {
        let folder = if self.folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            &self.folder
        };
        folder
            .canonicalize()
            .map_err(|error| format!("cannot open {}: {error}", folder.display()))
    }

    /// Where a result may be written.
    fn target(&self, name: &str) -> Result<(PathBuf, Format), String> {
        let path = files::inside(&self.folder, name).ok_or_else(|| outside(name))?;
        let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        if files::DATASETS
            .iter()
            .any(|known| known.eq_ignore_ascii_case(ending))
        {
            return Err(format!(
                "{name} is a dataset and is not written over; choose a name ending in one of {}",
                Format::ENDINGS
            ));
        }
        let format = Format::of(&path).map_err(|problem| problem.to_string())?;
        let parent = path.parent().unwrap_or(&self.folder);
        let parent = if parent.as_os_str().is_empty() {
            Path::new(".")
        } else {
            parent
        };
        let real = parent
            .canonicalize()
            .map_err(|error| format!("cannot write {name}: {error}"))?;
        let is_link = path
            .symlink_metadata()
            .is_ok_and(|data| data.file_type().is_symlink());
        if is_link || !real.starts_with(self.canonical()?) {
            return Err(outside(name));
        }
        Ok((path, format))
    }

    fn write(&self, name: &str, picture: &Picture) -> Result<String, String> {
        let (path, format) = self.target(name)?;
        let bytes = file::encode(picture, format).map_err(|problem| problem.to_string())?;
        trace::whole(&path, |file| {
            file.write_all(&bytes).map_err(|error| error.to_string())
        })?;
        let [width, height] = picture.size();
        Ok(format!("wrote {name}, {width}×{height}"))
    }

    fn swatches(&self, to: &str, colours: &[[f32; 3]]) -> Result<String, String> {
        let sheet = swatches(colours).map_err(|problem| problem.to_string())?;
        self.write(to, &sheet)
    }

    fn combine(
        &self,
        verb: &str,
        join: fn(&Picture, &Picture) -> Result<Picture, picture::Problem>,
        a: &str,
        b: &str,
        save: Option<&str>,
    ) -> Result<String, String> {
        let joined = join(&self.read(a)?, &self.read(b)?)
            .map_err(|problem| format!("{a} and {b}: {problem}"))?;
        let left = remains(&joined);
        let [width, height] = joined.size();
        let all = u64::from(width) * u64::from(height);
        let said = format!(
            "{verb} of {a} and {b}: {} of {all} pixels are not black, the largest value is {}",
            left.pixels, left.largest
        );
        match save {
            Some(to) => Ok(format!("{said}; {}", self.write(to, &joined)?)),
            None => Ok(said),
        }
    }

    /// Writes an animation of the files in this order.
    fn animation(
        &self,
        files: &[String],
        order: &[usize],
        size: Option<[u32; 2]>,
        timing: Timing,
        dither: bool,
        to: &str,
    ) -> Result<String, String> {
        let frame = |index: &usize| {
            let name = &files[*index];
            let picture = self.read(name)?;
            match size {
                Some([width, height]) => resize(&picture, width, height),
                None => Ok(picture),
            }
            .map_err(|problem| format!("{name}: {problem}"))
        };
        let Some((first, others)) = order.split_first() else {
            return Err(String::from("an animation needs at least one picture"));
        };
        let first = frame(first)?;
        let (path, format) = self.target(to)?;
        let count = u32::try_from(order.len()).unwrap_or(u32::MAX);
        let say = |problem: picture::Problem| problem.to_string();
        trace::whole(&path, |file| {
            let mut writer =
                Writer::begin(file, format, &first, count, timing, dither).map_err(say)?;
            for index in others {
                writer
                    .add(&frame(index)?)
                    .map_err(|problem| format!("{}: {problem}", files[*index]))?;
            }
            writer.finish().map_err(say)
        })?;
        let [width, height] = first.size();
        Ok(format!("wrote {to}, {count} frames of {width}×{height}"))
    }

    fn split(&self, name: &str, pattern: Option<&str>) -> Result<String, String> {
        let (bytes, format) = self.bytes(name)?;
        let (stem, ending) = split_name(pattern.unwrap_or("frame.png"));
        let frames =
            animation::frames(&bytes, format).map_err(|problem| format!("{name}: {problem}"))?;
        let mut count = 0_usize;
        for frame in frames {
            let frame =
                frame.map_err(|problem| format!("{name}: after {count} frames: {problem}"))?;
            self.write(&format!("{stem}{count:03}{ending}"), &frame)?;
            count += 1;
        }
        Ok(format!(
            "wrote {count} frames of {name} to {stem}000{ending} …"
        ))
    }

    /// There is no window to show a picture in, so its measures are told.
    fn describe(&self, name: &str) -> Result<String, String> {
        let (bytes, format) = self.bytes(name)?;
        let fail = |problem: picture::Problem| format!("{name}: {problem}");
        let mut frames = 1_usize;
        let [width, height] = match format {
            Format::Png | Format::Gif => {
                let mut all = animation::frames(&bytes, format).map_err(fail)?;
                let first = all
                    .next()
                    .ok_or_else(|| format!("{name} holds no picture"))?
                    .map_err(fail)?;
                for frame in all {
                    frame.map_err(fail)?;
                    frames += 1;
                }
                first.size()
            }
            _ => file::decode(&bytes, format).map_err(fail)?.size(),
        };
        let number = match frames {
            1 => String::new(),
            _ => format!("{frames} frames of "),
        };
        Ok(format!(
            "{name}: {}, {number}{width}×{height}",
            format.name()
        ))
    }
}

fn outside(name: &str) -> String {
    format!("{name} leads out of the dataset's folder; put the picture into that folder")
}

/// `a/b.png` → (`a/b`, `.png`).
fn split_name(name: &str) -> (&str, &str) {
    match name.rfind('.') {
        Some(dot) if !name[dot..].contains(['/', '\\']) => name.split_at(dot),
        _ => (name, ""),
    }
}

#[cfg(test)]
#[path = "tools_tests.rs"]
mod tests;
