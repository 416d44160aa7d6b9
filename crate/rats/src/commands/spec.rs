//! The row of a command in the table: its name, its operands, its meaning, and the function that
//! runs it.

use super::parameter::{Kind, OptionSpec, Parameter, join};
use crate::evaluator::state::{Evaluator, Flow};
use crate::library;
use crate::problem::Outcome;
use crate::syntax::Command;

/// The groups of appendix C of the thesis, and ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// Running texts.
    Run,
    /// The camera.
    Camera,
    /// Materials and textures.
    Materials,
    /// Shapes.
    Primitives,
    /// Objects made of shapes.
    Objects,
    /// Settings.
    Options,
    /// Lights, background, the picture.
    Scene,
    /// Pictures and films.
    Tools,
    /// Commands that the original language did not have.
    Extensions,
}

/// Runs one command on the state of a running text.
pub(crate) type Routine = for<'a> fn(&mut Evaluator<'a>, &'a Command) -> Outcome<Flow>;

/// Way in which a command is carried out.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Action {
    /// A function runs it, fully or as far as the function itself says.
    Run(Routine),
    /// The parser makes it part of the tree.
    Structure,
    /// A file of the library defines it.
    Library,
    /// Nothing runs it, as it never changes the picture; the reason.
    NoEffect(&'static str),
}

/// The way a command begins or ends a group of shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bracket {
    /// Begins an object.
    Object,
    /// Begins shapes of one material.
    Chain,
    /// Ends the group that was begun last.
    Close,
}

/// A command.
pub struct CommandSpec {
    /// The opcode.
    pub name: &'static str,
    /// The operands, in order. Those of a command of the library stand in its file (see
    /// [`crate::library`]).
    pub parameters: &'static [Parameter],
    /// The option words, which follow the operands in any order.
    pub options: &'static [OptionSpec],
    /// The meaning, one line.
    pub meaning: &'static str,
    /// More about it; empty if there is no more.
    pub details: &'static str,
    /// The value without the command; empty if there is none.
    pub default: &'static str,
    /// A small text that uses it, complete and without mistakes.
    pub example: &'static str,
    /// The way it begins or ends a group of shapes, if it does.
    pub bracket: Option<Bracket>,
    /// Whether it runs the texts of the files that it names.
    pub includes: bool,
    /// Whether it is newer than the first published texts.
    pub(crate) is_newer: bool,
    /// Whether it ends or undoes the run of the text it stands in.
    pub(crate) interrupts: bool,
    /// Words, numbers and signs that may stand behind it at most.
    pub(crate) most_operands: usize,
    /// The way in which it is carried out.
    pub(crate) action: Action,
    /// Leaves a mark where the command fails, so that what builds on it is not reported, too.
    pub(crate) mark_failed: Option<for<'a> fn(&mut Evaluator<'a>, &'a Command)>,
}

impl std::fmt::Debug for CommandSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CommandSpec")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl CommandSpec {
    /// Returns a hint on how it is written.
    #[must_use]
    pub fn usage(&self) -> String {
        format!("it is written `{}`", self.synopsis())
    }

    /// Returns opcode and operands.
    #[must_use]
    pub fn synopsis(&self) -> String {
        if matches!(self.action, Action::Library) {
            return library::synopsis(self.name);
        }
        let mut synopsis = join(self.name, self.parameters);
        if self.options.len() <= 3 {
            for option in self.options {
                synopsis += &format!(" [{}]", option.synopsis());
            }
        } else {
            synopsis += " [option …]";
        }
        synopsis
    }

    /// Returns the reason why it changes nothing; `None` if it is carried out.
    #[must_use]
    pub fn idle(&self) -> Option<&'static str> {
        match self.action {
            Action::Run(_) | Action::Structure | Action::Library => None,
            Action::NoEffect(reason) => Some(reason),
        }
    }

    /// Returns whether a command of the same name that a text defines hides it, so that texts from
    /// before it still run: those of the library, and those that are newer than the first published
    /// texts.
    #[must_use]
    pub fn yields(&self) -> bool {
        self.is_newer || self.is_library()
    }

    /// Returns whether it makes a shape from a file.
    #[must_use]
    pub fn reads_shape(&self) -> bool {
        let mut kinds = self.parameters.iter().map(|parameter| parameter.kind);
        self.parameters.first().is_some_and(|first| first.in_chain)
            && kinds.any(|kind| matches!(kind, Kind::File))
    }

    /// Returns whether its name may be copied from an old one: `surface new = old`.
    #[must_use]
    pub fn copies(&self) -> bool {
        let mut kinds = self.parameters.iter().map(|parameter| parameter.kind);
        kinds.any(|kind| matches!(kind, Kind::Copy(_)))
    }

    /// Returns whether the parser makes it part of the tree: `for`, `if`, `else`, `define`.
    #[must_use]
    pub fn is_structure(&self) -> bool {
        matches!(self.action, Action::Structure)
    }

    /// Returns whether a file of the library defines it.
    #[must_use]
    pub fn is_library(&self) -> bool {
        matches!(self.action, Action::Library)
    }
}
