//! RUN: messages and help.

use super::state::{Evaluator, Flow};
use crate::commands::{self, CommandSpec};
use crate::limits::STEPS_PER_LOOKUP;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use crate::{Severity, colours, manual};

/// `pause [message]`: a page cannot wait, so the message is shown.
pub fn pause<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let source = &run.sources.all[run.file];
    let message = source.text[command.word_span.end..command.span.end].trim();
    run.say(Severity::Note, command.span.clone(), || {
        let message = if message.is_empty() { "pause" } else { message };
        (message.to_owned(), None)
    });
    Ok(Flow::Next)
}

/// `return`
pub fn return_<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.reader(command).end()?;
    Ok(Flow::Return)
}

/// `quit`
pub fn quit<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.reader(command).end()?;
    Ok(Flow::Quit)
}

/// `info`
pub fn info<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.given(command)?;
    run.say(Severity::Note, command.word_span.clone(), || {
        let version = env!("CARGO_PKG_VERSION");
        (format!("Sinew {version}, the language of RATS 7.31"), None)
    });
    Ok(Flow::Next)
}

/// `rats`
pub fn rats<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.given(command)?;
    run.say(Severity::Note, command.word_span.clone(), || {
        (String::from("squeak"), None)
    });
    Ok(Flow::Next)
}

/// `colors`
pub fn colors<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.given(command)?;
    run.say(Severity::Note, command.word_span.clone(), || {
        let names: Vec<_> = colours::names().collect();
        (
            format!("the colours are {}, and Gray0 to Gray100", names.join(" ")),
            None,
        )
    });
    Ok(Flow::Next)
}

/// `help [command]`
pub fn help<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let spec = match given.maybe_name("command") {
        Some(name) => Some(find_command(run, name)?),
        None => None,
    };
    run.say(Severity::Note, command.span.clone(), || {
        (spec.map_or_else(manual::list, manual::summary), None)
    });
    Ok(Flow::Next)
}

/// `man command`
pub fn man<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let spec = find_command(run, given.name("command"))?;
    run.say(Severity::Note, command.span.clone(), || {
        (manual::page(spec), None)
    });
    Ok(Flow::Next)
}

/// The command of the language that a name stands for.
///
/// # Errors
/// If there is none.
pub fn find_command(run: &mut Evaluator<'_>, name: &Name<'_>) -> Outcome<&'static CommandSpec> {
    run.scope.step(STEPS_PER_LOOKUP, &name.span)?;
    commands::find(name.text).ok_or_else(|| {
        Problem::new(
            name.span.clone(),
            format!("there is no command `{}`", name.text),
        )
        .maybe_hint(commands::suggestion(name.text, std::iter::empty()))
    })
}
