//! RUN: other files, messages and help.

use super::{Evaluator, Flow};
use crate::commands::{self, Action, COMMANDS, CommandSpec, Group};
use crate::limits::MAX_NESTED_FILES;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use crate::{Severity, colours, suggest};

/// `read fn1 [fn2 …]`
pub fn read<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let mut names = vec![read.file_name("a file's name")?];
    while read.more() {
        names.push(read.file_name("a file's name")?);
    }
    for name in names {
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
        run.enter(&command.word_span)?;
        let flow = run.run_file(file);
        run.depth -= 1;
        if flow == Flow::Quit {
            return Ok(flow);
        }
    }
    Ok(Flow::Next)
}

fn find_file(run: &Evaluator<'_>, name: &Name<'_>) -> Outcome<usize> {
    let bare = name.text.strip_prefix("./").unwrap_or(name.text);
    let files = &run.project.files;
    files
        .iter()
        .position(|file| file.name == bare)
        .ok_or_else(|| {
            let known: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
            let hint = suggest::hint(bare, known.iter().copied())
                .unwrap_or_else(|| format!("the files are {}", known.join(", ")));
            Problem::new(
                name.span.clone(),
                format!("there is no file `{}` in the project", name.text),
            )
            .hint(hint)
        })
}

/// `pause [message]`: a page cannot wait, so the message is shown.
pub fn pause<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let text = &run.project.files[run.file].text[command.word_span.end..command.span.end];
    let message = text.trim();
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
    run.say(Severity::Note, command.word_span.clone(), || {
        let version = env!("CARGO_PKG_VERSION");
        (format!("Sinew {version}, the language of RATS 7.31"), None)
    });
    Ok(Flow::Next)
}

/// `rats`
pub fn rats<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.say(Severity::Note, command.word_span.clone(), || {
        (String::from("squeak"), None)
    });
    Ok(Flow::Next)
}

/// `colors`
pub fn colors<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.say(Severity::Note, command.word_span.clone(), || {
        let names: Vec<_> = colours::names().collect();
        (
            format!("the colours are {}, and Gray0 to Gray100", names.join(" ")),
            None,
        )
    });
    Ok(Flow::Next)
}

/// `help [command]`, `man command`
pub fn help<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    if !read.more() {
        run.say(Severity::Note, command.word_span.clone(), || (list(), None));
        return Ok(Flow::Next);
    }
    let name = read.name("a command")?;
    read.end()?;
    let Some(spec) = commands::find(name.text) else {
        return Err(
            Problem::new(name.span, format!("there is no command `{}`", name.text))
                .maybe_hint(commands::suggestion(name.text, std::iter::empty())),
        );
    };
    run.say(Severity::Note, command.span.clone(), || (page(spec), None));
    Ok(Flow::Next)
}

/// All opcodes, group by group.
fn list() -> String {
    let groups = [
        Group::Run,
        Group::Camera,
        Group::Materials,
        Group::Primitives,
        Group::Objects,
        Group::Options,
        Group::Scene,
        Group::Tools,
        Group::Extensions,
    ];
    let line = |group: &Group| {
        let names: Vec<_> = COMMANDS
            .iter()
            .filter(|spec| spec.group == *group)
            .map(|spec| spec.name)
            .collect();
        format!("{group:?}: {}", names.join(" "))
    };
    groups.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// All that the table says of a command.
fn page(spec: &CommandSpec) -> String {
    let mut page = format!("{}: {}", spec.synopsis(), spec.meaning);
    if !spec.default.is_empty() {
        page += &format!(" (by default {})", spec.default);
    }
    match spec.action {
        Action::Later => page += "; not carried out in this version",
        Action::NoEffect(reason) => page += &format!("; changes nothing here: {reason}"),
        Action::Run(_) | Action::Structure => {}
    }
    for option in spec.options {
        page += &format!("\n  {} {}", option.name, option.arguments);
        page.truncate(page.trim_end().len());
        page += &format!(": {}", option.meaning);
        if !option.default.is_empty() {
            page += &format!(" (by default {})", option.default);
        }
    }
    page
}
