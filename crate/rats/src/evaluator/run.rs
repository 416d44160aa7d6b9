//! RUN: other files, messages and help.

use super::{Evaluator, Flow};
use crate::commands::{self, CommandSpec};
use crate::limits::{MAX_NESTED_FILES, STEPS_PER_LOOKUP};
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use crate::{Severity, colours, library, manual, places, suggest};

/// `read fn1 [fn2 …]`
pub fn read<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    for name in run.given(command)?.names("fn") {
        let file = find_file(run, &name)?;
        if run.reading.contains(&file) {
            return Err(Problem::new(
                name.span,
                format!(
                    "`{}` is being read already: this would never end",
                    name.text
                ),
            ));
        }
        if run.reading.len() >= MAX_NESTED_FILES {
            return Err(Problem::new(
                name.span,
                format!("files can read each other {MAX_NESTED_FILES} deep at most"),
            ));
        }
        if run_inner(run, command, file)? == Flow::Quit {
            return Ok(Flow::Quit);
        }
    }
    Ok(Flow::Next)
}

/// Runs another text; what is said about one of the library or an example is said here.
fn run_inner<'a>(run: &mut Evaluator<'a>, command: &'a Command, file: usize) -> Outcome<Flow> {
    run.enter(&command.word_span)?;
    let leaves_own = run.is_own() && file >= run.sources.own;
    if leaves_own {
        run.uses.push((run.file, command.span.clone()));
    }
    let flow = run.run_file(file);
    if leaves_own {
        run.uses.pop();
    }
    run.depth -= 1;
    Ok(flow)
}

fn find_file(run: &Evaluator<'_>, name: &Name<'_>) -> Outcome<usize> {
    let places = places(&run.sources.all[run.file].name, name.text);
    let found = places.iter().find_map(|place| run.sources.find(place));
    found.ok_or_else(|| {
        let own = run.sources.all[..run.sources.own]
            .iter()
            .map(|source| source.name.as_str());
        let known: Vec<&str> = own
            .chain(library::FILES.iter().map(|file| file.0))
            .collect();
        let bare = name.text.strip_prefix("./").unwrap_or(name.text);
        let hint = suggest::hint(bare, known.iter().copied())
            .unwrap_or_else(|| format!("the files are {}", known.join(", ")));
        Problem::new(
            name.span.clone(),
            format!("there is no file `{}` in the project", name.text),
        )
        .hint(hint)
    })
}

/// `test command [print]`
pub fn test<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let spec = find_command(run, given.name("command"))?;
    // These would end or undo the run that they are shown in.
    let would_harm = matches!(spec.name, "quit" | "reset" | "shoot");
    if given.word("print").is_some() || would_harm {
        run.say(Severity::Note, command.span.clone(), || {
            let hint = would_harm.then(|| {
                String::from("it is only shown, as running it would end or undo what is here")
            });
            (spec.example.to_owned(), hint)
        });
        return Ok(Flow::Next);
    }
    let Some(file) = run.sources.find_built_in(&format!("test {}", spec.name)) else {
        return Err(Problem::new(
            given.name("command").span.clone(),
            format!("the example of `{}` cannot be run from here", spec.name),
        )
        .hint("write the name out after `test`"));
    };
    if run.reading.contains(&file) {
        return Ok(Flow::Next);
    }
    run_inner(run, command, file)
}

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

fn find_command(run: &mut Evaluator<'_>, name: &Name<'_>) -> Outcome<&'static CommandSpec> {
    run.scope.step(STEPS_PER_LOOKUP, &name.span)?;
    commands::find(name.text).ok_or_else(|| {
        Problem::new(
            name.span.clone(),
            format!("there is no command `{}`", name.text),
        )
        .maybe_hint(commands::suggestion(name.text, std::iter::empty()))
    })
}
