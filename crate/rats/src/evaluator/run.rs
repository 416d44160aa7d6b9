//! RUN: messages and help.

use super::state::{Evaluator, Flow};
use crate::commands::build::{by_itself, clay, plain, row, takes, word_of};
use crate::commands::slot::{existing, file, new_file, text, word};
use crate::commands::{self, CommandSpec, Names, OptionSpec};
use crate::compiled::{Act, Interlude};
use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use crate::{colours, manual};
use std::fmt::from_fn;

/// `stopwatch`.
pub static STOPWATCH_WORDS: &[OptionSpec] = &[
    word_of("start", "begin"),
    word_of("stop", "end and tell the time"),
];

/// `pause [message]`: a page cannot wait, so the message is shown.
pub static PAUSE: CommandSpec = row("pause", "show a message")
    .with(by_itself(
        pause,
        plain![text("message", "the message").optional("")],
        &[],
    ))
    .details(
        "The program waits for the Enter key, if somebody sits before it. A page cannot, so the \
         message is shown among the notes.",
    )
    .example("pause this stands among the notes");

fn pause<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let source = &run.sources.all[run.file];
    let message = source.text[command.word_span.end..command.span.end].trim();
    let message = if message.is_empty() { "pause" } else { message };
    run.note(&command.span, message, "");
    interlude(run, command, Act::Pause(message.to_owned()))
}

/// Lists something that the program does between pictures.
///
/// # Errors
/// If there are too many.
fn interlude<'a>(run: &mut Evaluator<'a>, command: &'a Command, act: Act) -> Outcome<Flow> {
    let most = limits::MAX_INTERLUDES;
    if run.interludes.len() >= most {
        let message = format!("there are more than {most} pauses, logs and times");
        return Err(Problem::new(&command.span, message));
    }
    let after = run.shots.taken.len();
    run.interludes.push(Interlude { after, act });
    Ok(Flow::Next)
}

pub static RETURN: CommandSpec = row("return", "return from a file, or from a defined command")
    .with(takes!(return_))
    .example(clay!("sphere Clay 2, 0 0 0\nreturn\nnothing here is run"));

fn return_<'a>(_: &mut Evaluator<'a>, _: &'a Command) -> Outcome<Flow> {
    Ok(Flow::Return)
}

pub static QUIT: CommandSpec = row("quit", "end the run")
    .with(takes!(quit))
    .interrupts()
    .example(clay!("sphere Clay 2, 0 0 0\nquit\nnothing here is run"));

fn quit<'a>(_: &mut Evaluator<'a>, _: &'a Command) -> Outcome<Flow> {
    Ok(Flow::Quit)
}

pub static INFO: CommandSpec = row("info", "tell the version")
    .with(takes!(info))
    .example("info");

fn info<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let version = env!("CARGO_PKG_VERSION");
    let message = format_args!("Sinew {version}, the language of RATS 7.31");
    run.note(&command.word_span, message, "");
    Ok(Flow::Next)
}

pub static RATS: CommandSpec = row("rats", "small talk").with(takes!(rats)).example("rats");

fn rats<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.note(&command.word_span, "squeak", "");
    Ok(Flow::Next)
}

pub static COLORS: CommandSpec = row("colors", "list the colours by name")
    .with(takes!(colors))
    .example("colors");

fn colors<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let list = from_fn(|text| {
        let names: Vec<_> = colours::names().collect();
        write!(
            text,
            "the colours are {}, and Gray0 to Gray100",
            names.join(" ")
        )
    });
    run.note(&command.word_span, list, "");
    Ok(Flow::Next)
}

pub static HELP: CommandSpec = row("help", "explain a command, or list all")
    .with(takes!(
        help,
        existing("command", Names::Command, "a command").optional("")
    ))
    .example("help sphere");

fn help<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: Option<Name<'a>>,
) -> Outcome<Flow> {
    let spec = match name {
        Some(name) => Some(find_command(run, &name)?),
        None => None,
    };
    let text = from_fn(|f| f.write_str(&spec.map_or_else(manual::list, manual::summary)));
    run.note(&command.span, text, "");
    Ok(Flow::Next)
}

pub static MAN: CommandSpec = row("man", "explain a command and its options")
    .with(takes!(
        man,
        existing("command", Names::Command, "a command")
    ))
    .example("man surface");

fn man<'a>(run: &mut Evaluator<'a>, command: &'a Command, name: Name<'a>) -> Outcome<Flow> {
    let spec = find_command(run, &name)?;
    let page = from_fn(|f| f.write_str(&manual::page(spec)));
    run.note(&command.span, page, "");
    Ok(Flow::Next)
}

/// The command of the language that a name stands for.
///
/// # Errors
/// If there is none.
fn find_command(run: &mut Evaluator<'_>, name: &Name<'_>) -> Outcome<&'static CommandSpec> {
    run.scope.step(limits::STEPS_PER_LOOKUP, &name.span)?;
    commands::find(name.text).ok_or_else(|| {
        Problem::new(&name.span, format!("there is no command `{}`", name.text))
            .maybe_hint(commands::suggestion(name.text, std::iter::empty()))
    })
}

pub static LOG: CommandSpec = row("log", "open or close a log")
    .with(takes!(
        log,
        new_file("file", "the log's name, which ends in .txt or .log").optional("closes the log")
    ))
    .details(
        "The program writes what it says from there on into this file of the dataset's folder, \
         too: the messages about the text and the pictures that it makes. A page has no log.",
    )
    .example("log session.txt");

fn log<'a>(run: &mut Evaluator<'a>, command: &'a Command, file: Option<Name<'a>>) -> Outcome<Flow> {
    let name = file.map(|file| file.text.to_owned());
    if let Some(name) = &name {
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        if !["txt", "log"]
            .iter()
            .any(|log| ending.eq_ignore_ascii_case(log))
        {
            return Err(Problem::new(
                &command.span,
                format!("`{name}` is no name for a log, which is a text"),
            )
            .hint("let it end in .txt or .log"));
        }
    }
    run.note(
        &command.word_span,
        "the program keeps a log; a page has none",
        "",
    );
    interlude(run, command, Act::Log(name))
}

pub static STOPWATCH: CommandSpec = row("stopwatch", "measure time")
    .with(takes!(
        stopwatch,
        word("what", STOPWATCH_WORDS, "`start` or `stop`")
    ))
    .details(
        "The program tells the time that the pictures between `start` and `stop` take. A page \
         tells that of its own picture anyway.",
    )
    .example("stopwatch start");

fn stopwatch<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    what: &'static str,
) -> Outcome<Flow> {
    let starts = what == "start";
    run.note(
        &command.word_span,
        "the program tells the time; a page has no stopwatch",
        "",
    );
    interlude(run, command, Act::Stopwatch { starts })
}

pub static READ: CommandSpec = row("read", "run the commands of other files")
    .with(takes!(read, file("fn", "a file's name").many()))
    .includes()
    .details(
        "A file is looked for among the files of the project, then in the library (`tree.rat`, \
         `shell.rat`, …). A file that reads itself, even by way of others, is refused.",
    )
    .example(
        "read sphereflake.rat\nlight White, position 4 8 10\nsurface Clay, diffuse SandyBrown\n\
         sphereflake Clay, 2",
    );

fn read<'a>(run: &mut Evaluator<'a>, command: &'a Command, files: Vec<Name<'a>>) -> Outcome<Flow> {
    for name in files {
        let file = run.find_file(&name)?;
        if run.reading.contains(&file) {
            return Err(Problem::new(
                &name.span,
                format!(
                    "`{}` is being read already: this would never end",
                    name.text
                ),
            ));
        }
        if run.reading.len() >= limits::MAX_NESTED_FILES {
            return Err(Problem::new(
                &name.span,
                format!(
                    "files can read each other {} deep at most",
                    limits::MAX_NESTED_FILES
                ),
            ));
        }
        if run.run_inner(command, file)? == Flow::Quit {
            return Ok(Flow::Quit);
        }
    }
    Ok(Flow::Next)
}

/// `test`.
pub static TEST_WORDS: &[OptionSpec] = &[word_of("print", "only show the text")];

pub static TEST: CommandSpec = row("test", "run the example of a command")
    .with(takes!(
        test,
        existing("command", Names::Command, "a command"),
        word("print", TEST_WORDS, "`print`").optional("")
    ))
    .details(
        "The example joins the scene as if it had been read from a file. With `print` its text is \
         only shown.",
    )
    .example("test torus");

fn test<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: Name<'a>,
    print: Option<&'static str>,
) -> Outcome<Flow> {
    let spec = find_command(run, &name)?;
    if print.is_some() || spec.interrupts {
        let hint = match spec.interrupts {
            true => "it is only shown, as running it would end or undo what is here",
            false => "",
        };
        run.note(&command.span, spec.example, hint);
        return Ok(Flow::Next);
    }
    let Some(file) = run.sources.find_built_in(&format!("test {}", spec.name)) else {
        return Err(Problem::new(
            &name.span,
            format!("the example of `{}` cannot be run from here", spec.name),
        )
        .hint("write the name out after `test`"));
    };
    if run.reading.contains(&file) {
        return Ok(Flow::Next);
    }
    run.run_inner(command, file)
}
