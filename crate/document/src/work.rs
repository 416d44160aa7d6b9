//! The open work, its origin, and its way to the storage.
//!
//! The user's own works are on the [`Shelf`]. An example or a shared link is only looked at until
//! it is edited; then it becomes a work of its own. So opening one never replaces a work of the
//! user's.

use crate::asset::Asset;
use crate::examples;
use crate::project_file;
use crate::session::{Kept, Session, check_assets, check_size};
use crate::share;
use crate::storage::{DELAY, Shelf};
use rats::{File, Project};
use scene::Camera;
use std::cell::RefCell;
use std::rc::Rc;

/// Origin of the open work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The user's own.
    Own,
    /// An example of the gallery, not edited yet.
    Example,
    /// A shared link, not edited yet.
    Link,
    /// An empty page, or texts from a script, not edited yet.
    Fresh,
}

/// The open work.
pub struct Work {
    /// Text, undo steps and scene.
    pub session: Session,
    /// The name.
    pub name: String,
    /// The origin.
    pub origin: Origin,
    shelf: Rc<RefCell<Shelf>>,
    /// Returns the milliseconds since 1970.
    clock: fn() -> f64,
    /// The user's own work that was open before the link was.
    before: Option<String>,
    /// Number of works that were opened.
    number: u64,
    /// Time of the first change that is not written yet, seconds.
    changed: Option<f64>,
    /// The session's revision and camera that were last put on the shelf.
    noted: (u64, Option<Camera>),
}

impl Work {
    /// Opens the work that the page begins with: that of a link, else the user's last work, else
    /// the first example. `clock` returns the milliseconds since 1970. With `compile` false nothing
    /// is compiled before the user asks. Returns the work and a message if the link cannot be
    /// opened.
    #[must_use]
    pub fn start(
        shelf: Rc<RefCell<Shelf>>,
        clock: fn() -> f64,
        hash: &str,
        compile: bool,
    ) -> (Self, Option<String>) {
        let mut work = Self {
            session: Session::new(Kept::default(), false),
            name: String::new(),
            origin: Origin::Own,
            shelf,
            clock,
            before: None,
            number: 0,
            changed: None,
            noted: (0, None),
        };
        let last = work.shelf.borrow().last();
        let own = last.is_some_and(|id| work.open_saved(&id).is_ok());
        if !own {
            let first = examples::ALL[0].text.unwrap_or_default();
            work.begin_example(0, first, Vec::new());
        }
        let trouble = work.open_link(hash).err();
        if compile {
            work.session.enable();
        }
        work.session.compile();
        work.note();
        (work, trouble)
    }

    /// Opens the work in a fragment, unless the fragment is empty or its work is open already.
    /// Returns whether it did.
    ///
    /// # Errors
    /// If the link is damaged or the open work cannot be written; then that stays open.
    pub fn open_link(&mut self, hash: &str) -> Result<bool, String> {
        let Some(shared) = share::open(hash) else {
            return Ok(false);
        };
        let shared = shared?;
        let same = self.session.project() == &shared.project
            && self.session.user_camera() == shared.camera;
        if same {
            return Ok(false);
        }
        let before = self.leave()?;
        self.begin(
            title(&shared.project),
            Origin::Link,
            Kept {
                project: shared.project,
                camera: shared.camera,
                ..Kept::default()
            },
        );
        self.before = before;
        Ok(true)
    }

    /// Opens an example with its text, its images and its meshes.
    ///
    /// # Errors
    /// If the open work cannot be written; then it stays open.
    pub fn open_example(
        &mut self,
        index: usize,
        text: &str,
        assets: Vec<Asset>,
    ) -> Result<(), String> {
        self.leave()?;
        self.begin_example(index, text, assets);
        Ok(())
    }

    /// Opens a text that is no work of the user's yet.
    ///
    /// # Errors
    /// If the open work cannot be written; then it stays open.
    pub fn open_text(&mut self, name: &str, text: String, origin: Origin) -> Result<(), String> {
        self.leave()?;
        let file = File {
            name: format!("{}.rat", name.to_lowercase().replace(' ', "-")),
            text,
        };
        self.begin_project(name.to_owned(), Project { files: vec![file] }, origin);
        Ok(())
    }

    /// Opens a work from the shelf.
    ///
    /// # Errors
    /// If the open work cannot be written, or the other one is gone; then the open one stays open.
    pub fn open_saved(&mut self, id: &str) -> Result<(), String> {
        self.leave()?;
        let saved = self.shelf.borrow_mut().open(id);
        let (name, kept) = saved.ok_or("This work was deleted or cannot be read.")?;
        self.name = name;
        self.origin = Origin::Own;
        self.before = None;
        self.number += 1;
        self.session.open(kept);
        self.note();
        Ok(())
    }

    /// Opens texts from a script, like an example.
    ///
    /// # Errors
    /// If they are too long, or the open work cannot be written; then it stays open.
    pub fn load(&mut self, project: Project) -> Result<(), String> {
        check_size(&project).map_err(|refused| refused.to_string())?;
        self.leave()?;
        self.begin_project(title(&project), project, Origin::Fresh);
        Ok(())
    }

    /// Opens files from outside as a work that is not edited yet.
    ///
    /// # Errors
    /// If they are too long or too large, or the open work cannot be written; then it stays open.
    pub fn open_files(&mut self, files: project_file::Project) -> Result<(), String> {
        let project = Project { files: files.texts };
        check_size(&project)
            .and_then(|()| check_assets(&files.assets))
            .map_err(|refused| refused.to_string())?;
        self.leave()?;
        let name = if files.name.is_empty() {
            title(&project)
        } else {
            files.name
        };
        let kept = Kept {
            project,
            assets: files.assets,
            ..Kept::default()
        };
        self.begin(name, Origin::Fresh, kept);
        // The session checks that its numbers are finite.
        self.session.set_camera(files.camera);
        self.note();
        Ok(())
    }

    /// Returns the id of the user's own work to go back to, if a link has replaced it.
    #[must_use]
    pub fn before(&self) -> Option<&str> {
        self.before.as_deref()
    }

    /// Returns a number that rises when another work is opened.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Writes changes [`DELAY`] seconds after the first. Returns a message if they cannot be
    /// written.
    pub fn tick(&mut self, now: f64) -> Option<String> {
        if self.changed.is_some_and(|changed| now - changed >= DELAY)
            && let Err(trouble) = self.flush()
        {
            return Some(trouble);
        }
        let mut shelf = self.shelf.borrow_mut();
        if let Some(name) = shelf.take_copy() {
            self.name = name;
            return Some(format!(
                "Another tab writes this work, so what you change here is a copy: {}.",
                self.name
            ));
        }
        shelf.take_warning()
    }

    /// Makes the open work a copy of its own, which another tab does not write.
    ///
    /// # Errors
    /// If the browser refuses.
    pub fn copy(&mut self, now: f64) -> Result<(), String> {
        self.shelf.borrow_mut().set_theirs(true);
        self.keep(now);
        self.flush()?;
        if let Some(name) = self.shelf.borrow_mut().take_copy() {
            self.name = name;
        }
        Ok(())
    }

    /// Returns the id of the open work if it is the user's own and has been written.
    #[must_use]
    pub fn own_id(&self) -> Option<String> {
        let own = self.origin == Origin::Own;
        let shelf = self.shelf.borrow();
        shelf.open_id().filter(|_| own).map(str::to_owned)
    }

    /// Puts a changed work on the shelf, from where it is written even if the program stops, and
    /// then compiles it. Returns whether it was changed, so that a link to it is not true any more.
    pub fn settle(&mut self, now: f64) -> bool {
        let state = (self.session.revision(), self.session.user_camera());
        let has_changed = state != self.noted;
        if has_changed {
            let edited = state.0 != self.noted.0;
            self.noted = state;
            // Looking around in an example does not make it a work.
            if edited || self.origin == Origin::Own {
                self.keep(now);
            }
        }
        self.session.compile();
        has_changed
    }

    /// Returns the seconds until [`Work::tick`] writes; `None` if there is no change.
    #[must_use]
    pub fn wait(&self, now: f64) -> Option<f64> {
        self.changed.map(|changed| (changed + DELAY - now).max(0.0))
    }

    /// Gives the work another name.
    pub fn rename(&mut self, name: String, now: f64) {
        if self.name != name {
            self.name = name;
            self.keep(now);
        }
    }

    /// Writes changes at once.
    ///
    /// # Errors
    /// If the browser refuses.
    pub fn flush(&mut self) -> Result<(), String> {
        let result = self.shelf.borrow_mut().flush((self.clock)());
        // A refused write is tried again with the next edit.
        self.changed = None;
        result
    }

    /// Returns the shelf.
    #[must_use]
    pub fn shelf(&self) -> &Rc<RefCell<Shelf>> {
        &self.shelf
    }

    /// Puts the work on the shelf as the user's own.
    fn keep(&mut self, now: f64) {
        /// Most bytes of undo steps.
        const HISTORY: usize = 1 << 20;
        self.origin = Origin::Own;
        self.shelf
            .borrow_mut()
            .put(&self.name, self.session.keep(HISTORY));
        self.changed.get_or_insert(now);
    }

    /// Writes the open work before another one is opened. Returns its id if it is the user's own.
    fn leave(&mut self) -> Result<Option<String>, String> {
        self.flush()?;
        Ok(self.own_id())
    }

    fn begin_example(&mut self, index: usize, text: &str, assets: Vec<Asset>) {
        if let Some(example) = examples::ALL.get(index) {
            let kept = Kept {
                project: example.project(text),
                assets,
                ..Kept::default()
            };
            self.begin(example.title.to_owned(), Origin::Example, kept);
        }
    }

    fn begin_project(&mut self, name: String, project: Project, origin: Origin) {
        let kept = Kept {
            project,
            ..Kept::default()
        };
        self.begin(name, origin, kept);
    }

    fn begin(&mut self, name: String, origin: Origin, kept: Kept) {
        self.shelf.borrow_mut().begin_from(kept.project.clone());
        self.name = name;
        self.origin = origin;
        self.before = None;
        self.number += 1;
        self.changed = None;
        self.session.open(kept);
        self.note();
    }

    fn note(&mut self) {
        self.noted = (self.session.revision(), self.session.user_camera());
    }
}

/// Returns a file name for a work, without extension.
#[must_use]
pub fn file_stem(name: &str) -> String {
    let stem: String = name
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { '-' })
        .collect();
    if stem.is_empty() {
        String::from("sinew")
    } else {
        stem
    }
}

/// Returns a name for a project: its first file's, without the extension.
fn title(project: &Project) -> String {
    let name = project.files.first().map_or("", |file| file.name.as_str());
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let stem = stem.rsplit('/').next().unwrap_or(stem);
    if stem.is_empty() {
        return String::from("Untitled");
    }
    let mut chars = stem.chars().take(60);
    chars
        .next()
        .map(|first| first.to_uppercase().chain(chars).collect())
        .unwrap_or_default()
}
