//! `var` and `seed`.

use super::later;
use super::state::{Evaluator, Flow};
use crate::commands::build::{by_itself, choice, clay, plain, row, sets};
use crate::commands::slot::{new, number, unread};
use crate::commands::{CommandSpec, Kind, Names, OptionSpec};
use crate::compiled::{HotValue, HotVariable};
use crate::limits::MAX_MAGNITUDE;
use crate::problem::{Outcome, Problem};
use crate::random::Random;
use crate::reader::{Name, Reader};
use crate::symbol::Symbol;
use crate::syntax::{Command, Datum, Item};
use crate::value::Value;
use glam::DVec3;
use std::ops::Range;

/// Options of `var`.
pub static VAR_OPTIONS: &[OptionSpec] = &[
    choice!(
        "hot",
        "",
        "a slider in the page; its range and step are ours",
        number("low", "the slider's lowest value").optional(""),
        number("high", "the slider's highest value").optional(""),
        number("step", "the slider's step").optional("")
    )
    .plain,
    choice!(
        "+=",
        "",
        "grows with every frame of an animation",
        number("step", "the change with every frame")
    )
    .plain,
    choice!(
        "*=",
        "",
        "is multiplied with every frame of an animation",
        number("factor", "the change with every frame")
    )
    .plain,
];

pub static VAR: CommandSpec = row(
    "var",
    "create or change a variable; `hot` makes it a slider",
)
.with(by_itself(
    var,
    plain![
        new("name", Names::Variable, "the variable's name"),
        unread("= value", Kind::Value, "a value")
    ],
    VAR_OPTIONS,
))
.mark_failed(set_broken)
.details(
    "A value is a number, three numbers or a colour. A colour stays a colour when it is set to \
     three numbers. `+= step` and `*= factor` change it with every frame of an animation.",
)
.example(clay!(
    "var r = 1.5 hot 0.5 2.5 0.1\nvar Where = 0 0 0\nsphere Clay r, Where"
));

fn var<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    set(run, command)?;
    Ok(Flow::Next)
}

/// Remembers that a variable could not be set.
fn set_broken<'a>(run: &mut Evaluator<'a>, command: &'a Command) {
    if let Some((name, _)) = run.reader(command).peek_word() {
        run.scope.set_broken(name);
    }
}

/// Carries out `var`.
fn set<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let mut read = run.reader(command);
    let (name, spelled) = new_variable(&mut read)?;
    let word = spelled.text;
    let mut animated = per_frame(&mut read)?;
    if animated.is_none() && !read.sign(b'=') {
        return Err(read.missing("`=`"));
    }
    if animated.is_some() && read.scope.get(name).is_none() {
        return Err(
            Problem::new(&spelled.span, format!("`{word}` has no value yet"))
                .hint(format!("set it first: `var {word} = …`")),
        );
    }
    let mut place = None;
    if animated.is_none() {
        let (value, literal) = value(&mut read)?;
        place = literal.clone();
        let mut hot = None;
        loop {
            let here = read.start();
            if read.keyword("hot") {
                let numbers = slider(&mut read)?;
                hot = Some((read.since(here), numbers));
            } else if let Some(change) = per_frame(&mut read)? {
                if animated.is_some() {
                    return Err(Problem::new(
                        &change.1,
                        "a variable changes in one way with every frame",
                    ));
                }
                animated = Some(change);
            } else {
                break;
            }
        }
        read.end()?;
        // A colour stays a colour when it is given as three numbers.
        let value = match (run.scope.get(name), value) {
            (Some(Value::Colour(_)), Value::Vector(v)) => Value::Colour(v),
            _ => value,
        };
        if matches!(value, Value::Name(_)) {
            return Err(Problem::new(
                &spelled.span,
                "a variable holds a number, three numbers or a colour, no name",
            ));
        }
        note_kept(run, name, &spelled, value)?;
        run.scope.set(name, value);
        if let Some((span, numbers)) = hot {
            make_hot(run, word, value, literal, numbers, span);
        }
    } else {
        read.end()?;
    }
    run.watch_variable(name, place, animated.is_some());
    match animated {
        Some((change, span)) => animate(run, name, change, span),
        None => Ok(()),
    }
}

/// Notes that shapes which a picture has shown keep the value that a variable had, if it is one of
/// their commands.
fn note_kept(
    run: &mut Evaluator<'_>,
    name: Symbol,
    spelled: &Name<'_>,
    value: Value,
) -> Outcome<()> {
    let before = run.scope.get(name);
    let is_shown = !run.shots.taken.is_empty() && !run.model.parts.is_empty();
    if !is_shown || !run.is_own() || run.repeating > 0 || before.is_none_or(|old| old == value) {
        return Ok(());
    }
    let sources = run.sources;
    let syntax = &sources.all[run.file].syntax;
    run.scope
        .step(1 + syntax.items.len() as u64 / 16, &spelled.span)?;
    let is_used = later::find(&syntax.block, &|command| {
        let items = &syntax.items[command.items.clone()];
        command.span.start < spelled.span.start
            && command.spec.is_none_or(|spec| spec.name != "var")
            && items.iter().any(|item| item.datum == Datum::Word(name))
    });
    if is_used.is_some() {
        let word = spelled.text;
        let message = format_args!("shapes made before this keep the old `{word}`");
        run.note(
            &spelled.span,
            message,
            "make them again, behind `reset data`",
        );
    }
    Ok(())
}

/// Reads the name of the variable that is made or changed.
fn new_variable<'a>(read: &mut Reader<'_, 'a>) -> Outcome<(Symbol, Name<'a>)> {
    let Some((name, word)) = read.peek_word() else {
        return Err(read.missing("the variable's name"));
    };
    let spelled = read.new_name("the variable's name")?;
    if spelled.text != word {
        return Err(Problem::new(
            &spelled.span,
            "a variable's name cannot hold `^`, which is the power in expressions",
        ));
    }
    if is_taken(word) {
        return Err(
            Problem::new(&spelled.span, format!("`{word}` is a word of the language"))
                .hint("choose another name"),
        );
    }
    Ok((name, spelled))
}

/// Sets a variable to its value in the present frame. `span` is the place of the change.
fn animate(
    run: &mut Evaluator<'_>,
    name: Symbol,
    change: Change,
    span: Range<usize>,
) -> Outcome<()> {
    run.animated = true;
    let now = run.scope.get(name).unwrap_or(Value::Scalar(0.0));
    if let (Value::Scalar(_), Change::Add(Value::Vector(_) | Value::Colour(_))) = (now, change) {
        let word = run.scope.symbols.word(name);
        return Err(Problem::new(
            &span,
            format!("`{word}` is a number, so its change with every frame must be one"),
        ));
    }
    let value = change_by(now, change, run.moment);
    if !value.all(|x| x.abs() <= MAX_MAGNITUDE) {
        return Err(Problem::new(
            &span,
            format!("in frame {} the value is too large", run.moment),
        ));
    }
    run.scope.set(name, value);
    Ok(())
}

/// Returns whether a word would be misread in expressions if it were a variable.
fn is_taken(word: &str) -> bool {
    ["hot", "to", "step", "and", "or", "not"]
        .iter()
        .any(|taken| word.eq_ignore_ascii_case(taken))
        || crate::functions::constant(word).is_some()
}

/// A change with every frame of an animation.
#[derive(Clone, Copy, Debug)]
enum Change {
    /// `+= step`
    Add(Value),
    /// `*= factor`
    Multiply(f64),
}

/// Changes a value for a number of frames, which need not be whole.
fn change_by(value: Value, change: Change, frames: f64) -> Value {
    match change {
        Change::Add(step) => match (value, step) {
            (Value::Scalar(_), Value::Scalar(_)) => value.zip(step, |x, s| x + s * frames),
            (_, Value::Scalar(s)) => Some(value.map(|x| x + s * frames)),
            _ => value.zip(step, |x, s| x + s * frames),
        }
        .unwrap_or(value),
        Change::Multiply(factor) => {
            // A factor that changes the sign does so from frame to frame, with nothing between.
            let frames = if factor < 0.0 { frames.floor() } else { frames };
            let factor = libm::pow(factor, frames);
            value.map(|x| x * factor)
        }
    }
}

/// Reads the numbers after `hot`: the slider's lowest and highest value, and its step.
fn slider(read: &mut Reader<'_, '_>) -> Outcome<(Option<[f64; 2]>, Option<f64>)> {
    let start = read.start();
    if !is_number_next(read) {
        return Ok((None, None));
    }
    let low = read.number("the slider's lowest value")?;
    let high = read.number("the slider's highest value")?;
    if low >= high {
        return Err(Problem::new(
            &read.since(start),
            format!("the slider's lowest value, {low}, is not below its highest, {high}"),
        ));
    }
    let mut step = None;
    if is_number_next(read) {
        let start = read.start();
        let value = read.number("the slider's step")?;
        if value <= 0.0 {
            return Err(Problem::new(
                &read.since(start),
                "the slider's step must be above 0",
            ));
        }
        step = Some(value);
    }
    Ok((Some([low, high]), step))
}

/// Reads `+= step` or `*= factor`, if it stands here; returns its place, too.
fn per_frame(read: &mut Reader<'_, '_>) -> Outcome<Option<(Change, Range<usize>)>> {
    let start = read.start();
    let Some([first, second]) = read.items.get(read.at..read.at + 2) else {
        return Ok(None);
    };
    let (Datum::Sign(sign @ (b'+' | b'*')), Datum::Sign(b'=')) = (first.datum, second.datum) else {
        return Ok(None);
    };
    read.at += 2;
    let change = if sign == b'+' {
        let value = read.value("the change with every frame")?;
        match value {
            Value::Scalar(x) if is_number_next(read) => {
                let y = read.number("the second number")?;
                Change::Add(Value::Vector(DVec3::new(
                    x,
                    y,
                    read.number("the third number")?,
                )))
            }
            value => Change::Add(value),
        }
    } else {
        Change::Multiply(read.number("the change with every frame")?)
    };
    Ok(Some((change, read.since(start))))
}

/// Reads one number, three numbers or a colour; returns its place, too, if it is written out, so
/// that a slider can replace it.
fn value(read: &mut Reader<'_, '_>) -> Outcome<(Value, Option<Range<usize>>)> {
    let start = read.start();
    let first = read.at;
    let mut value = read.value("a value")?;
    if let Value::Scalar(x) = value
        && is_number_next(read)
    {
        let y = read.number("the second number")?;
        if !is_number_next(read) {
            return Err(Problem::new(
                &read.since(start),
                "a variable is one number, three numbers or a colour; these are two numbers",
            )
            .hint("for a difference write `a - b` or `a-b`"));
        }
        value = Value::Vector(DVec3::new(x, y, read.number("the third number")?));
    }
    let span = read.since(start);
    if !value.all(|x| x.abs() <= MAX_MAGNITUDE) {
        return Err(Problem::new(
            &span,
            "the value comes out as no finite number, or too large",
        )
        .hint("look for a division by 0 or a root of a negative number"));
    }
    let is_literal = is_written_out(read, first..read.at, value);
    Ok((value, is_literal.then_some(span)))
}

/// Returns whether a number follows.
fn is_number_next(read: &mut Reader<'_, '_>) -> bool {
    read.more()
        && match read.datum() {
            Some(Datum::Number(_)) => true,
            Some(Datum::Sign(b'-' | b'(')) => true,
            // `+=` is no number.
            Some(Datum::Sign(b'+')) => {
                read.items.get(read.at + 1).map(|i| i.datum) != Some(Datum::Sign(b'='))
            }
            Some(Datum::Word(symbol)) => {
                let word = read.scope.symbols.word(symbol);
                !word.eq_ignore_ascii_case("hot")
            }
            _ => false,
        }
}

/// Returns whether operands are plain numbers, a colour's name or `rgb(…)` of plain numbers.
fn is_written_out(read: &Reader<'_, '_>, operands: Range<usize>, value: Value) -> bool {
    let items = &read.items[operands];
    match items {
        [item] if let Datum::Word(symbol) = item.datum => {
            let is_colour = crate::colours::find(read.scope.symbols.word(symbol)).is_some();
            is_colour && read.scope.get(symbol).is_none()
        }
        [name, open, inner @ .., close]
            if let Datum::Word(symbol) = name.datum
                && open.datum == Datum::Sign(b'(')
                && close.datum == Datum::Sign(b')') =>
        {
            read.scope.symbols.word(symbol).eq_ignore_ascii_case("rgb") && is_plain(inner, value)
        }
        _ => is_plain(items, value),
    }
}

/// Returns whether items are the plain numbers of a value, with signs and separators.
fn is_plain(items: &[Item], value: Value) -> bool {
    let (mut is_signed, mut count) = (false, 0);
    for item in items {
        match item.datum {
            Datum::Sign(b'-') if !is_signed => is_signed = true,
            Datum::Number(_) | Datum::Sign(b',' | b'<' | b'>') => is_signed = false,
            _ => return false,
        }
        count += usize::from(matches!(item.datum, Datum::Number(_)));
    }
    count == if let Value::Scalar(_) = value { 1 } else { 3 }
}

/// Makes a variable one that the page shows as a slider.
fn make_hot(
    run: &mut Evaluator<'_>,
    name: &str,
    value: Value,
    literal: Option<Range<usize>>,
    (range, step): (Option<[f64; 2]>, Option<f64>),
    span: Range<usize>,
) {
    if !run.is_own() {
        return;
    }
    if run.repeating > 0 {
        let message = "a variable of a loop or a defined command cannot be hot";
        run.warn(&span, message, "set it before, outside of the braces");
        return;
    }
    let Some(value) = HotValue::of(value) else {
        return;
    };
    let variable = HotVariable {
        name: name.to_owned(),
        value,
        file: run.file,
        literal,
        range,
        step,
    };
    match run.hot.iter_mut().find(|known| known.name == name) {
        Some(known) => *known = variable,
        None => run.hot.push(variable),
    }
}

pub static SEED: CommandSpec = row("seed", "start the random numbers of `rand`")
    .with(sets!(
        |run, seed| run.scope.random = Random::new(seed),
        number("n", "the seed")
    ))
    .default("0")
    .example(clay!(
        "seed 7\nfor i = 1 to 20 { sphere Clay 0.3, rand*6-3, rand*6-3, 0 }"
    ));
