//! The jobs of a text, one after the other.

use crate::files::{Done, bytes, measures, read, resize_within_room, say, write};
use crate::work::{Collage, Count, Film, Split, Turn, Work};
use crate::{Shelf, name};
use picture::animation::{self, Timing};
use picture::combine::{self, remains};
use picture::{Format, Picture, Problem, plot, swatches};
use rats::Tool;
use rats::tool::{Playback, Shown};
use std::collections::HashSet;

/// Frames a second, where the text says nothing.
const SPEED: f64 = 12.0;

/// Result of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// The job goes on.
    Working,
    /// The job is done, or a sentence says why it could not be.
    Finished(Result<Done, String>),
}

/// A bench that does the jobs of a text in order. One that fails does not keep the others from
/// being tried.
pub struct Bench<S> {
    shelf: S,
    tools: Vec<Tool>,
    next: usize,
    /// The rest of the job that was begun.
    work: Option<Work>,
    names: Names,
}

impl<S: Shelf> Bench<S> {
    /// Puts the jobs on the bench. Nothing is done before the first [`Self::step`].
    #[must_use]
    pub fn new(shelf: S, tools: Vec<Tool>) -> Self {
        let mut names = Names::default();
        for tool in &tools {
            tool.writes().iter().for_each(|name| names.take(name));
        }
        Self {
            shelf,
            tools,
            next: 0,
            work: None,
            names,
        }
    }

    /// Keeps a name from being given to a result that the text does not name, as those are that the
    /// text gives to results.
    pub fn reserve(&mut self, name: &str) {
        self.names.take(name);
    }

    /// The shelf on which the pictures lie.
    #[must_use]
    pub fn shelf(&self) -> &S {
        &self.shelf
    }

    /// The shelf on which the pictures lie, to put another there.
    pub fn shelf_mut(&mut self) -> &mut S {
        &mut self.shelf
    }

    /// The job that the next step is of; `None` when all are done.
    #[must_use]
    pub fn tool(&self) -> Option<&Tool> {
        self.tools.get(self.next)
    }

    /// Returns the number of jobs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.tools.len()
    }

    /// Returns the number of jobs that are done.
    #[must_use]
    pub fn finished(&self) -> usize {
        self.next
    }

    /// Goes on by at most one picture; `None` when all jobs are done.
    pub fn step(&mut self) -> Option<Step> {
        let tool = self.tools.get(self.next)?;
        let turn = match self.work.take() {
            Some(work) => work.step(&self.shelf),
            None => {
                // Files that a job reads are not overwritten by its own result or by a later one's.
                // (What a later job reads may be this one's result.)
                tool.reads().iter().for_each(|name| self.names.take(name));
                begin(tool, &self.shelf, &mut self.names)
            }
        };
        let finished = match turn {
            Ok(Turn::Working(work)) => {
                self.work = Some(work);
                return Some(Step::Working);
            }
            Ok(Turn::Done(done)) => Ok(done),
            Err(sentence) => Err(sentence),
        };
        self.next += 1;
        Some(Step::Finished(finished))
    }
}

/// Names for results that the text does not name.
#[derive(Default)]
struct Names(HashSet<String>);

impl Names {
    /// Takes a name, which no result gets then.
    fn take(&mut self, name: &str) {
        self.0.insert(name::plain(name).to_owned());
    }

    /// `table.png`, and `table-2.png` for the second of a text.
    fn fresh(&mut self, stem: &str, ending: &str) -> String {
        let names = (1..).map(|number| match number {
            1 => format!("{stem}.{ending}"),
            _ => format!("{stem}-{number}.{ending}"),
        });
        for name in names {
            if self.0.insert(name.clone()) {
                return name;
            }
        }
        unreachable!("numbers do not end")
    }
}

fn finish(shelf: &dyn Shelf, to: String, picture: &Picture) -> Result<Turn, String> {
    let said = write(shelf, &to, picture)?;
    let files = vec![to];
    Ok(Turn::Done(Done { said, files }))
}

fn begin(tool: &Tool, shelf: &dyn Shelf, names: &mut Names) -> Result<Turn, String> {
    match tool {
        Tool::Animate {
            files,
            playback,
            dither,
        } => {
            let order: Vec<usize> = match playback {
                Playback::Mirror => animation::mirror(files.len()).collect(),
                Playback::Once | Playback::Loop => (0..files.len()).collect(),
            };
            // Dots are of use only where colours are few.
            let ending = if *dither { "gif" } else { "png" };
            let to = names.fresh("animation", ending);
            let repeats = *playback != Playback::Once;
            let timing = Timing::new(SPEED, repeats).map_err(say)?;
            let film = Film::new(files, order, None, timing, *dither, to)?;
            Ok(Turn::Working(Work::Film(film)))
        }
        Tool::Fli { files, speed, size } => {
            let order = (0..files.len()).collect();
            let timing = Timing::new(speed.unwrap_or(SPEED), true).map_err(say)?;
            let to = names.fresh("fli", "gif");
            let film = Film::new(files, order, *size, timing, false, to)?;
            Ok(Turn::Working(Work::Film(film)))
        }
        Tool::Play { file } => describe(shelf, file),
        Tool::Split { file, pattern } => {
            let (bytes, format) = bytes(shelf, file)?;
            let (stem, ending) = name::split(pattern.as_deref().unwrap_or("frame.png"));
            let split = Split::new(shelf, file, bytes, format, [stem, ending])?;
            Ok(Turn::Working(Work::Split(split)))
        }
        Tool::Collage { columns, files } => {
            let columns = columns.map(|columns| columns as usize);
            let to = names.fresh("collage", "png");
            let collage = Collage::new(files, columns, to);
            Ok(Turn::Working(Work::Collage(collage)))
        }
        Tool::Convert { from, to } => finish(shelf, to.clone(), &read(shelf, from)?),
        Tool::Resize {
            file,
            width,
            height,
        } => {
            let picture = resize_within_room(shelf, file, &read(shelf, file)?, [*width, *height])?;
            let (stem, ending) = name::split(file);
            finish(shelf, format!("{stem}-{width}x{height}{ending}"), &picture)
        }
        Tool::Diff { a, b, save } => join(shelf, names, "diff", combine::diff, [a, b], save),
        Tool::And { a, b, save } => join(shelf, names, "and", combine::and, [a, b], save),
        Tool::Xor { a, b, save } => join(shelf, names, "xor", combine::xor, [a, b], save),
        Tool::Show { what } => match what {
            Shown::File(file) => describe(shelf, file),
            Shown::Colour { name, rgb } => {
                let to = names.fresh("colour", "png");
                let said = write(shelf, &to, &swatches(&[*rgb]).map_err(say)?)?;
                Ok(Turn::Done(Done {
                    said: format!("{name}: {said}"),
                    files: vec![to],
                }))
            }
            Shown::Palette(colours) => {
                let to = names.fresh("palette", "png");
                finish(shelf, to, &swatches(colours).map_err(say)?)
            }
        },
        Tool::Table { values } => {
            let to = names.fresh("table", "png");
            finish(shelf, to, &plot(values).map_err(say)?)
        }
    }
}

/// A function that makes one picture of two.
type Join = fn(&Picture, &Picture) -> Result<Picture, Problem>;

fn join(
    shelf: &dyn Shelf,
    names: &mut Names,
    verb: &str,
    join: Join,
    [a, b]: [&str; 2],
    save: &Option<String>,
) -> Result<Turn, String> {
    let joined = join(&read(shelf, a)?, &read(shelf, b)?)
        .map_err(|problem| format!("{a} and {b}: {problem}"))?;
    let left = remains(&joined);
    let [width, height] = joined.size();
    let all = u64::from(width) * u64::from(height);
    let mut done = Done {
        said: format!(
            "{verb} of {a} and {b}: {} of {all} pixels are not black, the largest value is {}",
            left.pixels, left.largest
        ),
        files: Vec::new(),
    };
    if let Some(to) = save {
        let said = write(shelf, to, &joined)?;
        done.said = format!("{}; {said}", done.said);
        done.files.push(to.clone());
    } else if shelf.is_seen() {
        let to = names.fresh(verb, "png");
        write(shelf, &to, &joined)?;
        done.files.push(to);
    }
    Ok(Turn::Done(done))
}

/// Tells the measures of a picture or an animation that is to be shown.
fn describe(shelf: &dyn Shelf, file: &str) -> Result<Turn, String> {
    let (bytes, format) = bytes(shelf, file)?;
    let size = match format {
        Format::Png | Format::Gif => {
            let count = Count::new(shelf, file, bytes, format)?;
            return Ok(Turn::Working(Work::Count(count)));
        }
        _ => read(shelf, file)?.size(),
    };
    Ok(Turn::Done(Done {
        said: measures(file, format, 1, size),
        files: vec![file.to_owned()],
    }))
}
