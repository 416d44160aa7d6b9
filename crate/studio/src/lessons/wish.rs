//! Wishes about the lab.

use lab::Lesson;

/// Wishes about the lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabWish {
    /// Go to a lesson.
    Open(Lesson),
    /// Go to the lesson seen last.
    Show,
    /// Leave it for the editor.
    Close,
    /// Open the lesson to which the address has changed, or leave the lab if it is `None`.
    Follow(Option<Lesson>),
    /// Copy a link to the lesson.
    Share,
}
