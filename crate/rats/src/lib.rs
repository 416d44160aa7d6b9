//! The dataset language: text → scene, with diagnostics.
//!
//! A [`Project`] is a few named texts of which one is run. [`compile()`] never fails: it gives the
//! best [`scene::Scene`] it can make of the text and a list of [`Diagnostic`]s. [`link`] packs a
//! project and a camera into a short text that fits behind the `#` of an address.
//!
//! A text goes through these rooms: [`lexer`] cuts it into tokens, `parser` makes a tree of commands
//! (`syntax`), `evaluator` runs the tree. Each command's operands are read while it runs
//! (`given`, `reader`, `operands`, `expression`), because what a word means depends on the variables at that time. What
//! commands there are stands in one table ([`commands`]), which also serves [`highlight`] and help.
//! [`assist`] answers what an editor asks. All bounds are in [`limits`].

mod assets;
pub mod assist;
pub mod colours;
pub mod commands;
pub mod compile;
pub mod diagnostic;
mod evaluator;
mod expression;
mod functions;
mod geometry;
mod given;
pub mod handles;
pub mod highlight;
pub mod hot;
pub mod lexer;
pub mod library;
pub mod limits;
pub mod link;
pub mod manual;
mod operands;
mod parser;
mod problem;
pub mod project;
pub mod random;
mod reader;
pub mod reads;
mod report;
mod scope;
mod sources;
mod suggest;
mod symbol;
mod syntax;
pub mod tool;
mod value;

pub use assets::{is_mesh_read, keep_mesh};
pub use compile::{Compiled, HotValue, HotVariable, Output, Placement, compile, compile_at};
pub use diagnostic::{Diagnostic, Related, Severity};
pub use project::{Asset, File, Project};
pub use reads::{ASSET_ENDINGS, asset_names, places, reads};
pub use tool::Tool;
