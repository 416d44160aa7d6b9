//! The dataset language: text → scene, with diagnostics.
//!
//! A [`Project`] is a few named texts of which one is run. [`compile`] never fails: it gives the
//! best [`scene::Scene`] it can make of the text and a list of [`Diagnostic`]s. [`link`] packs a
//! project and a camera into a short text that fits behind the `#` of an address.

pub mod compile;
pub mod diagnostic;
pub mod highlight;
pub mod link;
pub mod project;

pub use compile::{Compiled, HotValue, HotVariable, compile};
pub use diagnostic::{Diagnostic, Severity};
pub use project::{File, Project};
