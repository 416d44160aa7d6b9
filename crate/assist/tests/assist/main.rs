//! Services of an editor for the language.

mod complete;
mod fold;
mod format;
mod highlight;
mod hover;
mod manual;
mod names;
mod signature;
mod speed;
mod texts;
