//! The notes of a run that is watched for one command.

use crate::provenance::{Number, Provenance};
use crate::symbol::Symbol;
use scene::Origin;
use std::collections::HashMap;
use std::ops::Range;

/// Place where a variable was set: the file and its numbers' ranges, or the reason why they cannot
/// be rewritten.
pub type Setting = Result<(usize, Vec<Range<usize>>), String>;

/// The notes of a run for one command.
#[derive(Debug)]
pub struct Watch<'a> {
    pub target: Origin,
    /// The places where variables of the whole text were set last.
    pub variables: HashMap<Symbol, Setting>,
    pub radii: HashMap<&'a str, Number>,
    pub seen: Option<Provenance>,
}

impl Watch<'_> {
    /// Waits for the command with this origin.
    #[must_use]
    pub fn new(target: Origin) -> Self {
        Self {
            target,
            variables: HashMap::new(),
            radii: HashMap::new(),
            seen: None,
        }
    }

    /// Whether the command was met, so that the run may end.
    pub fn is_done(&self) -> bool {
        self.seen.is_some()
    }
}
