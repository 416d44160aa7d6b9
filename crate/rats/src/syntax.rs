//! The commands of one file as a tree, still without meaning.

use crate::commands::CommandSpec;
use crate::problem::Problem;
use crate::symbol::Symbol;
use std::ops::Range;

/// A file as a tree of commands.
#[derive(Debug)]
pub struct Syntax {
    /// The commands.
    pub block: Block,
    /// The operands of all commands, which these index by ranges.
    pub items: Vec<Item>,
    /// The mistakes of form, in the order in which they were found.
    pub(crate) problems: Vec<Problem>,
}

impl Syntax {
    /// Returns the byte range and message of the first mistake of form; `None` if there is none.
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
    /// The kind and value.
    pub datum: Datum,
    /// The first byte.
    pub start: u32,
    /// The end: one past the last byte.
    pub end: u32,
    /// Whether white space comes before it.
    pub spaced: bool,
}

impl Item {
    /// Returns the byte range.
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
    /// The place of the opcode.
    pub word_span: Range<usize>,
    /// The row in the table; `None` for commands that the text defines, and for mistakes.
    pub spec: Option<&'static CommandSpec>,
    /// The operands, a range of [`Syntax::items`].
    pub items: Range<usize>,
    /// The range from the opcode to the last operand.
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
    /// The commands that are run if the condition holds.
    pub then: Block,
    /// The commands that are run if not.
    pub otherwise: Block,
}

/// A command made of commands.
#[derive(Debug)]
pub struct Define {
    /// `define` and what stands before the brace.
    pub head: Command,
    /// The new command's name.
    pub name: Symbol,
    /// The parameters.
    pub parameters: Vec<Formal>,
    /// The commands that a call runs.
    pub body: Block,
}

/// A parameter of a command that the text defines.
#[derive(Clone, Debug)]
pub struct Formal {
    /// The name.
    pub name: Symbol,
    /// The words by which messages call it.
    pub shown: String,
    /// The kind of value it takes.
    pub takes: Takes,
    /// The operands that make its default, a range of [`Syntax::items`]; empty if it must be given.
    pub default: Range<usize>,
    /// The place of its name.
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
