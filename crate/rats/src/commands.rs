//! Table of commands: the name of each, its operands, its meaning and the function that runs it.
//!
//! The parser, the evaluator, the highlighter, suggestions and `help` all read this table, so a
//! command that is in it is known everywhere. Its rows stand beside the functions that run them, in
//! `evaluator/`; `evaluator/table.rs` lists them. To everybody else a row is plain data.

pub(crate) mod build;
pub mod parameter;
pub(crate) mod slot;
mod spec;

pub use crate::evaluator::table::GROUPS;
pub use parameter::{Arity, Kind, Names, OptionSpec, Parameter, Role, Unit};
pub(crate) use spec::{Action, Routine};
pub use spec::{Bracket, CommandSpec, Group};

use crate::suggest;

/// Lists of words that editors ask for by name.
pub mod options {
    pub use crate::evaluator::presets::PRESET_OPTIONS;
    pub use crate::evaluator::textures::{MAPPINGS, SOLIDS, TARGETS, TEXTURE_OPTIONS, WAVES};
    pub use crate::evaluator::variables::VAR_OPTIONS;
}

impl CommandSpec {
    /// Returns the group of the table that it is in.
    #[must_use]
    pub fn group(&self) -> Group {
        GROUPS
            .iter()
            .find(|(_, list)| list.iter().any(|spec| std::ptr::eq(*spec, self)))
            .map_or(Group::Extensions, |(group, _)| *group)
    }
}

/// Returns all commands, in the order of the table.
pub fn all() -> impl Iterator<Item = &'static CommandSpec> {
    GROUPS.iter().flat_map(|(_, list)| list.iter().copied())
}

/// Finds a command by its opcode, in any case.
#[must_use]
pub fn find(word: &str) -> Option<&'static CommandSpec> {
    all().find(|spec| spec.name.eq_ignore_ascii_case(word))
}

/// Returns a hint that names the command probably meant by a mistyped opcode; `own` are the
/// commands that the text defines.
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

    /// Every opcode of appendix C, group by group, and ours that published texts use.
    #[test]
    fn the_whole_language_is_known() {
        let names = "read pause return info help man test log var stopwatch quit \
            aperture focus shutter vrp vup cp vpn window eyep fov \
            surface texture \
            arc arch box brick cone cylinder pipe dot gauss line sphere triangle triad plane \
            polygon patch torus quadric terra \
            chain object close instance translate rotate scale explode transform \
            echo warning verbose bounds soft timer double dither compress stat map penumbra noview \
            nosave gamma framesize filename format epsilon vanish maxdepth maxmol digger contrast \
            pack indicator fragile sample mesh \
            light fog background cloud remove report reset preview shoot \
            animate play split collage fli convert resize diff and xor show kill refresh tile \
            colors rats table shell horn \
            material blobscale sky ground tone body curve deform seed preset for if else define \
            influence skeleton contact motion tree spikes sphereflake spiral";
        for name in names.split_whitespace() {
            assert!(find(name).is_some(), "{name}");
            assert!(find(&name.to_uppercase()).is_some(), "{name}");
        }
    }
}
