//! The command that the caret is in, with the parameter whose turn it is.

use crate::complete::describe;
use crate::grammar::Param;
use crate::mend::with_index;
use crate::place;
use rats::Project;

/// Form of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// The command; with an option of it, if the caret is among the option's operands:
    /// `surface … radius`.
    pub command: String,
    /// The parameters.
    pub parameters: Vec<Part>,
    /// The index of the parameter that the caret is at.
    pub active: Option<usize>,
}

/// A parameter of a signature.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The text in a synopsis.
    pub text: String,
    /// The meaning, with unit, range and default.
    pub meaning: String,
}

/// Finds the signature of the command that a byte is in; `None` outside of commands, and in those
/// that are not known.
///
/// ```
/// let text = "sphere Clay 2, ";
/// let signature = assist::signature(&rats::Project::single(text), 0, text.len()).unwrap();
/// let names: Vec<_> = signature.parameters.iter().map(|part| part.text.as_str()).collect();
/// assert_eq!(names, ["sn", "r", "POS", "[option …]"]);
/// // It is the turn of the position.
/// assert_eq!(signature.active, Some(2));
/// ```
#[must_use]
pub fn signature(project: &Project, file: usize, byte: usize) -> Option<Signature> {
    let text = project.files.get(file)?.text.as_str();
    if !place::is_in(text, byte) || place::in_comment(text, byte) {
        return None;
    }
    with_index(project, file, byte, |index| {
        let here = index.here.as_ref()?;
        if here.spec.is_none() && here.own.is_none() {
            return None;
        }
        let word = here.spec.map_or(here.word, |spec| spec.name);
        let active = (byte > here.word_span.end)
            .then(|| here.active(byte))
            .flatten();
        if let Some(active) = active
            && let Some(option) = active.option
        {
            return Some(Signature {
                command: format!("{word} … {}", option.name),
                parameters: option.parameters.iter().map(|p| part(&p.into())).collect(),
                active: Some(active.index),
            });
        }
        let mut parameters: Vec<Part> = here.grammar.parameters.iter().map(part).collect();
        if !here.grammar.options.is_empty() {
            let names: Vec<_> = here.grammar.options.iter().map(|o| o.name).collect();
            parameters.push(Part {
                text: String::from("[option …]"),
                meaning: names.join(", "),
            });
        }
        let at_options =
            byte > here.word_span.end && active.is_none() && !here.grammar.options.is_empty();
        Some(Signature {
            command: word.to_owned(),
            active: active
                .map(|active| active.index)
                .or(at_options.then(|| parameters.len() - 1)),
            parameters,
        })
    })
}

fn part(parameter: &Param<'_>) -> Part {
    Part {
        text: parameter.synopsis(),
        meaning: describe(parameter),
    }
}
