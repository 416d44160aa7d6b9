//! Errors and remarks as sentences.

use core::fmt;
use serde::{Deserialize, Serialize};

/// Why a file or an operation gives no graph: a sentence for the person who chose the file, with
/// the line where there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error(pub String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for Error {}

impl From<mesh::Error> for Error {
    fn from(mesh::Error(text): mesh::Error) -> Self {
        Self(text)
    }
}

/// Returns an error with a text.
pub(crate) fn fail<T>(text: impl Into<String>) -> Result<T, Error> {
    Err(Error(text.into()))
}

/// Returns an error with a line, counted from 1, and a text.
pub(crate) fn fail_at<T>(line: usize, text: impl fmt::Display) -> Result<T, Error> {
    Err(Error(format!("line {line}: {text}")))
}

/// Returns the beginning of a word that a file contains, short enough for a sentence.
pub(crate) fn shorten(word: &str) -> String {
    word.chars().take(30).collect()
}

/// Sentence about what was left out of a file, changed or guessed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Remark {
    /// Line of the file, from 1; `None` where the whole file is meant.
    pub line: Option<usize>,
    /// The sentence.
    pub text: String,
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        f.write_str(&self.text)
    }
}
