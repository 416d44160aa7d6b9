//! Arithmetic in operands.
//!
//! From weakest to strongest: `or`, `and`, `not`, comparisons (in conditions only, because
//! elsewhere `<` and `>` separate), `+ −`, `* /`, a sign, `^` (from the right). Since operands
//! follow each other with nothing but space between, one rule decides what `−` and `+` mean in a
//! list: with space before and none after they begin the next operand, otherwise they join two
//! numbers. So `1 -2` is two operands, `1 - 2`, `1-2` and `(1 -2)` are one.

use crate::colours;
use crate::functions::{self, Run};
use crate::limits;
use crate::operator::{NOT, Operator, SIGN};
use crate::problem::{Outcome, Problem};
use crate::reader::Reader;
use crate::suggest;
use crate::symbol::Symbol;
use crate::syntax::Datum;
use crate::value::Value;
use glam::DVec3;

impl<'a> Reader<'_, 'a> {
    /// Reads an expression and returns its value.
    ///
    /// # Errors
    /// If there is none or it cannot be computed.
    pub fn value(&mut self, what: &str) -> Outcome<Value> {
        if !self.more() {
            return Err(self.missing(what));
        }
        self.binary(0, what)
    }

    /// Reads a condition and returns its truth: anything but 0 is true.
    ///
    /// # Errors
    /// If there is none or it cannot be computed.
    pub fn condition(&mut self) -> Outcome<bool> {
        self.comparing = true;
        let start = self.here().start;
        if self.at >= self.items.len() {
            return Err(self.missing("a condition"));
        }
        let value = self.binary(0, "a condition")?;
        if self.at < self.items.len() {
            let problem = self.missing("`{` after the condition");
            return Err(match self.datum() {
                Some(Datum::Sign(b'=' | b'<' | b'>' | b'!')) => {
                    problem.hint("comparisons are ==, !=, <, <=, > and >=")
                }
                _ => problem,
            });
        }
        match value {
            Value::Scalar(number) => Ok(number != 0.0),
            _ => Err(Problem::new(
                &self.since(start),
                format!("a condition must be a number, this is {}", value.kind()),
            )),
        }
    }

    fn binary(&mut self, least: u8, what: &str) -> Outcome<Value> {
        self.depth += 1;
        if self.depth > limits::MAX_NESTED_EXPRESSIONS {
            return Err(Problem::new(
                &self.here(),
                format!(
                    "this expression is nested more than {} deep",
                    limits::MAX_NESTED_EXPRESSIONS
                ),
            )
            .hint("compute parts of it in variables first"));
        }
        let start = self.here().start;
        let mut left = self.prefix(what)?;
        while let Some((operator, length)) =
            Operator::at(self.items, self.at, self.text, self.listed, self.comparing)
        {
            if operator.strength() < least {
                break;
            }
            self.at += length;
            let right = self.binary(operator.right_strength(), "a number after the operator")?;
            left = self.join(left, operator, right, start)?;
        }
        self.depth -= 1;
        Ok(left)
    }

    fn join(&self, left: Value, operator: Operator, right: Value, start: usize) -> Outcome<Value> {
        let scalars = match (left, right) {
            (Value::Scalar(a), Value::Scalar(b)) => Some((a, b)),
            _ => None,
        };
        let value = match operator {
            Operator::Plus => left.zip(right, |a, b| a + b),
            Operator::Minus => left.zip(right, |a, b| a - b),
            Operator::Times => match (left, right) {
                (Value::Scalar(s), other) | (other, Value::Scalar(s)) => Some(other.map(|x| x * s)),
                // Number by number, as light falls on a colour.
                _ => left.zip(right, |a, b| a * b),
            },
            Operator::Over => match right {
                Value::Scalar(s) => Some(left.map(|x| x / s)),
                _ => None,
            },
            Operator::Power => scalars.map(|(a, b)| Value::Scalar(libm::pow(a, b))),
            _ => scalars.map(|(a, b)| {
                let truth = match operator {
                    Operator::Or => a != 0.0 || b != 0.0,
                    Operator::And => a != 0.0 && b != 0.0,
                    Operator::Less => a < b,
                    Operator::LessEqual => a <= b,
                    Operator::Greater => a > b,
                    Operator::GreaterEqual => a >= b,
                    Operator::Equal => a == b,
                    _ => a != b,
                };
                Value::Scalar(f64::from(u8::from(truth)))
            }),
        };
        value.ok_or_else(|| {
            Problem::new(
                &self.since(start),
                format!("{} and {} cannot be joined so", left.kind(), right.kind()),
            )
        })
    }

    fn prefix(&mut self, what: &str) -> Outcome<Value> {
        match self.datum() {
            Some(Datum::Sign(sign @ (b'+' | b'-'))) => {
                self.at += 1;
                let value = self.binary(SIGN, "a number after the sign")?;
                Ok(if sign == b'-' {
                    value.map(|x| -x)
                } else {
                    value
                })
            }
            Some(Datum::Word(symbol))
                if self.comparing
                    && self.scope.symbols.word(symbol).eq_ignore_ascii_case("not")
                    && self.scope.get(symbol).is_none() =>
            {
                self.at += 1;
                let value = self.binary(NOT, what)?;
                Ok(value.map(|x| f64::from(u8::from(x == 0.0))))
            }
            _ => self.operand(what),
        }
    }

    fn operand(&mut self, what: &str) -> Outcome<Value> {
        let span = self.here();
        self.scope.step(1, &span)?;
        match self.datum() {
            Some(Datum::Number(number)) => {
                self.at += 1;
                Ok(Value::Scalar(number))
            }
            Some(Datum::Sign(b'(')) => {
                self.at += 1;
                let listed = std::mem::replace(&mut self.listed, false);
                let value = self.binary(0, "a number")?;
                self.listed = listed;
                if self.datum() != Some(Datum::Sign(b')')) {
                    let problem = self.missing("`)`");
                    return Err(match self.datum() {
                        Some(Datum::Sign(b'<' | b'>' | b'=' | b'!')) => {
                            problem.hint("comparisons stand only in `if`")
                        }
                        _ => problem,
                    });
                }
                self.at += 1;
                Ok(value)
            }
            Some(Datum::Word(symbol)) => {
                let word = self.scope.symbols.word(symbol);
                // A variable or colour (`Tan`) hides a function of the same name, unless it is
                // plainly called.
                let is_known = self.scope.get(symbol).is_some() || colours::find(word).is_some();
                if (!is_known || self.is_called())
                    && let Some(function) = functions::find(word)
                {
                    return self.call(function, span.start);
                }
                let value = self.word_value(symbol)?;
                self.at += 1;
                Ok(value)
            }
            Some(Datum::Sign(b'<')) if !self.listed || what.contains("operator") => {
                let problem = self.missing(what);
                Err(problem.hint("in an expression a vector is written `vec(x, y, z)`"))
            }
            _ => Err(self.missing(what)),
        }
    }

    /// Returns whether `(` follows the word here without space.
    fn is_called(&self) -> bool {
        self.items
            .get(self.at + 1)
            .is_some_and(|next| next.datum == Datum::Sign(b'(') && !next.spaced)
    }

    /// Reads a function with its arguments in parentheses, separated by commas, and applies it.
    fn call(&mut self, function: &'static functions::Function, start: usize) -> Outcome<Value> {
        self.at += 1;
        if self.datum() != Some(Datum::Sign(b'(')) {
            if matches!(function.run, Run::Random) {
                return Ok(Value::Scalar(self.scope.random.draw()));
            }
            return Err(Problem::new(
                &(start..self.since(start).end),
                format!(
                    "the function `{}` needs its arguments in ( )",
                    function.name
                ),
            )
            .hint(function.meaning));
        }
        self.at += 1;
        let listed = std::mem::replace(&mut self.listed, false);
        let mut arguments = Vec::new();
        if self.datum() != Some(Datum::Sign(b')')) {
            loop {
                arguments.push(self.binary(0, "a number")?);
                if self.datum() != Some(Datum::Sign(b',')) {
                    break;
                }
                self.at += 1;
            }
        }
        self.listed = listed;
        if self.datum() != Some(Datum::Sign(b')')) {
            return Err(self.missing("`,` or `)`"));
        }
        self.at += 1;
        if arguments.is_empty() && matches!(function.run, Run::Random) {
            return Ok(Value::Scalar(self.scope.random.draw()));
        }
        if matches!(function.run, Run::Noise) {
            // It draws two dozen random numbers.
            self.scope.step(12, &self.here())?;
        }
        functions::apply(function, &arguments)
            .map_err(|message| Problem::new(&self.since(start), message).hint(function.meaning))
    }

    /// Returns the value of a word that stands in an expression and is no function.
    fn word_value(&mut self, symbol: Symbol) -> Outcome<Value> {
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
        if let Some(constant) = functions::constant(word) {
            return Ok(Value::Scalar(constant));
        }
        if let Some(colour) = colours::find(word) {
            // A search through names takes longer than a look at a variable.
            self.scope.step(3, &self.here())?;
            return Ok(Value::Colour(DVec3::from_array(colour.map(f64::from))));
        }
        let span = self.here();
        if self.scope.is_broken(symbol) {
            return Err(Problem::follow_up(&span));
        }
        // More than the hint will look at need not be gathered.
        let mut known: Vec<&'a str> = self.scope.names().take(2001).collect();
        known.extend(functions::FUNCTIONS.iter().map(|f| -> &'a str { f.name }));
        known.extend(colours::names().map(|name| -> &'a str { name }));
        let suggestion = suggest::hint(word, known);
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            return Err(Problem::new(&span, format!("`{word}` is no number")));
        }
        let hint =
            suggestion.unwrap_or_else(|| format!("set it before it is used: `var {word} = …`"));
        Err(Problem::new(&span, format!("there is no variable or colour `{word}`")).hint(hint))
    }
}
