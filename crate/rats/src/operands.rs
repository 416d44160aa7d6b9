//! Operands that are values: numbers, triples, colours.

use crate::commands::OptionSpec;
use crate::limits::{MAX_MAGNITUDE, MIN_MAGNITUDE};
use crate::problem::{Outcome, Problem};
use crate::reader::Reader;
use crate::syntax::Datum;
use crate::value::Value;
use glam::DVec3;

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

impl Reader<'_, '_> {
    /// Reads a number.
    ///
    /// # Errors
    /// If there is none, or it is too large or not a number.
    pub fn number(&mut self, what: &str) -> Outcome<f64> {
        let start = self.start();
        match self.value(what)? {
            Value::Scalar(number) => self.check(number, start, what),
            other => Err(Problem::new(
                &self.since(start),
                format!("{what} must be a number, this is {}", other.kind()),
            )
            .maybe_hint(self.usage())),
        }
    }

    /// Returns whether the next operand can only be a number: not an option word or the end. A
    /// scalar variable counts, unless an option is called so.
    pub fn is_number_next(&mut self, options: &[OptionSpec]) -> bool {
        if !self.more() {
            return false;
        }
        match self.datum() {
            Some(Datum::Number(_) | Datum::Sign(b'-' | b'+' | b'(')) => true,
            Some(Datum::Word(symbol)) => {
                !self.is_option_next(options)
                    && matches!(self.scope.get(symbol), Some(Value::Scalar(_)))
            }
            _ => false,
        }
    }

    /// Reads a number within bounds, measured in `unit`.
    ///
    /// # Errors
    /// Fails as [`Self::number`] does, and if it is out of bounds.
    pub fn number_in(&mut self, what: &str, low: f64, high: f64, unit: &str) -> Outcome<f64> {
        let start = self.start();
        let number = self.number(what)?;
        if self.is_percent() {
            self.at += 1;
            let share = number / 100.0;
            let is_share = unit.is_empty() && (low..=high).contains(&share);
            let plain = if is_share { share } else { number };
            return Err(
                Problem::new(&self.since(start), format!("{what} is a number, no share"))
                    .hint(format!("write {plain}")),
            );
        }
        if (low..=high).contains(&number) {
            return Ok(number);
        }
        let bounds = if high >= MAX_MAGNITUDE {
            match low {
                low if low > 0.0 && low < 1e-6 && number <= 0.0 => String::from("above 0"),
                low if low > 0.0 && low < 1e-6 => format!("at least {low:e}"),
                low => format!("at least {low}"),
            }
        } else {
            format!("from {low} to {high} {unit}")
        };
        let bounds = bounds.trim_end();
        Err(Problem::new(
            &self.since(start),
            format!("{what} must be {bounds}, not {number}"),
        ))
    }

    /// Reads a whole number within bounds.
    ///
    /// # Errors
    /// Fails as [`Self::number`] does, and if it is not whole or out of bounds.
    pub fn whole(&mut self, what: &str, low: u32, high: u32) -> Outcome<u32> {
        let start = self.start();
        let number = self.number_in(what, f64::from(low), f64::from(high), "")?;
        if number.fract() == 0.0 {
            return Ok(number as u32);
        }
        Err(Problem::new(
            &self.since(start),
            format!("{what} must be a whole number, not {number}"),
        ))
    }

    /// Whether a `%` follows what was just read.
    fn is_percent(&self) -> bool {
        let next = self.items.get(self.at);
        next.is_some_and(|item| item.datum == Datum::Sign(b'%') && !item.spaced)
    }

    /// Returns a number that was read, or 0 for a tiny one.
    ///
    /// # Errors
    /// If it is too large or not a number.
    fn check(&self, number: f64, start: usize, what: &str) -> Outcome<f64> {
        if number.abs() < MIN_MAGNITUDE {
            return Ok(0.0);
        }
        if number.abs() <= MAX_MAGNITUDE {
            return Ok(number);
        }
        let span = self.since(start);
        if number.is_finite() {
            let message = format!("{what} is too large: the limit is {MAX_MAGNITUDE:e}");
            return Err(Problem::new(&span, message));
        }
        let message = format!("{what} comes out as no finite number");
        Err(Problem::new(&span, message)
            .hint("look for a division by 0 or a root of a negative number"))
    }

    /// Reads three numbers, or a vector or colour.
    ///
    /// # Errors
    /// If there is none, or a number is too large or not a number.
    pub fn vector(&mut self, what: &str) -> Outcome<DVec3> {
        match self.triple(what)? {
            Value::Vector(vector) | Value::Colour(vector) => Ok(vector),
            Value::Scalar(_) | Value::Name(_) => Err(self.missing(what)),
        }
    }

    /// Reads a triple as it is, vector or colour; three numbers give a vector.
    ///
    /// # Errors
    /// Fails as [`Self::vector`] does.
    pub fn triple(&mut self, what: &str) -> Outcome<Value> {
        let start = self.start();
        let first = self.at;
        let value = match self.value(what)? {
            Value::Scalar(x) => {
                let y = self.number_after(what);
                let y = y.map_err(|problem| self.only_a_number(what, first, problem))?;
                Value::Vector(DVec3::new(x, y, self.number_after(what)?))
            }
            Value::Name(_) => {
                return Err(Problem::new(
                    &self.since(start),
                    format!("{what} takes three numbers, this is a name"),
                )
                .maybe_hint(self.usage()));
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

    /// Reads the second or third number of a triple.
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
        let message = match self.next_text() {
            Some(found) => format!("{what} takes three numbers, found `{found}`"),
            None => format!("{what} takes three numbers, but the command ends here"),
        };
        Err(Problem::new(&self.here(), message).maybe_hint(inner.or_else(|| self.usage())))
    }

    /// Makes the problem that the variable which stands for three numbers, the item `first`, holds
    /// but one, if that is why the second is missing; else returns the problem.
    fn only_a_number(&self, what: &str, first: usize, problem: Box<Problem>) -> Box<Problem> {
        let item = self.items.get(first);
        let Some((item, Datum::Word(symbol))) = item.map(|item| (item, item.datum)) else {
            return problem;
        };
        let word = self.scope.symbols.word(symbol);
        if problem.quiet
            || problem.fatal
            || self.at != first + 1
            || self.scope.get(symbol).is_none()
        {
            return problem;
        }
        Problem::new(
            &item.span(),
            format!("{what} takes three numbers, but `{word}` is one number"),
        )
        .hint(format!(
            "write two more behind it, or set it to three: `var {word} = 0 0 0`"
        ))
    }

    /// Reads a direction, a vector that is not 0, and returns the unit vector.
    ///
    /// # Errors
    /// Fails as [`Self::vector`] does, and if it is 0.
    pub fn direction(&mut self, what: &str) -> Outcome<DVec3> {
        let start = self.start();
        let vector = self.vector(what)?;
        vector.try_normalize().ok_or_else(|| {
            Problem::new(
                &self.since(start),
                format!("{what} must not be 0 0 0: it is a direction"),
            )
        })
    }

    /// Reads a colour: a name, a variable or three numbers.
    ///
    /// # Errors
    /// If there is none, or a number is negative.
    pub fn colour(&mut self, what: &str) -> Outcome<[f32; 3]> {
        let start = self.start();
        let vector = self.vector(what)?;
        self.to_colour(vector, start, what)
    }

    /// Returns a vector that was read as a colour.
    ///
    /// # Errors
    /// If a number is negative or too large.
    fn to_colour(&self, vector: DVec3, start: usize, what: &str) -> Outcome<[f32; 3]> {
        for number in vector.to_array() {
            self.check(number, start, what)?;
        }
        if vector.min_element() < 0.0 || vector.max_element() > MAX_COLOUR {
            return Err(Problem::new(
                &self.since(start),
                format!("{what} needs numbers from 0 (none) to 1 (full)"),
            )
            .hint(format!("more than 1 glares; {MAX_COLOUR} is the limit")));
        }
        Ok(vector.to_array().map(|c| c as f32))
    }

    /// Reads a colour or `N%`.
    ///
    /// # Errors
    /// If there is neither.
    pub fn share(&mut self, what: &str) -> Outcome<Share> {
        let start = self.start();
        let value = self.value(what)?;
        match value {
            Value::Scalar(number) if self.is_percent() => {
                self.at += 1;
                let number = self.check(number, start, what)?;
                if !(0.0..=1e6).contains(&number) {
                    return Err(Problem::new(
                        &self.since(start),
                        format!("{what} must be at least 0%"),
                    ));
                }
                Ok(Share::Percent((number / 100.0) as f32))
            }
            Value::Scalar(x) => {
                let y = self.number_after(what)?;
                let vector = DVec3::new(x, y, self.number_after(what)?);
                Ok(Share::Colour(self.to_colour(vector, start, what)?))
            }
            Value::Vector(v) | Value::Colour(v) => {
                Ok(Share::Colour(self.to_colour(v, start, what)?))
            }
            Value::Name(_) => Err(Problem::new(
                &self.since(start),
                format!("{what} is a colour or a share, this is a name"),
            )),
        }
    }
}
