//! Reads a command's operands one after the other: numbers, triples, colours, names and options.
//!
//! Commas, `<` and `>` only separate, so they are skipped wherever an operand may begin.

use crate::colours;
use crate::commands::{CommandSpec, OptionSpec};
use crate::limits::MAX_MAGNITUDE;
use crate::problem::{Outcome, Problem};
use crate::scope::Scope;
use crate::suggest;
use crate::symbol::Symbol;
use crate::syntax::{Command, Datum, Item};
use crate::value::Value;
use glam::DVec3;
use std::ops::Range;

/// A user's name: of a material, an object, a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name<'a> {
    /// The name.
    pub text: &'a str,
    /// Where it stands.
    pub span: Range<usize>,
}

/// A colour of a material: a value, or a share of another colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Share {
    /// Red, green, blue.
    Colour([f32; 3]),
    /// `N%`, as N/100.
    Percent(f32),
}

/// Largest number of a colour.
const MAX_COLOUR: f64 = 1e4;

/// Reads the operands of one command.
#[derive(Debug)]
pub struct Reader<'e, 'a> {
    /// The operands.
    pub(crate) items: &'e [Item],
    /// The next operand.
    pub(crate) at: usize,
    /// The text of the file.
    pub(crate) text: &'a str,
    /// The variables.
    pub(crate) scope: &'e mut Scope<'a>,
    /// Whether `a -b` is two operands (in a list) or one (in a head or in parentheses).
    pub(crate) listed: bool,
    /// Whether `<` and `>` compare (in a condition).
    pub(crate) comparing: bool,
    /// How deep the expression that is being read is nested.
    pub(crate) depth: usize,
    spec: Option<&'static CommandSpec>,
    /// Where something is missing if the operands end too soon.
    end: Range<usize>,
}

impl<'e, 'a> Reader<'e, 'a> {
    /// Reads the operands of `command`, which are among `items`, all those of its file.
    pub fn new(
        command: &Command,
        items: &'e [Item],
        text: &'a str,
        scope: &'e mut Scope<'a>,
    ) -> Self {
        let items = &items[command.items.clone()];
        Self {
            items,
            at: 0,
            text,
            scope,
            listed: true,
            comparing: false,
            depth: 0,
            spec: command.spec,
            end: command.span.clone(),
        }
    }

    /// Lets `a -b` be a difference, as suits the head of a loop or choice.
    #[must_use]
    pub fn unlisted(mut self) -> Self {
        self.listed = false;
        self
    }

    /// Skips separators; whether operands are left.
    pub fn more(&mut self) -> bool {
        while let Some(Datum::Sign(b',' | b'<' | b'>')) = self.datum() {
            self.at += 1;
        }
        self.at < self.items.len()
    }

    /// The next item as it is.
    pub(crate) fn datum(&self) -> Option<Datum> {
        self.items.get(self.at).map(|item| item.datum)
    }

    /// Where the next operand is, or the whole command if there is none.
    #[must_use]
    pub fn here(&self) -> Range<usize> {
        self.items
            .get(self.at)
            .map_or_else(|| self.end.clone(), Item::span)
    }

    /// The range from an earlier place to the last operand read.
    #[must_use]
    pub fn since(&self, start: usize) -> Range<usize> {
        let end = self
            .at
            .checked_sub(1)
            .and_then(|last| self.items.get(last))
            .map_or(start, |item| item.end as usize);
        start..end.max(start)
    }

    /// Where the next operand begins.
    pub fn start(&mut self) -> usize {
        self.more();
        self.here().start
    }

    /// How the command is written.
    pub(crate) fn usage(&self) -> Option<String> {
        self.spec.map(CommandSpec::usage)
    }

    /// The text of the next item.
    fn found(&self) -> Option<&'a str> {
        self.items.get(self.at).map(|item| &self.text[item.span()])
    }

    /// The problem that `what` is missing or something else stands there.
    pub(crate) fn expected(&self, what: &str) -> Box<Problem> {
        let message = match self.found() {
            Some(found) => format!("expected {what}, found `{found}`"),
            None => format!("expected {what}, but the command ends here"),
        };
        Problem::new(self.here(), message).maybe_hint(self.usage())
    }

    /// The next word, not taken.
    pub fn peek_word(&mut self) -> Option<(Symbol, &'a str)> {
        if !self.more() {
            return None;
        }
        match self.datum() {
            Some(Datum::Word(symbol)) => Some((symbol, self.scope.symbols.word(symbol))),
            _ => None,
        }
    }

    /// Takes the next word if it is `keyword`, in any case.
    pub fn keyword(&mut self, keyword: &str) -> bool {
        let found = self
            .peek_word()
            .is_some_and(|(_, word)| word.eq_ignore_ascii_case(keyword));
        self.at += usize::from(found);
        found
    }

    /// Takes the next item if it is `sign`. Commas before it are skipped.
    pub fn sign(&mut self, sign: u8) -> bool {
        let found = self.more() && self.datum() == Some(Datum::Sign(sign));
        self.at += usize::from(found);
        found
    }

    /// A user's name. Signs that are not separated from it belong to it (`sin^2`, `../shell.rat`).
    ///
    /// # Errors
    /// If there is none.
    pub fn name(&mut self, what: &str) -> Outcome<Name<'a>> {
        self.glued(what, |datum| matches!(datum, Datum::Sign(b'^')))
    }

    /// A file's name: all up to the next separator.
    ///
    /// # Errors
    /// If there is none.
    pub fn file_name(&mut self, what: &str) -> Outcome<Name<'a>> {
        self.glued(what, |datum| {
            !matches!(datum, Datum::Sign(b',' | b'<' | b'>'))
        })
    }

    fn glued(&mut self, what: &str, sign: fn(Datum) -> bool) -> Outcome<Name<'a>> {
        let part = |datum| matches!(datum, Datum::Word(_) | Datum::Number(_)) || sign(datum);
        if !self.more() || !self.datum().is_some_and(part) {
            return Err(self.expected(what));
        }
        let start = self.here().start;
        self.at += 1;
        while self
            .items
            .get(self.at)
            .is_some_and(|item| !item.spaced && part(item.datum))
        {
            self.at += 1;
        }
        let span = self.since(start);
        Ok(Name {
            text: &self.text[span.clone()],
            span,
        })
    }

    /// A number.
    ///
    /// # Errors
    /// If there is none, or it is too large or not a number.
    pub fn number(&mut self, what: &str) -> Outcome<f64> {
        let start = self.start();
        match self.value(what)? {
            Value::Scalar(number) => self.check(number, start, what),
            other => Err(Problem::new(
                self.since(start),
                format!("{what} must be a number, this is {}", other.kind()),
            )
            .maybe_hint(self.usage())),
        }
    }

    /// A number within bounds.
    ///
    /// # Errors
    /// As [`Self::number`], and if it is out of bounds.
    pub fn number_in(&mut self, what: &str, low: f64, high: f64) -> Outcome<f64> {
        let start = self.start();
        let number = self.number(what)?;
        if (low..=high).contains(&number) {
            return Ok(number);
        }
        let bounds = if high >= MAX_MAGNITUDE {
            format!("at least {low}")
        } else {
            format!("from {low} to {high}")
        };
        Err(Problem::new(
            self.since(start),
            format!("{what} must be {bounds}, not {number}"),
        ))
    }

    /// A whole number within bounds.
    ///
    /// # Errors
    /// As [`Self::number`], and if it is not whole or out of bounds.
    pub fn whole(&mut self, what: &str, low: u32, high: u32) -> Outcome<u32> {
        let start = self.start();
        let number = self.number_in(what, f64::from(low), f64::from(high))?;
        if number.fract() == 0.0 {
            return Ok(number as u32);
        }
        Err(Problem::new(
            self.since(start),
            format!("{what} must be a whole number, not {number}"),
        ))
    }

    fn check(&self, number: f64, start: usize, what: &str) -> Outcome<f64> {
        if number.abs() <= MAX_MAGNITUDE {
            return Ok(number);
        }
        let problem = |message| Problem::new(self.since(start), message);
        Err(if number.is_finite() {
            problem(format!(
                "{what} is too large: the limit is {MAX_MAGNITUDE:e}"
            ))
        } else {
            problem(format!("{what} comes out as no finite number"))
                .hint("look for a division by 0 or a root of a negative number")
        })
    }

    /// Three numbers, or a vector or colour.
    ///
    /// # Errors
    /// If there is none, or a number is too large or not a number.
    pub fn vector(&mut self, what: &str) -> Outcome<DVec3> {
        match self.triple(what)? {
            Value::Vector(vector) | Value::Colour(vector) => Ok(vector),
            Value::Scalar(_) => Err(self.expected(what)),
        }
    }

    /// A triple as it is, vector or colour; three numbers give a vector.
    ///
    /// # Errors
    /// As [`Self::vector`].
    pub fn triple(&mut self, what: &str) -> Outcome<Value> {
        let start = self.start();
        let value = match self.value(what)? {
            Value::Scalar(x) => {
                let y = self.number_after(what)?;
                Value::Vector(DVec3::new(x, y, self.number_after(what)?))
            }
            triple => triple,
        };
        if let Value::Vector(v) | Value::Colour(v) = value {
            for number in v.to_array() {
                self.check(number, start, what)?;
            }
        }
        Ok(value)
    }

    /// The second or third number of a triple.
    fn number_after(&mut self, what: &str) -> Outcome<f64> {
        let start = self.start();
        let at = self.at;
        let inner = match self.value(what) {
            Ok(Value::Scalar(number)) => return Ok(number),
            // Something that is no value at all: better say what is missing here.
            Err(inner) if inner.span.start == start && !inner.quiet && !inner.fatal => inner.hint,
            Err(inner) => return Err(inner),
            Ok(_) => None,
        };
        self.at = at;
        let message = match self.found() {
            Some(found) => format!("{what} takes three numbers, found `{found}`"),
            None => format!("{what} takes three numbers, but the command ends here"),
        };
        Err(Problem::new(self.here(), message).maybe_hint(inner.or_else(|| self.usage())))
    }

    /// A direction: a vector that is not 0.
    ///
    /// # Errors
    /// As [`Self::vector`], and if it is 0.
    pub fn direction(&mut self, what: &str) -> Outcome<DVec3> {
        let start = self.start();
        let vector = self.vector(what)?;
        vector.try_normalize().ok_or_else(|| {
            Problem::new(
                self.since(start),
                format!("{what} must not be 0 0 0: it is a direction"),
            )
        })
    }

    /// A colour: a name, a variable or three numbers.
    ///
    /// # Errors
    /// If there is none, or a number is negative.
    pub fn colour(&mut self, what: &str) -> Outcome<[f32; 3]> {
        let start = self.start();
        let vector = self.vector(what)?;
        self.to_colour(vector, start, what)
    }

    fn to_colour(&self, vector: DVec3, start: usize, what: &str) -> Outcome<[f32; 3]> {
        if vector.min_element() < 0.0 || vector.max_element() > MAX_COLOUR {
            return Err(Problem::new(
                self.since(start),
                format!("{what} needs numbers from 0 (none) to 1 (full)"),
            )
            .hint(format!("more than 1 glares; {MAX_COLOUR} is the limit")));
        }
        Ok(vector.to_array().map(|c| c as f32))
    }

    /// A colour or `N%`.
    ///
    /// # Errors
    /// If there is neither.
    pub fn share(&mut self, what: &str) -> Outcome<Share> {
        let start = self.start();
        let value = self.value(what)?;
        let percent = self
            .items
            .get(self.at)
            .is_some_and(|item| item.datum == Datum::Sign(b'%') && !item.spaced);
        match value {
            Value::Scalar(number) if percent => {
                self.at += 1;
                let number = self.check(number, start, what)?;
                if !(0.0..=1e6).contains(&number) {
                    return Err(Problem::new(
                        self.since(start),
                        format!("{what} must be at least 0%"),
                    ));
                }
                Ok(Share::Percent((number / 100.0) as f32))
            }
            Value::Scalar(x) => {
                let y = self.number_after(what)?;
                let vector = DVec3::new(x, y, self.number_after(what)?);
                for number in vector.to_array() {
                    self.check(number, start, what)?;
                }
                Ok(Share::Colour(self.to_colour(vector, start, what)?))
            }
            Value::Vector(v) | Value::Colour(v) => {
                Ok(Share::Colour(self.to_colour(v, start, what)?))
            }
        }
    }

    /// `on` or `off`.
    ///
    /// # Errors
    /// If there is neither.
    pub fn on_off(&mut self) -> Outcome<bool> {
        if self.keyword("on") {
            Ok(true)
        } else if self.keyword("off") {
            Ok(false)
        } else {
            Err(self.expected("`on` or `off`"))
        }
    }

    /// The next option, one of `options`, which may be shortened to any beginning that fits one only.
    /// `None` at the end of the command.
    ///
    /// # Errors
    /// If there is something else, or a beginning of several options.
    pub fn option(
        &mut self,
        options: &'static [OptionSpec],
    ) -> Outcome<Option<(&'static OptionSpec, Range<usize>)>> {
        if !self.more() {
            return Ok(None);
        }
        self.scope.step(2, &self.here())?;
        let back = self.at;
        let Ok(name) = self.name("an option") else {
            return Err(self.expected("an option"));
        };
        let mut fitting = options.iter().filter(|option| {
            option
                .name
                .get(..name.text.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(name.text))
        });
        let exact = options
            .iter()
            .find(|option| option.name.eq_ignore_ascii_case(name.text));
        match (exact, fitting.next(), fitting.next()) {
            (Some(option), _, _) | (None, Some(option), None) => Ok(Some((option, name.span))),
            (None, Some(first), Some(second)) => {
                let mut names = format!("`{}`, `{}`", first.name, second.name);
                for option in fitting {
                    names += &format!(", `{}`", option.name);
                }
                Err(Problem::new(
                    name.span,
                    format!("`{}` is short for several options", name.text),
                )
                .hint(format!("write more of one of {names}")))
            }
            (None, None, _) => {
                self.at = back;
                let suggestion = suggest::hint(name.text, options.iter().map(|o| o.name));
                let all = || {
                    let names: Vec<_> = options.iter().map(|o| o.name).collect();
                    format!("the options are {}", names.join(", "))
                };
                let command = self.spec.map_or("this command", |spec| spec.name);
                Err(Problem::new(
                    name.span,
                    format!("`{command}` has no option `{}`", name.text),
                )
                .hint(suggestion.unwrap_or_else(all)))
            }
        }
    }

    /// The end of the command.
    ///
    /// # Errors
    /// If something is left.
    pub fn end(&mut self) -> Outcome<()> {
        if !self.more() {
            return Ok(());
        }
        let found = &self.text[self.here()];
        Err(Problem::new(
            self.here(),
            format!("the command is complete before `{found}`"),
        )
        .maybe_hint(self.usage()))
    }

    /// The value of a word that stands in an expression and is no function.
    pub(crate) fn word_value(&mut self, symbol: Symbol) -> Outcome<Value> {
        if let Some(value) = self.scope.get(symbol) {
            return Ok(value);
        }
        let word = self.scope.symbols.word(symbol);
        if let Some((triple, component)) = word.rsplit_once('.')
            && let Some(value) = self.scope.symbols.find(triple)
            && let Some(value) = self.scope.get(value)
            && let Some(number) = value.component(component)
        {
            return Ok(Value::Scalar(number));
        }
        if let Some(constant) = crate::functions::constant(word) {
            return Ok(Value::Scalar(constant));
        }
        if let Some(colour) = colours::find(word) {
            // A search through names takes longer than a look at a variable.
            self.scope.step(3, &self.here())?;
            return Ok(Value::Colour(DVec3::from_array(colour.map(f64::from))));
        }
        let span = self.here();
        if self.scope.is_broken(symbol) {
            return Err(Problem::follow_up(span));
        }
        let mut known: Vec<&'a str> = self.scope.names().collect();
        known.extend(
            crate::functions::FUNCTIONS
                .iter()
                .map(|f| -> &'a str { f.name }),
        );
        known.extend(colours::names().map(|name| -> &'a str { name }));
        let suggestion = suggest::hint(word, known);
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            return Err(Problem::new(span, format!("`{word}` is no number")));
        }
        let hint =
            suggestion.unwrap_or_else(|| format!("set it before it is used: `var {word} = …`"));
        Err(Problem::new(span, format!("there is no variable or colour `{word}`")).hint(hint))
    }
}
