//! Errors as sentences.

/// Why something cannot be deformed or fitted: a sentence for the person who asked for it.
pub use mesh::Error;

/// An error with a text.
pub(crate) fn fail<T>(text: impl Into<String>) -> Result<T, Error> {
    Err(Error(text.into()))
}
