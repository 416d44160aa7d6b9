//! The one table of commands: what each is called, what it takes, what it means and what runs it.
//!
//! The parser, the evaluator, the highlighter, suggestions and `help` all read this table, so a command
//! that is in it is known everywhere.

pub mod options;
mod table;

pub use table::COMMANDS;

use crate::evaluator::{Evaluator, Flow};
use crate::problem::Outcome;
use crate::suggest;
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
    /// What the original language did not have.
    Extensions,
}

/// An option word of a command.
#[derive(Debug)]
pub struct OptionSpec {
    /// The whole word.
    pub name: &'static str,
    /// What follows it; UPPERCASE is a triple.
    pub arguments: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Its value if it is left out.
    pub default: &'static str,
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
    /// It never changes the picture, for the reason given.
    NoEffect(&'static str),
    /// Not in this version.
    Later,
}

/// A command.
pub struct CommandSpec {
    /// Its opcode.
    pub name: &'static str,
    /// Its group.
    pub group: Group,
    /// What it takes; UPPERCASE is a triple, `sn` a material's name.
    pub arguments: &'static str,
    /// What it means, one line.
    pub meaning: &'static str,
    /// The value without the command; empty if there is none.
    pub default: &'static str,
    /// Its option words.
    pub options: &'static [OptionSpec],
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

    /// Its opcode and arguments.
    #[must_use]
    pub fn synopsis(&self) -> String {
        format!("{} {}", self.name, self.arguments)
            .trim_end()
            .to_owned()
    }
}

/// Finds a command by its opcode, in any case.
#[must_use]
pub fn find(word: &str) -> Option<&'static CommandSpec> {
    COMMANDS
        .iter()
        .find(|spec| spec.name.eq_ignore_ascii_case(word))
}

/// The command that was probably meant by a mistyped opcode; `own` are those that the text defines.
#[must_use]
pub fn suggestion<'a>(word: &str, own: impl Iterator<Item = &'a str>) -> Option<String> {
    suggest::hint(word, COMMANDS.iter().map(|spec| spec.name).chain(own))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_are_unique_and_lower_case() {
        let mut names = HashSet::new();
        for spec in COMMANDS {
            assert!(names.insert(spec.name.to_lowercase()), "{}", spec.name);
            assert!(!spec.meaning.is_empty(), "{}", spec.name);
            let options: HashSet<_> = spec.options.iter().map(|o| o.name).collect();
            assert_eq!(options.len(), spec.options.len(), "{}", spec.name);
        }
    }

    /// Every opcode of appendix C, group by group.
    #[test]
    fn the_whole_language_is_known() {
        let all = "read pause return info help man test log var stopwatch quit \
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
            material blobscale curve seed for if else define influence";
        for name in all.split_whitespace() {
            assert!(find(name).is_some(), "{name}");
            assert!(find(&name.to_uppercase()).is_some(), "{name}");
        }
        assert_eq!(all.split_whitespace().count(), COMMANDS.len());
    }
}
