//! Wishes about the texts, images and meshes of the work.

use super::editor::find::Seek;
use document::asset::Asset;
use rats::TextEdit;
use std::ops::Range;

/// Wishes about the texts, images and meshes of the work.
#[derive(Clone, Debug, PartialEq)]
pub enum TextWish {
    /// Change the texts. Edits of one file are in its order and do not overlap.
    Edit {
        /// The changes.
        edits: Vec<TextEdit>,
        /// Whether they are an undo step of their own.
        step: bool,
    },
    /// Add an empty file.
    AddFile,
    /// Give a file another name.
    RenameFile(usize, String),
    /// Remove a file.
    RemoveFile(usize),
    /// Show a file.
    ShowFile(usize),
    /// Put an image or a mesh beside the texts.
    PutAsset(Asset),
    /// Take an image or a mesh away.
    RemoveAsset(String),
    /// Show an image or a mesh.
    ShowAsset(String),
    /// Begin a gesture that is one undo step.
    Hold,
    /// End the gesture.
    Release,
    /// Find and replace, or go to a line.
    Find(Seek),
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
}

impl TextWish {
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
}
