//! What an editor asks of the language.

mod fold;
mod format;
mod names;
mod texts;
