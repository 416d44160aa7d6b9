//! The dataset language: text → scene, with diagnostics.
//!
//! A [`Project`] is a few named texts of which one is run. [`compile()`] never fails: it gives the
//! best [`scene::Scene`] it can make of the text and a list of [`Diagnostic`]s. [`link`] packs a
//! project and a camera into a short text that fits behind the `#` of an address.
//!
//! ```
//! let project = rats::Project::single(
//!     "surface Clay, diffuse SandyBrown, blobbiness -2\n\
//!      for i = 0 to 4 { sphere Clay 0.5, i 0 0 }\n\
//!      spere Clay 1, 0 0 0\n",
//! );
//! let compiled = rats::compile(&project);
//! assert_eq!(compiled.scene.elements.len(), 5);
//! let mistake = &compiled.diagnostics[0];
//! assert_eq!((mistake.line, mistake.message.as_str()), (3, "there is no command `spere`"));
//! assert_eq!(mistake.hint.as_deref(), Some("did you mean `sphere`?"));
//! ```
//!
//! A text goes through these stages: [`lexer`] cuts it into tokens, [`parser`] makes a tree of
//! commands ([`syntax`]), `evaluator` runs the tree. Each command's operands are read while it runs
//! (`reader`, `expression`, `operands`, `given`), because the meaning of a word depends on the
//! variables at that time. All commands stand in one table ([`commands`]), whose rows stand beside
//! the functions that run them; as plain data it also serves help and the editor (the crate
//! `assist`). All bounds are in [`limits`].

mod asset;
mod assets;
pub mod colours;
pub mod commands;
pub mod compile;
pub mod compiled;
pub mod diagnostic;
mod evaluator;
mod expression;
pub mod functions;
mod geometry;
mod given;
pub mod hot;
pub mod lexer;
pub mod library;
pub mod limits;
pub mod link;
pub mod manual;
mod operands;
pub mod operator;
pub mod parser;
mod problem;
pub mod project;
pub mod provenance;
pub mod random;
mod reader;
pub mod reads;
mod report;
mod scope;
mod sources;
mod strokes;
pub mod suggest;
pub mod symbol;
pub mod syntax;
mod text_edit;
pub mod tool;
mod value;

pub use asset::Asset;
pub use compile::{compile, compile_at, provenance};
pub use compiled::{
    Act, Compiled, Control, Deform, HotValue, HotVariable, Interlude, Output, Picture, Placement,
    Preset, Unread,
};
pub use diagnostic::{Diagnostic, Related, Severity};
pub use limbs::Recipe;
pub use project::{File, Project};
pub use reads::{asset_names, is_image, is_mesh, is_skeleton, places, reads};
pub use strokes::{is_strokes, keep_sculpted, start_file};
pub use text_edit::TextEdit;
pub use tool::Tool;
