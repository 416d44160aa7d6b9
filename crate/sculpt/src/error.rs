//! Errors as sentences.

use core::fmt;

/// Why a stroke cannot be carried out: a sentence for the person who made it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error(pub String);

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for Error {}

impl From<mesh::EditError> for Error {
    fn from(error: mesh::EditError) -> Self {
        Self(error.to_string())
    }
}

impl From<mesh::Error> for Error {
    fn from(error: mesh::Error) -> Self {
        Self(error.0)
    }
}

/// An error with a text.
pub(crate) fn fail<T>(text: impl Into<String>) -> Result<T, Error> {
    Err(Error(text.into()))
}
