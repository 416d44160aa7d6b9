//! Origins of the numbers of a shape's command in the texts.

use crate::commands::{CommandSpec, Parameter};
use std::ops::Range;

/// Origin of a number in the texts.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A number that is written out.
    Literal {
        /// The file, an index of the project's.
        file: usize,
        /// The number's bytes, with the sign.
        span: Range<usize>,
        /// Whether a `-` stands before the variable, so that the number has the other sign.
        negated: bool,
        /// The variable that stands for it.
        variable: Option<String>,
    },
    /// The reason why the number cannot be rewritten; it goes on after "the number".
    Computed(String),
}

/// A number of the command.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// The value.
    pub value: f64,
    /// The origin.
    pub source: Source,
}

/// An operand: one number or three.
#[derive(Clone, Debug)]
pub struct Operand {
    /// The parameter of the table that it fills.
    pub parameter: &'static Parameter,
    /// The numbers.
    pub numbers: Vec<Number>,
}

/// The command that was watched for.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// The command's row in the table.
    pub spec: &'static CommandSpec,
    /// The operands that are numbers.
    pub operands: Vec<Operand>,
    /// The material's name.
    pub material: String,
    /// The material's radius.
    pub radius: Number,
}
