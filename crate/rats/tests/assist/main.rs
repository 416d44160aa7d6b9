//! What an editor asks of the language.

mod complete;
mod fold;
mod format;
mod hover;
mod names;
mod signature;
mod speed;
mod texts;
