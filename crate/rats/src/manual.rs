//! The manual: the texts of `help` and `man`, made from the table of commands.

use crate::commands::{CommandSpec, GROUPS, Parameter};
use crate::library;
use std::fmt::Write;

/// Lists all opcodes, group by group.
#[must_use]
pub fn list() -> String {
    let mut lines = Vec::new();
    for (group, list) in GROUPS {
        let names: Vec<_> = list.iter().map(|spec| spec.name).collect();
        lines.push(format!("{group:?}: {}", names.join(" ")));
    }
    lines.join("\n")
}

/// Describes a command in one line.
#[must_use]
pub fn summary(spec: &CommandSpec) -> String {
    let mut text = format!("{}: {}", spec.synopsis(), spec.meaning);
    add_default(&mut text, spec.default);
    if let Some(reason) = spec.idle() {
        let _ = write!(text, "; changes nothing here: {reason}");
    }
    text
}

/// Describes a command with all that the table has on it.
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
        add_default(&mut page, parameter.default);
    }
    for option in spec.options {
        let _ = write!(page, "\n  {}: {}", option.synopsis(), option.meaning);
        add_default(&mut page, option.default);
    }
    if !spec.example.is_empty() {
        let _ = write!(page, "\nexample:\n{}", spec.example);
    }
    page
}

/// Returns a parameter's meaning, unit, range and default in one line.
#[must_use]
pub fn parameter_line(parameter: &Parameter) -> String {
    let mut line = parameter.meaning.to_owned();
    for more in [parameter.unit.word(), &parameter.range()] {
        if !more.is_empty() {
            let _ = write!(line, ", {more}");
        }
    }
    add_default(&mut line, parameter.default);
    line
}

/// Adds a default, if there is one.
fn add_default(line: &mut String, default: &str) {
    if !default.is_empty() {
        let _ = write!(line, " (by default {default})");
    }
}
