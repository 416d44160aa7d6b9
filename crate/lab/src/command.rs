//! Commands of the lab's widgets to the page around it.

use crate::lesson::Lesson;
use widgets::theme;

/// A wish of the user that the page carries out after the frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Go to a lesson.
    Open(Lesson),
    /// Leave the lab for the editor.
    Close,
    /// Copy a link to the open lesson.
    Share,
    /// Choose a palette.
    SetTheme(theme::Choice),
    /// Open a text in the editor as an example is opened.
    OpenText {
        /// The name.
        name: String,
        /// The dataset.
        text: String,
    },
    /// Open an example of the gallery in the editor.
    OpenExample {
        /// The name of its file.
        file: &'static str,
    },
}

impl Command {
    /// Opens a text in the editor under this name.
    pub(crate) fn open(name: &str, text: String) -> Self {
        let name = name.to_owned();
        Self::OpenText { name, text }
    }
}
