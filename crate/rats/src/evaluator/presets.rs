//! `preset`.

use super::state::{Evaluator, Flow};
use crate::commands::build::{by_itself, choice, clay, plain, row};
use crate::commands::slot::{existing, new, unread};
use crate::commands::{CommandSpec, Kind, Names, OptionSpec};
use crate::compiled::{HotValue, Preset};
use crate::limits::MAX_MAGNITUDE;
use crate::problem::{Outcome, Problem};
use crate::reader::Reader;
use crate::syntax::Command;
use crate::value::Value;
use glam::DVec3;

/// Options of `preset`.
pub static PRESET_OPTIONS: &[OptionSpec] = &[choice!(
    "set",
    "",
    "the value of a hot variable",
    existing("name", Names::Variable, "the variable"),
    unread("value", Kind::Value, "the value")
)
.plain];

pub static PRESET: CommandSpec = row("preset", "name values for sliders, set by a button")
    .with(by_itself(
        preset,
        plain![new("name", Names::Preset, "the name on the button")],
        PRESET_OPTIONS,
    ))
    .newer()
    .details(
        "It changes nothing by itself: its button writes the values behind `var`. It stands \
         below the variables.",
    )
    .example(clay!(
        "var r = 1.5 hot\nvar C = 0 0 0 hot\n\
         preset small, set r 0.5, set C 0 1 0\npreset large, set r 2.5\nsphere Clay r, C"
    ));

fn preset<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let name = read.new_name("the preset's name")?;
    let mut values = Vec::new();
    let mut places = Vec::new();
    while read.option(PRESET_OPTIONS)?.is_some() {
        let Some((symbol, _)) = read.peek_word() else {
            return Err(read.missing("the variable's name"));
        };
        let spelled = read.name("the variable's name")?;
        let now = read.scope.get(symbol);
        let value = match (now, value(&mut read)?) {
            (Some(Value::Colour(_)), Value::Vector(v)) => Value::Colour(v),
            (_, value) => value,
        };
        let word = spelled.text;
        let fits = match now {
            None => {
                let message = format!("`{word}` has no value yet");
                return Err(Problem::new(&spelled.span, message)
                    .hint("write the preset below the variables that it sets"));
            }
            Some(now) => std::mem::discriminant(&now) == std::mem::discriminant(&value),
        };
        let (true, Some(value)) = (fits, HotValue::of(value)) else {
            let message = format!("this is another kind of value than that of `{word}`");
            return Err(Problem::new(&read.since(spelled.span.end), message).hint(
                "a number is set to a number, three numbers to three, a colour to a colour",
            ));
        };
        values.push((word.to_owned(), value));
        places.push(spelled.span);
    }
    if !run.is_own() {
        return Ok(Flow::Next);
    }
    if run.repeating > 0 {
        let message = "a preset of a loop or a defined command has no button";
        run.warn(&command.span, message, "write it outside of the braces");
        return Ok(Flow::Next);
    }
    for ((word, _), place) in values.iter().zip(places) {
        let mut hot = run.hot.iter();
        if !hot.any(|hot| hot.name == *word && hot.literal.is_some()) {
            let message = format_args!("`{word}` has no slider, so this is left alone");
            run.warn(&place, message, "write `hot` behind the variable's number");
        }
    }
    let preset = Preset {
        name: name.text.to_owned(),
        values,
    };
    match run.presets.iter_mut().find(|known| known.name == name.text) {
        Some(known) => *known = preset,
        None => run.presets.push(preset),
    }
    Ok(Flow::Next)
}

/// Reads one number, three numbers or a colour.
fn value(read: &mut Reader<'_, '_>) -> Outcome<Value> {
    let start = read.start();
    let mut value = read.value("the variable's value")?;
    if let Value::Scalar(x) = value
        && read.more()
        && !read.is_option_next(PRESET_OPTIONS)
    {
        let y = read.number("the second number")?;
        value = Value::Vector(DVec3::new(x, y, read.number("the third number")?));
    }
    if value.all(|x| x.abs() <= MAX_MAGNITUDE) {
        Ok(value)
    } else {
        let message = "the value comes out as no finite number, or too large";
        Err(Problem::new(&read.since(start), message))
    }
}
