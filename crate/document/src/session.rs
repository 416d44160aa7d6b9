//! The user's work without any window: the project, its undo steps, the result of compiling it, the
//! last scene that could be drawn, and the camera chosen by the user.
//!
//! Three counters tell of changes: [`Session::revision`] rises with every change of the texts,
//! [`Session::generation`] with every change of the scene or the camera, [`Session::shape`] with
//! every change of the scene. Times are seconds on any clock that never goes back.

use crate::asset::{self, Asset, MAX_ALL, MAX_ASSETS};
use crate::history::{History, Snapshot};
use crate::typed;
use rats::{Compiled, Diagnostic, Project, Recipe, Severity, TextEdit, Unread};
use scene::{Camera, Scene};
use serde::{Deserialize, Serialize};
use std::cell::OnceCell;
use std::sync::Arc;
use tracer::Picker;

/// Longest project that the editor takes: sum of the bytes of all files. The editor lays the whole
/// text out at every key, so the limit is far below that of links.
pub const MAX_TEXT: usize = 256 * 1024;
/// Most files in a project.
pub const MAX_FILES: usize = rats::limits::MAX_FILES;

impl Snapshot for Project {
    fn bytes(&self) -> usize {
        self.files
            .iter()
            .map(|file| file.name.len() + file.text.len() + 64)
            .sum()
    }
}

/// The reason why a text or an asset was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// The texts are longer than [`MAX_TEXT`].
    TooLong {
        /// Length in bytes.
        bytes: usize,
    },
    /// The files are more than [`MAX_FILES`].
    TooManyFiles {
        /// Number of files.
        files: usize,
    },
    /// The images and meshes are more than [`MAX_ASSETS`], or larger than [`MAX_ALL`].
    TooManyAssets {
        /// Number of images and meshes.
        assets: usize,
        /// Sum of their bytes.
        bytes: usize,
    },
}

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TooLong { bytes } => write!(
                f,
                "This text is {} kB long and the editor takes {} kB. Nothing was changed; \
                    use loops to write less, or the command-line program for long files.",
                bytes.div_ceil(1024),
                MAX_TEXT / 1024
            ),
            Self::TooManyFiles { files } => write!(
                f,
                "This project has {files} files and the editor takes {MAX_FILES}. \
                    Nothing was changed; join some of them."
            ),
            Self::TooManyAssets { assets, bytes } => write!(
                f,
                "That would make {assets} images and meshes of {}; \
                    a work takes {MAX_ASSETS}, of {} together. None was added; remove some first.",
                asset::size(*bytes),
                asset::size(MAX_ALL)
            ),
        }
    }
}

/// Checks a project against the editor's limits.
///
/// # Errors
/// If it is too long or has too many files.
pub fn check_size(project: &Project) -> Result<(), Refused> {
    let bytes = project.files.iter().map(|file| file.text.len()).sum();
    if bytes > MAX_TEXT {
        return Err(Refused::TooLong { bytes });
    }
    let files = project.files.len();
    if files > MAX_FILES {
        return Err(Refused::TooManyFiles { files });
    }
    Ok(())
}

/// Checks the images and meshes of a work against the limits.
///
/// # Errors
/// If there are too many or they are too large.
pub fn check_assets(all: &[Asset]) -> Result<(), Refused> {
    let bytes = all.iter().map(|asset| asset.bytes.len()).sum();
    if all.len() > MAX_ASSETS || bytes > MAX_ALL {
        return Err(Refused::TooManyAssets {
            assets: all.len(),
            bytes,
        });
    }
    Ok(())
}

/// The part of a session that is kept when the page is closed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// The texts.
    pub project: Project,
    /// The camera chosen by the user.
    pub camera: Option<Camera>,
    /// Undo steps.
    #[serde(default)]
    pub history: History<Project>,
    /// Images and meshes; the storage keeps them apart from the texts.
    #[serde(skip)]
    pub assets: Vec<Asset>,
}

/// The user's work.
pub struct Session {
    project: Project,
    assets: Vec<Asset>,
    history: History<Project>,
    compiled: Compiled,
    /// The scene to draw.
    good: Option<Arc<Scene>>,
    /// Whether it is of a text before.
    is_old: bool,
    /// The picker of that scene.
    picker: OnceCell<Picker>,
    camera: Option<Camera>,
    revision: u64,
    generation: u64,
    shape: u64,
    enabled: bool,
    stale: bool,
    /// Skeletons that the present text waits for.
    unread: Vec<Unread>,
    compile_seconds: f64,
    /// The frame that was chosen, if one was.
    film_frame: Option<u32>,
    /// The file and byte at which a word is being typed.
    typing: Option<(usize, usize)>,
    /// The messages that are not about that word.
    shown: Vec<Diagnostic>,
    messages_number: u64,
}

impl Session {
    /// Starts with a work that was kept. The project gets at least one file. With `compile` false
    /// nothing is compiled before [`Session::enable`] is called.
    #[must_use]
    pub fn new(kept: Kept, compile: bool) -> Self {
        let mut session = Self {
            project: Project::default(),
            assets: Vec::new(),
            history: History::default(),
            compiled: Compiled::default(),
            good: None,
            is_old: false,
            picker: OnceCell::new(),
            camera: None,
            revision: 0,
            generation: 0,
            shape: 0,
            enabled: compile,
            stale: false,
            unread: Vec::new(),
            compile_seconds: 0.0,
            film_frame: None,
            typing: None,
            shown: Vec::new(),
            messages_number: 0,
        };
        session.open(kept);
        session
    }

    /// Makes a session of one text, and compiles it.
    #[must_use]
    pub fn of_text(text: &str) -> Self {
        let kept = Kept {
            project: Project::single(text),
            ..Kept::default()
        };
        let mut session = Self::new(kept, true);
        session.compile();
        session
    }

    /// Replaces everything by another work.
    pub fn open(&mut self, kept: Kept) {
        self.project = kept.project;
        if self.project.files.is_empty() {
            self.project.files.push(rats::File {
                name: String::from("main.rat"),
                text: String::new(),
            });
        }
        self.history = kept.history;
        self.assets = kept.assets;
        self.camera = kept.camera;
        self.film_frame = None;
        self.good = None;
        self.picker = OnceCell::new();
        self.note_change();
    }

    /// Returns the part to keep when the page is closed; undo steps take at most `history_bytes`.
    #[must_use]
    pub fn keep(&self, history_bytes: usize) -> Kept {
        Kept {
            project: self.project.clone(),
            camera: self.camera,
            history: self.history.within(history_bytes),
            assets: self.assets.clone(),
        }
    }

    /// Returns the texts.
    #[must_use]
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// Returns the text of a file; empty if there is no such file.
    #[must_use]
    pub fn text(&self, file: usize) -> &str {
        self.project
            .files
            .get(file)
            .map_or("", |file| file.text.as_str())
    }

    /// Changes the texts. An edit whose range does not begin and end between characters is ignored.
    ///
    /// # Errors
    /// If the project would become too long; then nothing changes.
    pub fn edit(&mut self, edits: &[TextEdit], now: f64) -> Result<(), Refused> {
        let project = self.project.apply(edits);
        if project == self.project {
            return Ok(());
        }
        check_size(&project)?;
        self.history.record(&self.project, now);
        self.project = project;
        self.note_change();
        Ok(())
    }

    /// Changes a text as a step of its own. An edit that leads to the state before or after the
    /// present one in the history undoes or redoes instead, so that the sculpting view, which has
    /// undo steps of its own, adds none.
    ///
    /// # Errors
    /// If the project would become too long; then nothing changes.
    pub fn step(&mut self, edit: TextEdit, now: f64) -> Result<(), Refused> {
        self.end_step();
        let edits = [edit];
        let wanted = self.project.apply(&edits);
        let [before, after] = self.history.next().map(|state| state == Some(&wanted));
        if before {
            self.undo();
        } else if after {
            self.redo();
        } else {
            self.edit(&edits, now)?;
            self.end_step();
        }
        Ok(())
    }

    /// Replaces all files. One undo step.
    ///
    /// # Errors
    /// If there would be too many, or too much text; then nothing changes.
    pub fn set_files(&mut self, files: Vec<rats::File>, now: f64) -> Result<(), Refused> {
        let project = Project { files };
        check_size(&project)?;
        self.whole_step(now);
        self.project = project;
        self.note_change();
        Ok(())
    }

    /// Adds an empty file. Returns its index.
    ///
    /// # Errors
    /// If there are [`MAX_FILES`] already.
    pub fn add_file(&mut self, now: f64) -> Result<usize, Refused> {
        let files = self.project.files.len() + 1;
        if files > MAX_FILES {
            return Err(Refused::TooManyFiles { files });
        }
        let name = (1..)
            .map(|number| format!("part{number}.rat"))
            .find(|name| self.is_free(name))
            .unwrap_or_default();
        self.whole_step(now);
        self.project.files.push(rats::File {
            name,
            text: String::new(),
        });
        self.note_change();
        Ok(self.project.files.len() - 1)
    }

    /// Gives a file another name, also where it is read. One undo step.
    ///
    /// # Errors
    /// If the name is taken or cannot be written in a text; then nothing changes.
    pub fn rename_file(&mut self, file: usize, name: &str, now: f64) -> Result<(), String> {
        let name = name.trim();
        let Some(present) = self.project.files.get(file) else {
            return Ok(());
        };
        if present.name == name {
            return Ok(());
        }
        if name.len() > rats::link::MAX_NAME {
            return Err(format!(
                "A file's name has at most {} letters.",
                rats::link::MAX_NAME
            ));
        }
        let edits = assist::rename_file(&self.project, file, name)?;
        let mut project = self.project.apply(&edits);
        name.clone_into(&mut project.files[file].name);
        check_size(&project).map_err(|refused| refused.to_string())?;
        self.whole_step(now);
        self.project = project;
        self.note_change();
        Ok(())
    }

    /// Removes a file. The first one, which is run, stays.
    pub fn remove_file(&mut self, file: usize, now: f64) {
        if file > 0 && file < self.project.files.len() {
            self.whole_step(now);
            self.project.files.remove(file);
            self.note_change();
        }
    }

    /// Adds files; one whose name is taken replaces the old file. One undo step.
    ///
    /// # Errors
    /// If there would be too many, or too much text; then nothing changes.
    pub fn put_files(&mut self, files: Vec<rats::File>, now: f64) -> Result<(), Refused> {
        let mut project = self.project.clone();
        for file in files {
            match project.files.iter_mut().find(|old| old.name == file.name) {
                Some(old) => *old = file,
                None => project.files.push(file),
            }
        }
        check_size(&project)?;
        if project != self.project {
            self.whole_step(now);
            self.project = project;
            self.note_change();
        }
        Ok(())
    }

    /// Returns the images and meshes beside the texts.
    #[must_use]
    pub fn assets(&self) -> &[Asset] {
        &self.assets
    }

    /// Returns a name that no image or mesh of the work has: this one, or one with a number before
    /// its extension.
    #[must_use]
    pub fn free_name(&self, name: &str) -> String {
        let (stem, ending) = darkroom::name::split(name);
        let mut free = name.to_owned();
        let mut number = 1;
        while self.assets.iter().any(|asset| asset.name == free) {
            number += 1;
            free = format!("{stem}-{number}{ending}");
        }
        free
    }

    /// Adds images and meshes; one whose name is taken replaces the old one. They are not part of
    /// undo steps.
    ///
    /// # Errors
    /// If there would be too many or they would be too large; then nothing changes.
    pub fn put_assets(&mut self, assets: Vec<Asset>) -> Result<(), Refused> {
        let mut all = self.assets.clone();
        for asset in assets {
            match all.iter_mut().find(|old| old.name == asset.name) {
                Some(old) => *old = asset,
                None => all.push(asset),
            }
        }
        check_assets(&all)?;
        // The same content in other memory counts as new: a file whose reading failed may be put
        // again.
        let is_same = all.len() == self.assets.len()
            && all
                .iter()
                .zip(&self.assets)
                .all(|(new, old)| new.name == old.name && Arc::ptr_eq(&new.bytes, &old.bytes));
        if !is_same {
            self.assets = all;
            self.note_change();
        }
        Ok(())
    }

    /// Removes an image or a mesh. Returns it.
    pub fn remove_asset(&mut self, name: &str) -> Option<Asset> {
        let index = self.assets.iter().position(|asset| asset.name == name)?;
        self.note_change();
        Some(self.assets.remove(index))
    }

    fn is_free(&self, name: &str) -> bool {
        self.project.files.iter().all(|file| file.name != name)
    }

    /// Records that the next edit is an undo step by itself.
    fn whole_step(&mut self, now: f64) {
        self.history.close();
        self.history.record(&self.project, now);
        self.history.close();
    }

    /// Ends the undo step, so that the next edit begins a new one, however soon it comes.
    pub fn end_step(&mut self) {
        self.history.close();
    }

    /// Begins a gesture, such as dragging a slider, that is one undo step.
    pub fn hold(&mut self) {
        self.history.hold();
    }

    /// Ends the gesture.
    pub fn release(&mut self) {
        self.history.release();
    }

    /// Undoes the last step. Returns the file and the byte at which the text changed.
    pub fn undo(&mut self) -> Option<(usize, usize)> {
        let project = self.history.undo(&self.project)?;
        Some(self.restore(project))
    }

    /// Redoes the step that was undone last. Returns the file and the byte at which the text
    /// changed.
    pub fn redo(&mut self) -> Option<(usize, usize)> {
        let project = self.history.redo(&self.project)?;
        Some(self.restore(project))
    }

    /// Whether there is something to undo.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.history.can_undo()
    }

    /// Whether there is something to redo.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.history.can_redo()
    }

    /// Returns the result of the last [`Session::compile`].
    #[must_use]
    pub fn compilation(&self) -> &Compiled {
        &self.compiled
    }

    /// Returns the messages of the last [`Session::compile`].
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.compiled.diagnostics
    }

    /// Returns the number of errors at the last [`Session::compile`].
    #[must_use]
    pub fn errors(&self) -> usize {
        self.diagnostics()
            .iter()
            .filter(|diagnostic| diagnostic.severity == Severity::Error)
            .count()
    }

    /// Returns the messages of the last [`Session::compile`] but those about the word that is being
    /// typed.
    #[must_use]
    pub fn messages(&self) -> &[Diagnostic] {
        &self.shown
    }

    /// Whether there is an error among [`Session::messages`].
    #[must_use]
    pub fn shows_errors(&self) -> bool {
        let shown = self.shown.iter();
        shown.map(|shown| shown.severity).max() == Some(Severity::Error)
    }

    /// Returns a number that rises when other messages are shown.
    #[must_use]
    pub fn messages_number(&self) -> u64 {
        self.messages_number
    }

    /// Sets the file and byte at which a word is being typed, which is no mistake yet.
    pub fn set_typing(&mut self, typing: Option<(usize, usize)>) {
        if self.typing != typing {
            self.typing = typing;
            self.choose_shown();
        }
    }

    /// Chooses the messages that are shown.
    fn choose_shown(&mut self) {
        let file = self.typing.and_then(|(file, byte)| {
            let file = self.project.files.get(file)?;
            Some((file.name.as_str(), typed::Word::at(&file.text, byte)))
        });
        let shown: Vec<Diagnostic> = self
            .compiled
            .diagnostics
            .iter()
            .filter(|message| {
                !file
                    .as_ref()
                    .is_some_and(|(name, word)| message.file == *name && word.is_meant(message))
            })
            .cloned()
            .collect();
        if shown != self.shown {
            self.shown = shown;
            self.messages_number += 1;
        }
    }

    /// Returns the scene to draw, seen by [`Session::camera`]: that of the last text without
    /// errors, or while there was none that of the first text, as far as it was understood. `None`
    /// before a text was compiled.
    #[must_use]
    pub fn scene(&self) -> Option<&Arc<Scene>> {
        self.good.as_ref()
    }

    /// Whether the scene to draw is of a text before the present one, which has errors.
    #[must_use]
    pub fn has_old_scene(&self) -> bool {
        self.is_old
    }

    /// Returns the picker of the scene to draw.
    #[must_use]
    pub fn picker(&self) -> Option<&Picker> {
        let scene = self.good.as_ref()?;
        Some(self.picker.get_or_init(|| Picker::new(scene)))
    }

    /// Returns the frame of the scene to draw, pixels.
    #[must_use]
    pub fn frame(&self) -> [u32; 2] {
        self.good
            .as_ref()
            .map_or([4, 3], |scene| scene.settings.frame.map(|side| side.max(1)))
    }

    /// Returns the background of the scene to draw.
    #[must_use]
    pub fn background(&self) -> scene::Rgb {
        self.good
            .as_ref()
            .map_or(scene::DEFAULT_BACKGROUND, |scene| scene.background.mean())
    }

    /// Returns the camera in use.
    #[must_use]
    pub fn camera(&self) -> Camera {
        self.camera
            .or_else(|| self.good.as_ref().map(|scene| scene.camera))
            .unwrap_or_default()
    }

    /// Returns the camera chosen by the user, if any.
    #[must_use]
    pub fn user_camera(&self) -> Option<Camera> {
        self.camera
    }

    /// Sets a camera chosen by the user, or with `None` goes back to the text's. Editing the text
    /// never changes a chosen camera. A camera with a number that is not finite is ignored.
    pub fn set_camera(&mut self, camera: Option<Camera>) {
        let finite = camera.is_none_or(|camera| {
            camera.eye.is_finite()
                && camera.target.is_finite()
                && camera.up.is_finite()
                && camera.fov.is_finite()
                && camera.shift.iter().all(|shift| shift.is_finite())
                && camera.pixel.is_finite()
        });
        if finite && self.camera != camera {
            self.camera = camera;
            self.generation += 1;
        }
    }

    /// Returns the frames in a second, if the text gives them.
    #[must_use]
    pub fn film_rate(&self) -> Option<f64> {
        self.compiled.rate
    }

    /// Whether the text changes from frame to frame of a film.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.compiled.animated
    }

    /// Returns the number of pictures that a text takes, where they are the frames to choose from.
    #[must_use]
    pub fn pictures(&self) -> usize {
        match self.compiled.animated {
            true => 1,
            false => self.compiled.earlier.len() + 1,
        }
    }

    /// Whether there are frames to choose from: those of a film, or several pictures.
    #[must_use]
    pub fn has_frames(&self) -> bool {
        self.is_animated() || self.pictures() > 1
    }

    /// Returns the frame on show, from 0: at first a film's first one, and the last of several
    /// pictures.
    #[must_use]
    pub fn film_frame(&self) -> u32 {
        self.film_frame.unwrap_or(self.pictures() as u32 - 1)
    }

    /// Shows a frame of the film, from the next [`Session::compile`] on.
    pub fn set_film_frame(&mut self, frame: u32) {
        if self.film_frame() != frame {
            self.film_frame = Some(frame);
            self.stale = true;
        }
    }

    /// Returns the seconds that the last [`Session::compile`] took.
    #[must_use]
    pub fn compile_seconds(&self) -> f64 {
        self.compile_seconds
    }

    /// Returns a number that rises with every change of the texts, images and meshes.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Returns a number that rises with every change of [`Session::scene`] or [`Session::camera`].
    #[must_use]
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Returns a number that rises with every change of [`Session::scene`].
    #[must_use]
    pub fn shape(&self) -> u64 {
        self.shape
    }

    /// Whether texts are compiled. False after a start that failed, until the user asks.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Whether [`Session::compilation`] is of the present text.
    #[must_use]
    pub fn is_compiled(&self) -> bool {
        self.enabled && !self.stale
    }

    /// Compiles from now on.
    pub fn enable(&mut self) {
        self.enabled = true;
    }

    /// Returns meshes that the text names and that are not read yet. [`Session::compile`] waits
    /// until [`Asset::keep_mesh`] was called for each.
    pub fn unread_meshes(&self) -> impl Iterator<Item = &Asset> {
        self.assets.iter().filter(|asset| {
            // A text in the same folder may leave the folder out.
            let name = asset.name.rsplit('/').next().unwrap_or_default();
            asset.is_unread() && self.project.files.iter().any(|f| f.text.contains(name))
        })
    }

    /// Returns the files whose skeletons the text asks for, and how they are made, which are not
    /// read yet. [`Session::compile`] waits until [`Asset::keep_skeleton`] was called for each.
    pub fn unread_skeletons(&self) -> impl Iterator<Item = (&Asset, &Recipe)> {
        self.unread.iter().filter_map(|wanted| {
            let asset = self.assets.iter().find(|asset| asset.name == wanted.name)?;
            let is_read = asset.skeleton(&wanted.recipe).is_some();
            (!is_read).then_some((asset, &wanted.recipe))
        })
    }

    /// Compiles the present text if it changed since the last call and all meshes and skeletons
    /// that it names are read. Call it after the text was stored, so that no text is lost if the
    /// compiler stops the program.
    pub fn compile(&mut self) {
        let is_waiting =
            self.unread_meshes().next().is_some() || self.unread_skeletons().next().is_some();
        if !self.enabled || !self.stale || is_waiting {
            return;
        }
        let start = pool::clock::stopwatch();
        let frame = self.film_frame.unwrap_or_default();
        let mut compiled = rats::compile_at(&self.project, &self.assets, f64::from(frame));
        self.unread = std::mem::take(&mut compiled.unread);
        if !self.unread.is_empty() {
            return;
        }
        self.stale = false;
        if let Some(frame) = self.film_frame.filter(|_| !compiled.animated) {
            compiled.choose(frame as usize);
        }
        self.compiled = compiled;
        self.choose_shown();
        self.compile_seconds = pool::clock::stopwatch() - start;
        self.is_old = self.errors() > 0 && self.good.is_some();
        if !self.is_old {
            let scene = &self.compiled.scene;
            let good = self.good.replace(scene.clone());
            if !good.is_some_and(|good| good.is_same_but_written(scene)) {
                self.generation += 1;
                self.shape += 1;
                self.picker = OnceCell::new();
            }
        }
    }

    /// Puts a state of the history in place. Returns the file and the byte at which it differs.
    fn restore(&mut self, project: Project) -> (usize, usize) {
        let place = first_difference(&self.project, &project);
        self.project = project;
        self.note_change();
        place
    }

    /// Notes that texts, images or meshes have changed.
    fn note_change(&mut self) {
        self.revision += 1;
        self.stale = true;
        self.unread.clear();
    }
}

/// Returns the file and the byte in the new text at which it begins to differ from the old one.
fn first_difference(old: &Project, new: &Project) -> (usize, usize) {
    for (index, file) in new.files.iter().enumerate() {
        let before = old.files.get(index).map_or("", |file| file.text.as_str());
        if before != file.text {
            let same: usize = before
                .chars()
                .zip(file.text.chars())
                .take_while(|(a, b)| a == b)
                .map(|(a, _)| a.len_utf8())
                .sum();
            return (index, same);
        }
    }
    (0, 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rats::File;

    const TEXT: &str =
        "surface a, diffuse Red, blobbiness -1\nvar r = 0.5 hot\nsphere a r, 0 0 0\n";

    fn edit(session: &mut Session, text: &str, now: f64) {
        session.edit(&[TextEdit::whole(0, text)], now).unwrap();
        session.compile();
    }

    /// Several pictures are frames to choose from, whose shapes can be taken hold of.
    #[test]
    fn pictures_of_a_text_are_frames() {
        let mut session = Session::of_text("");
        let text = "surface a, diffuse Red\nsphere a 1, 0 0 0\nshoot\nsphere a 1, 3 0 0\n\
            filename second\nshoot\nsphere a 1, 6 0 0\nfilename third\nshoot\n";
        edit(&mut session, text, 0.0);
        assert!(session.has_frames() && !session.is_animated());
        // At first the last one, which a shape that is added behind it is in.
        assert_eq!(session.film_frame(), 2);
        assert_eq!(session.scene().unwrap().elements.len(), 3);
        for (frame, count, name) in [(0, 1, "scene"), (1, 2, "second"), (2, 3, "third")] {
            session.set_film_frame(frame);
            session.compile();
            assert_eq!(session.pictures(), 3);
            assert_eq!(session.scene().unwrap().elements.len(), count);
            assert_eq!(session.compilation().placements.len(), count);
            assert_eq!(session.compilation().output.name, name);
        }
        session.set_film_frame(9);
        session.compile();
        assert_eq!(
            session.scene().unwrap().elements.len(),
            3,
            "the last one stays"
        );
        edit(
            &mut session,
            "surface a, diffuse Red\nsphere a 1, 0 0 0\nshoot\n",
            1.0,
        );
        assert!(!session.has_frames());
    }

    #[test]
    fn an_error_keeps_the_last_good_scene() {
        let mut session = Session::of_text(TEXT);
        assert_eq!(session.errors(), 0, "{:?}", session.diagnostics());
        let (scene, generation) = (session.scene().cloned(), session.generation());
        edit(&mut session, &format!("{TEXT}sphree a 1, 2 0 0\n"), 1.0);
        assert_eq!(session.errors(), 1);
        let now = (session.scene().cloned(), session.generation());
        assert_eq!(now, (scene, generation));
        edit(&mut session, &format!("{TEXT}sphere a 1, 2 0 0\n"), 2.0);
        assert_eq!(session.scene().unwrap().elements.len(), 2);
        assert_eq!(session.generation(), generation + 1);
    }

    #[test]
    fn a_word_that_is_typed_is_no_mistake_before_the_caret_leaves_it() {
        let mut session = Session::of_text(TEXT);
        let end = TEXT.len();
        for (typed, caret, shown) in [
            ("sph", 3, 0),
            ("sphree", 6, 0),
            ("sphree", 2, 0),
            ("sphree ", 7, 1),
            // Operands are missing, but may follow.
            ("sphere a", 8, 0),
            ("sphere a 1, 2 0", 15, 0),
            ("sphere a 1, 2 0\n", 16, 1),
            ("sphere ä", 9, 0),
            ("sphere ä\n", 10, 1),
        ] {
            session.set_typing(Some((0, end + caret)));
            edit(&mut session, &format!("{TEXT}{typed}"), 1.0);
            assert!(session.errors() > 0, "{typed}");
            let messages = session.messages();
            assert_eq!(messages.len().min(1), shown, "{typed}: {messages:?}");
            assert_eq!(session.shows_errors(), shown > 0);
            let number = session.messages_number();
            session.set_typing(None);
            assert_eq!(session.messages(), session.diagnostics(), "{typed}");
            assert_eq!(session.messages_number() > number, shown == 0);
        }
    }

    #[test]
    fn a_first_text_with_errors_shows_what_it_can() {
        let session = Session::of_text(&format!("sphree\n{TEXT}"));
        assert!(session.errors() > 0);
        assert_eq!(session.scene().unwrap().elements.len(), 1);
    }

    #[test]
    fn a_contact_draws_a_new_picture() {
        let text = format!(
            "surface a, diffuse Red, blobbiness -1\n{}{}",
            body("L", -1),
            body("R", 1)
        );
        let mut session = Session::of_text(&text);
        let generation = session.generation();
        edit(&mut session, &format!("{text}contact L R\n"), 1.0);
        assert_eq!(session.errors(), 0, "{:?}", session.diagnostics());
        assert_eq!(session.generation(), generation + 1);
    }

    fn body(name: &str, at: i32) -> String {
        format!("body {name}\nsphere a 1, {at} 0 0\nclose\n")
    }

    #[test]
    fn scene_is_shared_and_ready_for_clicks_until_it_changes() {
        let mut session = Session::of_text(TEXT);
        assert!(Arc::ptr_eq(
            session.scene().unwrap(),
            &session.compilation().scene
        ));
        assert_eq!(pick(&session), Some(4.5));
        edit(&mut session, &TEXT.replace("0.5", "1.5"), 1.0);
        assert_eq!(pick(&session), Some(3.5));
    }

    fn pick(session: &Session) -> Option<f64> {
        let picker = session.picker().unwrap();
        let hit = picker.pick(glam::DVec3::new(0.0, 0.0, 5.0), glam::DVec3::NEG_Z);
        hit.map(|hit| (1e3 * hit.t).round() / 1e3)
    }

    #[test]
    fn a_comment_draws_no_new_picture() {
        let mut session = Session::of_text(TEXT);
        let generation = session.generation();
        edit(&mut session, &format!("# words\n{TEXT}"), 1.0);
        assert_eq!(session.generation(), generation);
        assert_eq!(session.scene().unwrap().elements[0].origin.start, 62);
    }

    #[test]
    fn editing_never_moves_the_users_camera() {
        let mut session = Session::of_text(TEXT);
        let own = Camera {
            eye: glam::DVec3::new(1.0, 2.0, 3.0),
            ..Camera::default()
        };
        session.set_camera(Some(own));
        edit(&mut session, &format!("{TEXT}eyep 9 9 9\n"), 1.0);
        assert_eq!(session.camera(), own);
        session.set_camera(None);
        assert_eq!(session.camera().eye, glam::DVec3::splat(9.0));
        let shape = session.shape();
        session.set_camera(Some(own));
        assert_eq!(session.shape(), shape);
        edit(&mut session, "surface a\nsphere a 1, 0 0 0\n", 2.0);
        assert_eq!(session.shape(), shape + 1);
        session.set_camera(None);
        let broken = Camera {
            fov: f64::NAN,
            ..own
        };
        session.set_camera(Some(broken));
        assert_eq!(session.user_camera(), None);
    }

    #[test]
    fn a_slider_drag_is_one_step() {
        let mut session = Session::of_text(TEXT);
        session.hold();
        for step in 1..20 {
            let literal = session.compilation().hot[0].literal.clone().unwrap();
            let value = format!("0.{step}");
            session
                .edit(&[TextEdit::new(0, literal, value)], f64::from(step))
                .unwrap();
            session.compile();
        }
        session.release();
        assert!(session.text(0).contains("var r = 0.19 hot"));
        let (file, byte) = session.undo().unwrap();
        assert_eq!((file, &session.text(0)[byte - 10..byte]), (0, "var r = 0."));
        assert_eq!(session.text(0), TEXT);
        assert!(!session.can_undo());
        session.redo();
        assert!(session.text(0).contains("0.19"));
    }

    #[test]
    fn files_come_and_go_and_can_be_undone() {
        let mut session = Session::of_text(TEXT);
        let added = session.add_file(1.0).unwrap();
        session.rename_file(added, "legs.rat", 1.1).unwrap();
        assert!(session.rename_file(added, "main.rat", 1.2).is_err());
        assert!(session.rename_file(added, "two words", 1.2).is_err());
        assert_eq!(session.project().files[added].name, "legs.rat");
        session
            .edit(&[TextEdit::whole(added, "sphere a 1, 3 0 0\n")], 1.3)
            .unwrap();
        edit(&mut session, &format!("{TEXT}read legs.rat\n"), 1.4);
        assert_eq!(session.errors(), 0, "{:?}", session.diagnostics());
        assert_eq!(session.scene().unwrap().elements.len(), 2);
        session.rename_file(added, "feet.rat", 1.45).unwrap();
        assert!(session.text(0).ends_with("read feet.rat\n"));
        session.compile();
        assert_eq!(session.errors(), 0, "{:?}", session.diagnostics());
        session.undo();
        assert_eq!(session.project().files[added].name, "legs.rat");
        session.remove_file(added, 1.5);
        session.compile();
        assert_eq!(session.errors(), 1);
        session.remove_file(0, 1.6);
        assert_eq!(session.project().files.len(), 1);
        session.undo();
        session.compile();
        assert_eq!(session.errors(), 0);
        session.undo();
        session.undo();
        session.undo();
        assert_eq!(session.project().files.len(), 1);
        while session.project().files.len() < MAX_FILES {
            session.add_file(9.0).unwrap();
        }
        assert!(session.add_file(9.0).is_err());
    }

    #[test]
    fn images_come_and_go_within_their_limits() {
        let mut session = Session::of_text(TEXT);
        let revision = session.revision();
        session.put_assets(vec![image("a.png", 3)]).unwrap();
        session.put_assets(vec![image("a.png", 4)]).unwrap();
        assert_eq!(session.assets(), [image("a.png", 4)]);
        assert_eq!(session.free_name("a.png"), "a-2.png");
        assert_eq!(session.free_name("b.png"), "b.png");
        assert_eq!(session.revision(), revision + 2);
        assert_eq!(session.keep(0).assets.len(), 1);
        let refused = session
            .put_assets(vec![image("b.png", MAX_ALL)])
            .unwrap_err();
        assert!(refused.to_string().contains("2 images"), "{refused}");
        let many = (0..MAX_ASSETS).map(|i| image(&format!("{i}.png"), 1));
        assert!(session.put_assets(many.collect()).is_err());
        assert_eq!(session.assets().len(), 1);
        assert_eq!(session.remove_asset("a.png"), Some(image("a.png", 4)));
        assert_eq!(session.remove_asset("a.png"), None);
    }

    fn image(name: &str, bytes: usize) -> Asset {
        Asset::await_mesh(name, vec![0; bytes])
    }

    #[test]
    fn files_from_outside_are_one_step() {
        let mut session = Session::of_text(TEXT);
        let files = vec![file("main.rat", "# new\n"), file("leg.rat", "# leg\n")];
        session.put_files(files, 1.0).unwrap();
        assert_eq!(session.text(0), "# new\n");
        assert_eq!(session.project().files.len(), 2);
        let long = "x".repeat(MAX_TEXT);
        assert!(session.put_files(vec![file("l.rat", &long)], 2.0).is_err());
        session.undo();
        assert_eq!(session.text(0), TEXT);
        assert_eq!(session.project().files.len(), 1);
    }

    fn file(name: &str, text: &str) -> File {
        File {
            name: name.to_owned(),
            text: text.to_owned(),
        }
    }

    #[test]
    fn steps_back_and_forth_are_one_history() {
        let mut session = Session::of_text(TEXT);
        let strokes = file("a.strokes", "strokes 1\n");
        let project = session.project().clone();
        let files = vec![file("main.rat", "# other\n"), strokes];
        session.set_files(files, 1.0).unwrap();
        for text in ["strokes 1\na\n", "strokes 1\na\nb\n"] {
            session.step(TextEdit::whole(1, text), 1.1).unwrap();
        }
        // Back to the first stroke, forth and back again: no steps of their own.
        for text in ["strokes 1\na\n", "strokes 1\na\nb\n", "strokes 1\na\n"] {
            session.step(TextEdit::whole(1, text), 1.2).unwrap();
            assert_eq!(session.text(1), text);
        }
        assert!(session.can_redo());
        session.undo();
        assert_eq!(session.text(1), "strokes 1\n");
        session.undo();
        assert_eq!(session.project(), &project);
        assert!(!session.can_undo());
        for _ in 0..3 {
            session.redo();
        }
        assert_eq!(session.text(1), "strokes 1\na\nb\n");
        // Another stroke than the one that was undone is a step.
        session.undo();
        session
            .step(TextEdit::whole(1, "strokes 1\na\nc\n"), 2.0)
            .unwrap();
        assert!(!session.can_redo());
        let long = "x".repeat(MAX_TEXT + 1);
        assert!(session.step(TextEdit::whole(1, long.clone()), 3.0).is_err());
        assert!(
            session
                .set_files(vec![file("main.rat", &long)], 3.0)
                .is_err()
        );
        assert_eq!(session.text(1), "strokes 1\na\nc\n");
    }

    #[test]
    fn too_much_text_is_refused_and_nothing_is_lost() {
        let mut session = Session::of_text(TEXT);
        let long = "x".repeat(MAX_TEXT + 1);
        let refused = session.edit(&[TextEdit::whole(0, long)], 1.0).unwrap_err();
        assert!(refused.to_string().contains("257 kB"), "{refused}");
        assert_eq!(session.text(0), TEXT);
        let bad = 3..9_999_999;
        session.edit(&[TextEdit::new(0, bad, "y")], 2.0).unwrap();
        assert_eq!(session.text(0), TEXT);
    }

    #[test]
    fn nothing_is_compiled_before_the_user_asks_after_a_failed_start() {
        let kept = Session::new(Kept::default(), true).keep(0);
        let mut session = Session::new(kept, false);
        edit(&mut session, TEXT, 1.0);
        assert!(session.scene().is_none());
        session.enable();
        session.compile();
        assert_eq!(session.scene().unwrap().elements.len(), 1);
    }
}
