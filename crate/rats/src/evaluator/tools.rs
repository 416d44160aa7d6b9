//! TOOLS: work on pictures. The compiler touches no files, so each command becomes a [`Tool`] in the
//! result, for the program and the page to carry out.

use super::state::{Evaluator, Flow};
use crate::colours;
use crate::given::Given;
use crate::limits::MAX_TOOLS;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use crate::tool::{Playback, Shown, Tool};

/// Lists a job.
fn job<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    make: impl FnOnce(&Given<'a>) -> Outcome<Tool>,
) -> Outcome<Flow> {
    let given = run.given(command)?;
    let tool = make(&given)?;
    if run.tools.len() >= MAX_TOOLS {
        return Err(Problem::new(
            command.span.clone(),
            format!("there are more than {MAX_TOOLS} jobs on files"),
        ));
    }
    run.tools.push(tool);
    run.tool_origins.push(run.origin(command));
    Ok(Flow::Next)
}

fn files(given: &Given<'_>) -> Vec<String> {
    given
        .names("fn")
        .iter()
        .map(|name| name.text.to_owned())
        .collect()
}

fn file(given: &Given<'_>, parameter: &'static str) -> String {
    given.name(parameter).text.to_owned()
}

fn saved(given: &Given<'_>) -> Option<String> {
    let chosen = given.option("save")?;
    Some(file(&chosen.given, "fn"))
}

/// `animate fn1 … [loop|mirror|dither]`
pub fn animate<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let has = |name| given.option(name).is_some();
        Ok(Tool::Animate {
            files: files(given),
            playback: match (has("loop"), has("mirror")) {
                (_, true) => Playback::Mirror,
                (true, _) => Playback::Loop,
                _ => Playback::Once,
            },
            dither: has("dither"),
        })
    })
}

/// `play fn`
pub fn play<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let file = file(given, "fn");
        Ok(Tool::Play { file })
    })
}

/// `split fn [frame.fmt]`
pub fn split<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        Ok(Tool::Split {
            file: file(given, "fn"),
            pattern: given.maybe_name("frame.fmt").map(|n| n.text.to_owned()),
        })
    })
}

/// `collage fn1 fn2 … [columns n]`
pub fn collage<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let columns = given.option("columns").map(|c| c.given.number("n") as u32);
        Ok(Tool::Collage {
            columns,
            files: files(given),
        })
    })
}

/// `fli fn1 … [speed N] [size W H]`
pub fn fli<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let speed = given.option("speed").map(|c| c.given.number("N"));
        let size = given
            .option("size")
            .map(|c| ["W", "H"].map(|side| c.given.number(side) as u32));
        Ok(Tool::Fli {
            files: files(given),
            speed,
            size,
        })
    })
}

/// `convert fn1 fn2`
pub fn convert<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        Ok(Tool::Convert {
            from: file(given, "fn"),
            to: file(given, "fn2"),
        })
    })
}

/// `resize fn x y`
pub fn resize<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        Ok(Tool::Resize {
            file: file(given, "fn"),
            width: given.number("x") as u32,
            height: given.number("y") as u32,
        })
    })
}

/// `diff fn1 fn2 [save fn]`
pub fn diff<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let (a, b, save) = (file(given, "fn"), file(given, "fn2"), saved(given));
        Ok(Tool::Diff { a, b, save })
    })
}

/// `and fn1 fn2 [save fn]`
pub fn and<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let (a, b, save) = (file(given, "fn"), file(given, "fn2"), saved(given));
        Ok(Tool::And { a, b, save })
    })
}

/// `xor fn1 fn2 [save fn]`
pub fn xor<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let (a, b, save) = (file(given, "fn"), file(given, "fn2"), saved(given));
        Ok(Tool::Xor { a, b, save })
    })
}

/// `show file fn`, `show color Color`, `show palette`
pub fn show<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let source = &run.sources.all[run.file];
    job(run, command, |given| {
        if let [_, second, ..] = &given.options[..] {
            return Err(Problem::new(
                second.span.clone(),
                "`show` shows one thing at a time",
            ));
        }
        let Some(chosen) = given.options.first() else {
            return Err(
                Problem::new(command.span.clone(), "`show` needs something to show")
                    .hint("`file`, `color` or `palette`"),
            );
        };
        let what = match chosen.name {
            "file" => Shown::File(file(&chosen.given, "fn")),
            "color" => {
                let written = &source.text[chosen.given.span("Color").unwrap_or(0..0)];
                let rgb = chosen.given.colour("Color");
                // How a text is laid out must not matter, so only a word is kept as it is written.
                let name = if written.chars().all(char::is_alphanumeric) {
                    written.to_owned()
                } else {
                    rgb.map(|share| share.to_string()).join(" ")
                };
                Shown::Colour { name, rgb }
            }
            _ => Shown::Palette(colours::names().filter_map(colours::find).collect()),
        };
        Ok(Tool::Show { what })
    })
}

/// `table v1 v2 …`
pub fn table<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    job(run, command, |given| {
        let values = given.numbers("v");
        if !(2..=256).contains(&values.len()) {
            return Err(Problem::new(
                command.span.clone(),
                format!("a table has from 2 to 256 numbers, not {}", values.len()),
            ));
        }
        Ok(Tool::Table { values })
    })
}
