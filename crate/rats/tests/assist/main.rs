//! What an editor asks of the language.

mod fold;
mod format;
mod texts;
