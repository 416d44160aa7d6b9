//! Commands from the widgets to the app. Widgets only read the state and list commands; the app
//! carries them out after the frame, in one place ([`crate::app`]).

use crate::asset::Asset;
use crate::film::Playback;
use crate::pencil::tool::Tool;
use crate::recording::Kind;
use crate::settings::Show;
use crate::{examples, size, theme};
use lab::Lesson;
use rats::TextEdit;
use scene::Camera;
use std::ops::Range;

/// A wish of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Change the texts. Edits of one file are in its order and do not overlap.
    Edit {
        /// The changes.
        edits: Vec<TextEdit>,
        /// Whether they are an undo step of their own.
        step: bool,
    },
    /// Say something about the text.
    Tell(String),
    /// Show a line at the caret that says how its command is written, or hide it.
    SetHints(bool),
    /// Add an empty file.
    AddFile,
    /// Give a file another name.
    RenameFile(usize, String),
    /// Remove a file.
    RemoveFile(usize),
    /// Choose files to take in.
    PickFiles,
    /// Put an image or a mesh beside the texts.
    PutAsset(Asset),
    /// Take an image or a mesh away.
    RemoveAsset(String),
    /// Begin a gesture that is one undo step.
    Hold,
    /// End the gesture.
    Release,
    /// Go one step back.
    Undo,
    /// Go one step forward.
    Redo,
    /// Put the cursor at a place of the text.
    Jump {
        /// Index of the file.
        file: usize,
        /// Byte range to select.
        range: Range<usize>,
    },
    /// Show a place of the text without taking the focus there.
    ShowPlace {
        /// Index of the file.
        file: usize,
        /// The byte.
        byte: usize,
    },
    /// Look at the scene with this camera, or with that of the text if it is `None`.
    SetCamera(Option<Camera>),
    /// Bring the whole model into view.
    ShowAll,
    /// Stop the picture.
    Cancel,
    /// Trace the picture again.
    Again,
    /// Show the panel that fits meshes, or hide it.
    ShowFit(bool),
    /// Begin to fit what is chosen there.
    StartFit,
    /// End the fit.
    StopFit,
    /// Take a tool for drawing in hand, or lay it down.
    SetTool(Option<Tool>),
    /// Begin an empty work to draw on.
    DrawNew,
    /// Show the draft, the picture, or both in turn.
    SetShow(Show),
    /// Choose a picture size.
    SetSize(size::Choice),
    /// Choose a palette.
    SetTheme(theme::Choice),
    /// Play the film, or pause it.
    Play,
    /// Show a frame of the film.
    SetFilmFrame(u32),
    /// Set the number of frames of the film.
    SetFilmLength(u32),
    /// Set the number of frames that are shown in a second.
    SetFilmRate(u16),
    /// Choose what follows the film's last frame.
    SetPlayback(Playback),
    /// Write all frames of the film to a file.
    SaveFilm(Kind),
    /// Stop writing the film.
    StopFilm,
    /// Show a result of the text's jobs on pictures large.
    ShowResult(usize),
    /// Write a result to a file.
    SaveResult(usize),
    /// Go to the command that made a result.
    FindResult(usize),
    /// Make a result an image of the work.
    KeepResult(usize),
    /// Show only the head of the tray, or all of it.
    FoldTray(bool),
    /// Write the picture to a file.
    SavePng,
    /// Show the model as a mesh, to be saved.
    ShowMesh,
    /// Write the mesh on show to files.
    SaveMesh,
    /// Write all texts, images and meshes to one file.
    SaveProject,
    /// Make a link, copy it, and put it into the address bar.
    Share,
    /// Open an example.
    OpenExample(usize),
    /// Open a saved work.
    OpenSaved(String),
    /// Open a text as an example is opened.
    OpenText {
        /// The name of the work.
        name: String,
        /// The dataset.
        text: String,
    },
    /// Go to a lesson of the lab.
    OpenLab(Lesson),
    /// Go to the lesson seen last.
    ShowLab,
    /// Leave the lab for the editor.
    CloseLab,
    /// Copy a link to the lesson.
    ShareLab,
    /// Go on with a sculpture of the work, or ask how to begin one.
    ShowSculpt,
    /// Mesh the model, and sculpt the mesh.
    SculptModel,
    /// Ask how to begin a sculpture.
    NewSculpture,
    /// Open a text of strokes in the place for sculpting.
    OpenSculpture(String),
    /// Begin a sculpture.
    BeginSculpture {
        /// The line of its text that says what it starts from.
        start: String,
        /// Whether it is a work of its own.
        is_new: bool,
    },
    /// Replace a text of strokes.
    SetStrokes {
        /// The file's name.
        name: String,
        /// The new text.
        text: String,
        /// The mesh that it makes, if it is known.
        mesh: Option<Box<mesh::TriangleMesh>>,
    },
    /// Show a sculpture as a hard mesh, as flesh or as metaballs.
    GrowFlesh {
        /// The name of its text.
        name: String,
        /// The kind of flesh.
        flesh: modeling::Flesh,
        /// The mean length of its edges.
        edge: f64,
    },
    /// Leave the place for sculpting, to fit the mesh of a sculpture to measured points.
    FitSculpture(String),
    /// Leave the place for sculpting.
    CloseSculpt,
    /// Delete a saved work.
    Delete(String),
    /// Begin an empty work.
    New,
    /// Give the work another name.
    Rename(String),
    /// Go back to the user's own work, which a link has replaced.
    GoBack,
    /// Compile and trace again after a failed start.
    Enable,
    /// Show the gallery.
    ShowGallery,
    /// Show the help.
    ShowHelp,
    /// Show a command in the reference; with an empty name all of them.
    ShowManual(String),
    /// Close the gallery, the help, or the notice.
    Close,
}

impl Command {
    /// Changes a text.
    #[must_use]
    pub fn edit(edit: TextEdit) -> Self {
        let edits = vec![edit];
        Self::Edit { edits, step: false }
    }

    /// Changes a text, as an undo step of its own.
    #[must_use]
    pub fn step(edit: TextEdit) -> Self {
        let edits = vec![edit];
        Self::Edit { edits, step: true }
    }

    /// Returns the command that carries out a wish of the lab; `None` if the example to open does
    /// not exist.
    #[must_use]
    pub fn of_lab(wish: lab::Command) -> Option<Self> {
        Some(match wish {
            lab::Command::Open(lesson) => Self::OpenLab(lesson),
            lab::Command::Close => Self::CloseLab,
            lab::Command::Share => Self::ShareLab,
            lab::Command::SetTheme(choice) => Self::SetTheme(choice),
            lab::Command::OpenText { name, text } => Self::OpenText { name, text },
            lab::Command::OpenExample { file } => {
                let mut all = examples::ALL.iter();
                Self::OpenExample(all.position(|example| example.name == file)?)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_that_the_lab_offers_is_there() {
        let wish = |file| Command::of_lab(lab::Command::OpenExample { file });
        assert!(matches!(wish("tshape.rat"), Some(Command::OpenExample(_))));
        assert_eq!(wish("nothing.rat"), None);
    }
}
