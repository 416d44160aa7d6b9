//! Types that tell from where in the texts the numbers of a shape's command come.

use crate::commands::{CommandSpec, Parameter};
use std::ops::Range;

/// From where a number comes.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// It is written out.
    Literal {
        /// The file, an index of the project's.
        file: usize,
        /// Its bytes, with the sign.
        span: Range<usize>,
        /// Whether a `-` stands before the variable, so that the number has the other sign.
        negated: bool,
        /// The variable that stands for it.
        variable: Option<String>,
    },
    /// It cannot be rewritten; the text goes on after "the number".
    Computed(String),
}

/// A number of the command.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// From where it comes.
    pub source: Source,
}

/// An operand: one number or three.
#[derive(Clone, Debug)]
pub struct Operand {
    /// The parameter of the table that it fills.
    pub parameter: &'static Parameter,
    /// Its numbers.
    pub numbers: Vec<Number>,
}

/// The command that was watched for.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// The command's row in the table.
    pub spec: &'static CommandSpec,
    /// Its operands that are numbers.
    pub operands: Vec<Operand>,
    /// The material's name.
    pub material: String,
    /// From where the material's radius comes.
    pub radius: Number,
}
