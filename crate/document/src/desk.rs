//! The files that a text's jobs find in the page: the images of the work, its traced picture, and
//! results of the jobs before. Results are kept in memory, only as long as they are on the tray.

use crate::asset::{self, Asset};
use ::picture::{Format, Picture, Problem, file};
use darkroom::{Shelf, Target, name};
use pool::Image;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

/// Most pixels of a picture that a job may read or make, 2048 × 2048. A job takes a few tenths of a
/// second with it, in which the page stands still.
pub const MAX_PIXELS: u64 = 4 << 20;
/// Most bytes of all results together.
pub const MAX_BYTES: usize = 64 << 20;
/// Most results.
pub const MAX_RESULTS: usize = 256;

/// Files written by the jobs of one run.
#[derive(Default)]
struct Made {
    files: BTreeMap<String, Arc<[u8]>>,
    bytes: usize,
}

/// The files of one run of the jobs.
pub struct Desk {
    assets: Vec<Asset>,
    /// The name of the traced picture, and whether it is to be saved.
    picture: (String, bool),
    /// The traced picture as a file, once it is finished, or why there is none.
    drawn: Option<Result<Arc<[u8]>, String>>,
    made: Rc<RefCell<Made>>,
}

impl Desk {
    /// Makes a desk with the images of the work. `picture` is the name of the traced picture, and
    /// whether it is to be saved.
    #[must_use]
    pub fn new(assets: Vec<Asset>, picture: (String, bool)) -> Self {
        Self {
            assets,
            picture,
            drawn: None,
            made: Rc::default(),
        }
    }

    /// Puts the traced picture on the desk.
    pub fn put_picture(&mut self, image: &Image) {
        let name = &self.picture.0;
        let drawn = encode(image, name).map(Arc::from);
        self.drawn = Some(drawn.map_err(|problem| format!("{name}: {problem}")));
    }

    /// Whether a job that reads these files waits for the traced picture.
    #[must_use]
    pub fn waits_for(&self, names: &[&str]) -> bool {
        let (name, saved) = &self.picture;
        *saved
            && self.drawn.is_none()
            && names.iter().any(|wanted| name::plain(wanted) == name)
            && !self.made.borrow().files.contains_key(name)
    }

    /// Returns a file, if it is there.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<Arc<[u8]>> {
        let name = name::plain(name);
        if let Some(bytes) = self.made.borrow().files.get(name) {
            return Some(bytes.clone());
        }
        if self.picture.1
            && name == self.picture.0
            && let Some(Ok(bytes)) = &self.drawn
        {
            return Some(bytes.clone());
        }
        let asset = self.assets.iter().find(|asset| asset.name == name)?;
        Some(asset.bytes.clone())
    }
}

/// Encodes a traced picture as a file of a name.
fn encode(image: &Image, name: &str) -> Result<Vec<u8>, Problem> {
    let [width, height] = image.size;
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        let (size, most) = (image.size, MAX_PIXELS);
        return Err(Problem::NoRoom { size, most });
    }
    let format = Format::of(Path::new(name))?;
    file::encode(&Picture::new(width, height, image.rgba.clone())?, format)
}

impl Shelf for Desk {
    fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        if let Some(bytes) = self.find(name) {
            return Ok(bytes.to_vec());
        }
        let (picture, saved) = &self.picture;
        if name::plain(name) != picture {
            return Err(format!(
                "there is no {name} here; \
                    drop the picture on the page and it becomes a file of the work"
            ));
        }
        match &self.drawn {
            Some(Err(sentence)) if *saved => Err(sentence.clone()),
            _ if !saved => Err(format!(
                "nosave is on, so the picture is not saved as {name}; turn it off"
            )),
            _ => Err(format!("{name} is not finished")),
        }
    }

    fn create(&self, name: &str) -> Result<Box<dyn Target>, String> {
        if !name::stays_inside(name) {
            return Err(name::outside(name));
        }
        let name = name::plain(name);
        let made = self.made.borrow();
        if made.files.len() >= MAX_RESULTS && !made.files.contains_key(name) {
            return Err(format!(
                "{name} is not made: the page holds {MAX_RESULTS} results; \
                    the program has no such limit"
            ));
        }
        Ok(Box::new(Sheet {
            name: name.to_owned(),
            bytes: Vec::new(),
            made: self.made.clone(),
        }))
    }

    fn most_pixels(&self) -> u64 {
        MAX_PIXELS
    }

    fn is_seen(&self) -> bool {
        true
    }
}

/// A result that is being written.
struct Sheet {
    name: String,
    bytes: Vec<u8>,
    made: Rc<RefCell<Made>>,
}

impl Write for Sheet {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let all = self.made.borrow().bytes + self.bytes.len() + bytes.len();
        if all > MAX_BYTES {
            let most = asset::size(MAX_BYTES);
            return Err(io::Error::other(format!(
                "the page holds {most} of results; the program has no such limit"
            )));
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Target for Sheet {
    fn keep(self: Box<Self>) -> Result<(), String> {
        let mut made = self.made.borrow_mut();
        made.bytes += self.bytes.len();
        if let Some(old) = made.files.insert(self.name, self.bytes.into()) {
            made.bytes -= old.len();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn desk(saved: bool) -> Desk {
        let asset = Asset::await_mesh("a.png", [1]);
        Desk::new(vec![asset], (String::from("scene.mtv"), saved))
    }

    fn write(desk: &Desk, name: &str, bytes: &[u8]) -> Result<(), String> {
        let mut target = desk.create(name)?;
        target.write_all(bytes).map_err(|error| error.to_string())?;
        target.keep()
    }

    #[test]
    fn a_result_lies_over_a_file_of_the_work() {
        let desk = desk(true);
        assert_eq!(desk.read("a.png"), Ok(vec![1]));
        write(&desk, "a.png", &[2]).unwrap();
        assert_eq!(desk.read("a.png"), Ok(vec![2]));
        drop(desk.create("a.png").unwrap());
        assert_eq!(
            desk.read("a.png"),
            Ok(vec![2]),
            "a target that is not kept leaves no file"
        );
        assert!(desk.read("b.png").unwrap_err().contains("no b.png here"));
    }

    #[test]
    fn the_picture_is_there_when_it_is_finished_unless_it_is_not_saved() {
        let image = Image {
            size: [1, 1],
            rgba: vec![1, 2, 3, 255],
        };
        let mut saved = desk(true);
        assert!(saved.waits_for(&["a.png", "scene.mtv"]));
        assert!(!saved.waits_for(&["a.png"]));
        saved.put_picture(&image);
        assert!(!saved.waits_for(&["scene.mtv"]));
        assert_eq!(saved.read("scene.mtv"), Ok(b"1 1\n\x01\x02\x03".to_vec()));
        let mut unsaved = desk(false);
        assert!(!unsaved.waits_for(&["scene.mtv"]));
        unsaved.put_picture(&image);
        assert!(unsaved.read("scene.mtv").unwrap_err().contains("nosave"));
        let large = Image {
            size: [2049, 2048],
            rgba: Vec::new(),
        };
        saved.put_picture(&large);
        let sentence = saved.read("scene.mtv").unwrap_err();
        assert!(sentence.contains("4194304 is the limit"), "{sentence}");
    }

    #[test]
    fn results_are_limited() {
        let desk = desk(true);
        let half = vec![0; MAX_BYTES / 2];
        write(&desk, "a.png", &half).unwrap();
        write(&desk, "b.png", &half).unwrap();
        assert!(write(&desk, "c.png", &[0]).unwrap_err().contains("holds"));
        write(&desk, "b.png", &[]).unwrap();
        for number in 2..MAX_RESULTS {
            write(&desk, &format!("{number}.png"), &[0]).unwrap();
        }
        assert!(write(&desk, "c.png", &[]).unwrap_err().contains("256"));
        write(&desk, "2.png", &[]).unwrap();
    }
}
