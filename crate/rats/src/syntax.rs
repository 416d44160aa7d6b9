//! The commands of one file as a tree, still without meaning.

use crate::commands::CommandSpec;
use crate::problem::Problem;
use crate::symbol::Symbol;
use std::ops::Range;

/// One file, parsed.
#[derive(Debug)]
pub struct Syntax {
    /// Its commands.
    pub block: Block,
    /// The operands of all its commands, which commands index by ranges.
    pub items: Vec<Item>,
    /// The mistakes of its form, in the order in which they were found.
    pub(crate) problems: Vec<Problem>,
}

impl Syntax {
    /// The first mistake of form: its byte range and message. `None` if the text is well-formed.
    #[must_use]
    pub fn mistake(&self) -> Option<(Range<usize>, &str)> {
        let problem = self.problems.first()?;
        Some((problem.span.clone(), &problem.message))
    }
}

/// Commands that are run one after the other.
pub type Block = Vec<Node>;

/// A word, number or sign of a command.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Its kind and value.
    pub datum: Datum,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// Whether white space comes before it.
    pub spaced: bool,
}

impl Item {
    /// Its byte range.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// A word, number or sign, with its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Datum {
    /// A number.
    Number(f64),
    /// A word.
    Word(Symbol),
    /// A sign; `−` has become `-`.
    Sign(u8),
    /// Characters without meaning.
    Unknown,
}

/// A command or a structure of commands.
#[derive(Debug)]
pub enum Node {
    /// A plain command.
    Command(Command),
    /// `for HEAD { … }`.
    For(Box<For>),
    /// `if HEAD { … } else { … }`.
    If(Box<If>),
    /// `define name(…) { … }`.
    Define(Box<Define>),
}

/// An opcode and its operands.
#[derive(Clone, Debug)]
pub struct Command {
    /// The opcode as written.
    pub word: Symbol,
    /// Where the opcode is.
    pub word_span: Range<usize>,
    /// Its row in the table; `None` for commands that the text defines, and for mistakes.
    pub spec: Option<&'static CommandSpec>,
    /// The operands, a range of [`Syntax::items`].
    pub items: Range<usize>,
    /// From the opcode to the last operand.
    pub span: Range<usize>,
}

/// A loop; `head.items` is `i = a to b [step c]`.
#[derive(Debug)]
pub struct For {
    /// `for` and what stands before the brace.
    pub head: Command,
    /// The commands that are repeated.
    pub body: Block,
}

/// A choice; `head.items` is the condition.
#[derive(Debug)]
pub struct If {
    /// `if` and what stands before the brace.
    pub head: Command,
    /// Run if the condition holds.
    pub then: Block,
    /// Run if not.
    pub otherwise: Block,
}

/// A command made of commands.
#[derive(Debug)]
pub struct Define {
    /// `define` and what stands before the brace.
    pub head: Command,
    /// The new command's name.
    pub name: Symbol,
    /// Its parameters.
    pub parameters: Vec<Formal>,
    /// The commands that a call runs.
    pub body: Block,
}

/// A parameter of a command that the text defines.
#[derive(Clone, Debug)]
pub struct Formal {
    /// Its name.
    pub name: Symbol,
    /// As messages call it.
    pub shown: String,
    /// The kind of value it takes.
    pub takes: Takes,
    /// The operands that make its default, a range of [`Syntax::items`]; empty if it must be given.
    pub default: Range<usize>,
    /// Where its name stands.
    pub span: Range<usize>,
}

/// The kind of value that a parameter of a defined command takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// A number.
    Number,
    /// A vector or colour: its name is written in capitals.
    Triple,
    /// A material's name: it is written `surface s`.
    Surface,
}
