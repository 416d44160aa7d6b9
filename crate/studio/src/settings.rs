//! The user's choices about the page, kept in the browser apart from the works.

use crate::theme;
use document::size;
use serde::{Deserialize, Serialize};

/// Content of the picture's place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Show {
    /// The draft while turning and editing, then the traced picture.
    #[default]
    Auto,
    /// The draft only.
    Draft,
    /// The traced picture only.
    Traced,
}

/// The user's choices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Palette.
    pub theme: theme::Choice,
    /// Draft, picture, or both in turn.
    pub show: Show,
    /// Size of the picture.
    pub size: size::Choice,
    /// Share of the width that the text has.
    pub split: f32,
    /// Whether there is a line at the caret that says how its command is written.
    pub hints: bool,
    /// Whether the user has turned a picture and needs no hint any more.
    pub turned: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            theme: theme::Choice::System,
            show: Show::Auto,
            size: size::Choice::Fit,
            split: 0.4,
            hints: true,
            turned: false,
        }
    }
}

/// A wish about the page itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// Choose a palette.
    Theme(theme::Choice),
    /// Show the draft, the picture, or both in turn.
    Show(Show),
    /// Choose a picture size.
    Size(size::Choice),
    /// Show a line at the caret that says how its command is written, or hide it.
    Hints(bool),
}
