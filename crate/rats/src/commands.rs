//! The one table of commands: what each is called, what it takes, what it means and what runs it.
//!
//! The parser, the evaluator, the highlighter, suggestions and `help` all read this table, so a command
//! that is in it is known everywhere.

pub mod options;
pub mod parameter;
mod table;

pub use parameter::{Arity, Kind, Names, Parameter, Unit};
pub use table::GROUPS;

use crate::evaluator::{Evaluator, Flow};
use crate::problem::Outcome;
use crate::syntax::Command;
use crate::{library, suggest};

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
    /// What the original language did not have.
    Extensions,
}

/// An option word of a command.
#[derive(Debug)]
pub struct OptionSpec {
    /// The whole word.
    pub name: &'static str,
    /// What follows it.
    pub parameters: &'static [Parameter],
    /// What it means.
    pub meaning: &'static str,
    /// Its value if it is left out.
    pub default: &'static str,
}

impl OptionSpec {
    /// Whether its name begins with a word, in any case: options may be shortened.
    #[must_use]
    pub fn begins(&self, word: &str) -> bool {
        let start = self.name.get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    }

    /// The word and what follows it.
    #[must_use]
    pub fn synopsis(&self) -> String {
        join(self.name, self.parameters)
    }
}

/// What runs a command.
pub(crate) type Run = for<'a> fn(&mut Evaluator<'a>, &'a Command) -> Outcome<Flow>;

/// How far a command is carried out.
#[derive(Clone, Copy)]
pub(crate) enum Action {
    /// Fully, or as far as the function itself says.
    Run(Run),
    /// The parser makes it part of the tree.
    Structure,
    /// A file of the library defines it.
    Library,
    /// It never changes the picture, for the reason given.
    NoEffect(&'static str),
    /// Not in this version.
    Later,
}

/// A command.
pub struct CommandSpec {
    /// Its opcode.
    pub name: &'static str,
    /// Its operands, in order. Those of a command of the library stand in its file (see
    /// [`crate::library`]).
    pub parameters: &'static [Parameter],
    /// Its option words, which follow the operands in any order.
    pub options: &'static [OptionSpec],
    /// What it means, one line.
    pub meaning: &'static str,
    /// What else there is to know; empty if nothing.
    pub details: &'static str,
    /// The value without the command; empty if there is none.
    pub default: &'static str,
    /// A small text that uses it, complete and without mistakes.
    pub example: &'static str,
    /// What runs it.
    pub(crate) action: Action,
}

impl std::fmt::Debug for CommandSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CommandSpec")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl CommandSpec {
    /// How it is written, as a hint.
    #[must_use]
    pub fn usage(&self) -> String {
        format!("it is written `{}`", self.synopsis())
    }

    /// Its opcode and operands.
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

    /// Its group.
    #[must_use]
    pub fn group(&self) -> Group {
        let mine = |list: &[Self]| list.iter().any(|spec| std::ptr::eq(spec, self));
        GROUPS
            .iter()
            .find(|(_, list)| mine(list))
            .map_or(Group::Extensions, |(group, _)| *group)
    }

    /// Whether it is carried out: `None` if it is, else the reason why it changes nothing.
    #[must_use]
    pub fn idle(&self) -> Option<&'static str> {
        match self.action {
            Action::Run(_) | Action::Structure | Action::Library => None,
            Action::NoEffect(reason) => Some(reason),
            Action::Later => Some("it is not carried out in this version"),
        }
    }

    /// Whether a file of the library defines it.
    #[must_use]
    pub fn is_library(&self) -> bool {
        matches!(self.action, Action::Library)
    }
}

fn join(name: &str, parameters: &[Parameter]) -> String {
    let mut text = name.to_owned();
    for parameter in parameters {
        text += " ";
        text += &parameter.synopsis();
    }
    text
}

/// All commands, in the order of the table.
pub fn all() -> impl Iterator<Item = &'static CommandSpec> {
    GROUPS.iter().flat_map(|(_, list)| *list)
}

/// Finds a command by its opcode, in any case.
#[must_use]
pub fn find(word: &str) -> Option<&'static CommandSpec> {
    all().find(|spec| spec.name.eq_ignore_ascii_case(word))
}

/// The command that was probably meant by a mistyped opcode; `own` are those that the text defines.
#[must_use]
pub fn suggestion<'a>(word: &str, own: impl Iterator<Item = &'a str>) -> Option<String> {
    suggest::hint(word, all().map(|spec| spec.name).chain(own))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_are_unique_and_lower_case() {
        let mut names = HashSet::new();
        for spec in all() {
            assert!(names.insert(spec.name.to_lowercase()), "{}", spec.name);
            assert!(!spec.meaning.is_empty(), "{}", spec.name);
            let options: HashSet<_> = spec.options.iter().map(|o| o.name).collect();
            assert_eq!(options.len(), spec.options.len(), "{}", spec.name);
        }
    }

    /// Every opcode of appendix C, group by group.
    #[test]
    fn the_whole_language_is_known() {
        let names = "read pause return info help man test log var stopwatch quit \
            aperture focus shutter vrp vup cp vpn window eyep fov \
            surface texture \
            arc arch box brick cone cylinder pipe dot gauss line sphere triangle triad plane polygon \
            patch torus quadric terra \
            chain object close instance translate rotate scale explode transform \
            echo warning verbose bounds soft timer double dither compress stat map penumbra noview \
            nosave gamma framesize filename format epsilon vanish maxdepth maxmol digger contrast \
            pack indicator fragile sample mesh \
            light fog background cloud remove report reset preview shoot \
            animate play split collage fli convert resize diff and xor show kill refresh tile colors \
            rats table shell horn \
            material blobscale curve seed for if else define influence \
            tree spikes sphereflake spiral";
        for name in names.split_whitespace() {
            assert!(find(name).is_some(), "{name}");
            assert!(find(&name.to_uppercase()).is_some(), "{name}");
        }
        assert_eq!(names.split_whitespace().count(), all().count());
    }
}
