//! Jobs of many pictures, which go on picture by picture.

use crate::files::{Done, create, measures, read, resize_within_room, say, write};
use crate::{Shelf, Target};
use picture::animation::{self, Frames, Timing, Writer};
use picture::{Format, Picture, collage_at_most};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

/// The rest of a job.
pub enum Work {
    Film(Film),
    Split(Split),
    Collage(Collage),
    Count(Count),
}

/// The state of a job after a step.
pub(crate) enum Turn {
    Working(Work),
    Done(Done),
}

impl Work {
    /// Goes on by one picture.
    pub fn step(self, shelf: &dyn Shelf) -> Result<Turn, String> {
        match self {
            Self::Film(film) => film.step(shelf),
            Self::Split(split) => split.step(shelf),
            Self::Collage(collage) => collage.step(shelf),
            Self::Count(count) => count.step(),
        }
    }
}

/// A file that an animation's writer owns until its end, and that is kept after that.
#[derive(Clone)]
struct Shared(Rc<RefCell<Option<Box<dyn Target>>>>);

impl Shared {
    fn new(target: Box<dyn Target>) -> Self {
        Self(Rc::new(RefCell::new(Some(target))))
    }

    fn keep(&self) -> Result<(), String> {
        let target = self.0.borrow_mut().take();
        target.map_or(Ok(()), Target::keep)
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut *self.0.borrow_mut() {
            Some(target) => target.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut *self.0.borrow_mut() {
            Some(target) => target.flush(),
            None => Ok(()),
        }
    }
}

/// An animation that is being made.
pub struct Film {
    files: Vec<String>,
    /// The index of each frame's file.
    order: Vec<usize>,
    done: usize,
    size: Option<[u32; 2]>,
    timing: Timing,
    dither: bool,
    to: String,
    begun: Option<(Writer<Shared>, Shared, [u32; 2])>,
}

impl Film {
    pub fn new(
        files: &[String],
        order: Vec<usize>,
        size: Option<[u32; 2]>,
        timing: Timing,
        dither: bool,
        to: String,
    ) -> Result<Self, String> {
        if order.is_empty() {
            return Err(String::from("an animation needs at least one picture"));
        }
        Ok(Self {
            files: files.to_vec(),
            order,
            done: 0,
            size,
            timing,
            dither,
            to,
            begun: None,
        })
    }

    fn step(mut self, shelf: &dyn Shelf) -> Result<Turn, String> {
        let count = u32::try_from(self.order.len()).unwrap_or(u32::MAX);
        if let Some(&index) = self.order.get(self.done) {
            let file = &self.files[index];
            let frame = read(shelf, file)?;
            let frame = match self.size {
                Some(size) => resize_within_room(shelf, file, &frame, size)?,
                None => frame,
            };
            match &mut self.begun {
                Some((writer, ..)) => writer
                    .add(&frame)
                    .map_err(|problem| format!("{file}: {problem}"))?,
                None => {
                    let (target, format) = create(shelf, &self.to)?;
                    let target = Shared::new(target);
                    let to = target.clone();
                    let writer = Writer::begin(to, format, &frame, count, self.timing, self.dither);
                    self.begun = Some((writer.map_err(say)?, target, frame.size()));
                }
            }
            self.done += 1;
            return Ok(Turn::Working(Work::Film(self)));
        }
        let Some((writer, target, [width, height])) = self.begun else {
            return Err(String::from("an animation needs at least one picture"));
        };
        writer.finish().map_err(say)?;
        target.keep()?;
        Ok(Turn::Done(Done {
            said: format!("wrote {}, {count} frames of {width}×{height}", self.to),
            files: vec![self.to],
        }))
    }
}

/// An animation that is being taken apart.
pub struct Split {
    file: String,
    frames: Frames<'static>,
    stem: String,
    ending: String,
    files: Vec<String>,
}

impl Split {
    pub fn new(
        shelf: &dyn Shelf,
        file: &str,
        bytes: Vec<u8>,
        format: Format,
        [stem, ending]: [&str; 2],
    ) -> Result<Self, String> {
        Ok(Self {
            frames: frames(shelf, file, bytes, format)?,
            file: file.to_owned(),
            stem: stem.to_owned(),
            ending: ending.to_owned(),
            files: Vec::new(),
        })
    }

    fn step(mut self, shelf: &dyn Shelf) -> Result<Turn, String> {
        let count = self.files.len();
        let next = self.frames.next();
        let Self {
            file, stem, ending, ..
        } = &self;
        let Some(frame) = next else {
            return Ok(Turn::Done(Done {
                said: format!("wrote {count} frames of {file} to {stem}000{ending} …"),
                files: self.files,
            }));
        };
        let frame = frame.map_err(|problem| format!("{file}: after {count} frames: {problem}"))?;
        let to = format!("{stem}{count:03}{ending}");
        write(shelf, &to, &frame)?;
        self.files.push(to);
        Ok(Turn::Working(Work::Split(self)))
    }
}

/// A sheet whose pictures are being gathered.
pub struct Collage {
    files: Vec<String>,
    pictures: Vec<Picture>,
    pixels: u64,
    columns: Option<usize>,
    to: String,
}

impl Collage {
    pub fn new(files: &[String], columns: Option<usize>, to: String) -> Self {
        Self {
            files: files.to_vec(),
            pictures: Vec::new(),
            pixels: 0,
            columns,
            to,
        }
    }

    fn step(mut self, shelf: &dyn Shelf) -> Result<Turn, String> {
        if let Some(file) = self.files.get(self.pictures.len()) {
            let picture = read(shelf, file)?;
            // A sheet has room for all of its pictures, so it would be larger still.
            self.pixels += picture.pixels().len() as u64 / 4;
            self.pictures.push(picture);
            let (count, most) = (self.pictures.len(), shelf.most_pixels());
            if self.pixels > most {
                return Err(format!(
                    "the first {count} pictures have {} pixels together, and {most} is the limit \
                     for a sheet here; resize them first",
                    self.pixels
                ));
            }
            return Ok(Turn::Working(Work::Collage(self)));
        }
        let sheet =
            collage_at_most(&self.pictures, self.columns, shelf.most_pixels()).map_err(say)?;
        let said = write(shelf, &self.to, &sheet)?;
        let files = vec![self.to];
        Ok(Turn::Done(Done { said, files }))
    }
}

/// A picture or an animation whose frames are being counted.
pub struct Count {
    file: String,
    format: Format,
    frames: Frames<'static>,
    count: usize,
    size: [u32; 2],
}

impl Count {
    pub fn new(
        shelf: &dyn Shelf,
        file: &str,
        bytes: Vec<u8>,
        format: Format,
    ) -> Result<Self, String> {
        Ok(Self {
            frames: frames(shelf, file, bytes, format)?,
            file: file.to_owned(),
            format,
            count: 0,
            size: [0, 0],
        })
    }

    fn step(mut self) -> Result<Turn, String> {
        match self.frames.next() {
            Some(frame) => {
                let frame = frame.map_err(|problem| format!("{}: {problem}", self.file))?;
                if self.count == 0 {
                    self.size = frame.size();
                }
                self.count += 1;
                Ok(Turn::Working(Work::Count(self)))
            }
            None if self.count == 0 => Err(format!("{} holds no picture", self.file)),
            None => Ok(Turn::Done(Done {
                said: measures(&self.file, self.format, self.count, self.size),
                files: vec![self.file],
            })),
        }
    }
}

fn frames(
    shelf: &dyn Shelf,
    file: &str,
    bytes: Vec<u8>,
    format: Format,
) -> Result<Frames<'static>, String> {
    animation::frames_at_most(bytes, format, shelf.most_pixels())
        .map_err(|problem| format!("{file}: {problem}"))
}
