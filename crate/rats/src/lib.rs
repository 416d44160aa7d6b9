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
pub mod suggest;
pub mod symbol;
pub mod syntax;
pub mod tool;
mod value;

pub use compile::{compile, compile_at, provenance};
pub use compiled::{Compiled, HotValue, HotVariable, Output, Placement};
pub use diagnostic::{Diagnostic, Related, Severity};
pub use project::{Asset, File, Project};
pub use reads::{ASSET_ENDINGS, asset_names, places, reads};
pub use tool::Tool;
