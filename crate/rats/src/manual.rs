//! The manual: what `help` and `man` say, made from the table of commands.

use crate::commands::{CommandSpec, GROUPS, Parameter};
use crate::library;
use std::fmt::Write;

/// All opcodes, group by group.
#[must_use]
pub fn list() -> String {
    let line = |(group, list): &(crate::commands::Group, &[&CommandSpec])| {
        let names: Vec<_> = list.iter().map(|spec| spec.name).collect();
        format!("{group:?}: {}", names.join(" "))
    };
    GROUPS.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// A command in one line.
#[must_use]
pub fn summary(spec: &CommandSpec) -> String {
    let mut text = format!("{}: {}", spec.synopsis(), spec.meaning);
    if !spec.default.is_empty() {
        let _ = write!(text, " (by default {})", spec.default);
    }
    if let Some(reason) = spec.idle() {
        let _ = write!(text, "; changes nothing here: {reason}");
    }
    text
}

/// All that the table says of a command.
#[must_use]
pub fn page(spec: &CommandSpec) -> String {
    let mut page = summary(spec);
    if !spec.details.is_empty() {
        let _ = write!(page, "\n{}", spec.details);
    }
    for parameter in spec.parameters {
        let _ = write!(
            page,
            "\n  {}: {}",
            parameter.synopsis(),
            parameter_line(parameter)
        );
    }
    for parameter in library::parameters(spec.name) {
        let _ = write!(page, "\n  {}: {}", parameter.name, parameter.meaning);
        if !parameter.default.is_empty() {
            let _ = write!(page, " (by default {})", parameter.default);
        }
    }
    for option in spec.options {
        let _ = write!(page, "\n  {}: {}", option.synopsis(), option.meaning);
        if !option.default.is_empty() {
            let _ = write!(page, " (by default {})", option.default);
        }
    }
    if !spec.example.is_empty() {
        let _ = write!(page, "\nexample:\n{}", spec.example);
    }
    page
}

/// A parameter's meaning, unit, range and default.
#[must_use]
pub fn parameter_line(parameter: &Parameter) -> String {
    let mut line = parameter.meaning.to_owned();
    for more in [parameter.unit.word(), &parameter.range()] {
        if !more.is_empty() {
            let _ = write!(line, ", {more}");
        }
    }
    if !parameter.default.is_empty() {
        let _ = write!(line, " (by default {})", parameter.default);
    }
    line
}
