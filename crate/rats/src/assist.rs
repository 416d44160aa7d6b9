//! What an editor asks of the language: every answer is a pure function of texts and a place in them.
//!
//! Nothing here runs a text: the answers come from the parsed text and the table of commands alone, so
//! they are there while a text is still wrong or unfinished. Places are byte offsets; any offset is
//! allowed, one that is outside of the text or inside a character finds nothing.

pub mod complete;
pub mod definition;
pub mod fold;
pub mod format;
mod grammar;
pub mod hover;
pub mod manual;
mod mend;
mod place;
pub mod rename;
mod resolve;
pub mod signature;
mod slots;
pub mod symbols;
mod walk;

pub use complete::{Completion, CompletionKind, Completions, complete};
pub use definition::{definition, references};
pub use fold::folds;
pub use format::format;
pub use hover::{Card, hover};
pub use rename::{Edit, rename, rename_file};
pub use signature::{Signature, signature};
pub use symbols::{Index, Place, Symbol, SymbolKind};
