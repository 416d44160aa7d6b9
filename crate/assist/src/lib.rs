//! The services of an editor for the dataset language: completion, signatures, hover, definitions
//! and renaming, layout, folding, colours, the manual, and handles that move the numbers of a
//! shape.
//!
//! Every answer is a pure function of texts and a place in them. All but [`handles`] come from the
//! parsed text and the table of commands alone, without running the text, so they are there while
//! it is still wrong or unfinished. Places are byte offsets; any offset is allowed, one that is
//! outside of the text or inside a character finds nothing.
//!
//! ```
//! use rats::Project;
//!
//! let text = "surface Clay, diffuse SandyBrown\nsphere Clay 2, 0 0 0\n";
//! let project = Project::single(text);
//! // The material's name in the second line: the place where it is made, and how to rename it.
//! let used = text.rfind("Clay").unwrap();
//! let made = assist::definition(&project, 0, used).unwrap();
//! assert_eq!(&text[made.span], "Clay");
//! let edits = assist::rename(&project, 0, used, "Mud").unwrap();
//! let renamed = project.apply(&edits);
//! assert_eq!(renamed.files[0].text, text.replace("Clay", "Mud"));
//! ```

pub mod complete;
pub mod definition;
pub mod first;
pub mod fold;
pub mod format;
mod grammar;
pub mod handles;
pub mod highlight;
pub mod hover;
pub mod indent;
pub mod index;
pub mod manual;
mod mend;
mod place;
pub mod rename;
mod resolve;
pub mod signature;
mod slots;
pub mod swatches;
mod tint;
mod walk;

pub use complete::{Completion, CompletionKind, Completions, complete};
pub use definition::{definition, references};
pub use fold::folds;
pub use format::format;
pub use hover::{Card, hover};
pub use index::{Index, Place, Symbol, SymbolKind};
pub use rename::{rename, rename_file};
pub use signature::{Signature, signature};
pub use tint::{Tint, tints};
