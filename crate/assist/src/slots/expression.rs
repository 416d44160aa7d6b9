//! Expressions: which operands belong to one, and the type of its value.

use super::cursor::{Slots, Type, Want};
use rats::colours;
use rats::functions::{self, Run};
use rats::limits::MAX_NESTED_EXPRESSIONS;
use rats::syntax::{Datum, Item};

const NOT: u8 = 3;
const COMPARE: u8 = 4;
const TIMES: u8 = 6;
const SIGN: u8 = 7;
const POWER: u8 = 8;

impl<'i, 'p> Slots<'i, 'p> {
    /// Reads one expression.
    pub fn expression(
        items: &'i [Item],
        text: &'p str,
        types: &'i dyn Fn(&str) -> Option<Type>,
    ) -> Self {
        let mut slots = Self::new(items, text, types);
        while slots.more() {
            slots.value();
        }
        slots
    }

    /// An expression; its kind. Takes one item at least, if there is one.
    pub(super) fn value(&mut self) -> Type {
        let start = self.at;
        let kind = self.binary(0);
        if self.at == start && !self.stopped && self.at < self.items.len() {
            self.at += 1;
            return Type::Any;
        }
        kind
    }

    pub(super) fn binary(&mut self, least: u8) -> Type {
        self.depth += 1;
        if self.depth > MAX_NESTED_EXPRESSIONS {
            self.at = self.items.len();
            self.depth -= 1;
            return Type::Any;
        }
        let mut left = self.prefix();
        while let Some((strength, length)) = self.operator() {
            if strength < least {
                break;
            }
            self.at += length;
            // `^` groups from the right.
            let right = self.binary(strength + u8::from(strength != POWER));
            left = joined(left, right, strength);
        }
        self.depth -= 1;
        left
    }

    /// How strongly the operator here binds, and how many items it has.
    pub(super) fn operator(&self) -> Option<(u8, usize)> {
        let item = self.items.get(self.at)?;
        let next = self.items.get(self.at + 1);
        let follows_equal =
            next.is_some_and(|next| next.datum == Datum::Sign(b'=') && next.start == item.end);
        Some(match item.datum {
            Datum::Sign(b'+' | b'-') => {
                if self.listed && item.spaced && next.is_some_and(|next| !next.spaced) {
                    return None;
                }
                if follows_equal {
                    return None;
                }
                (5, 1)
            }
            Datum::Sign(b'*') if !follows_equal => (TIMES, 1),
            Datum::Sign(b'/') => (TIMES, 1),
            Datum::Sign(b'^') => (POWER, 1),
            Datum::Sign(b'<' | b'>') if self.comparing => (COMPARE, 1 + usize::from(follows_equal)),
            Datum::Sign(b'=' | b'!') if self.comparing && follows_equal => (COMPARE, 2),
            Datum::Word(_) if self.comparing => {
                let word = &self.text[item.span()];
                if word.eq_ignore_ascii_case("and") {
                    (2, 1)
                } else if word.eq_ignore_ascii_case("or") {
                    (1, 1)
                } else {
                    return None;
                }
            }
            _ => return None,
        })
    }

    pub(super) fn prefix(&mut self) -> Type {
        match self.datum(0) {
            Some(Datum::Sign(b'+' | b'-')) => {
                self.at += 1;
                self.binary(SIGN)
            }
            Some(Datum::Word(_))
                if self.comparing
                    && self.word().is_some_and(|w| w.eq_ignore_ascii_case("not"))
                    && (self.types)(self.word().unwrap_or("")).is_none() =>
            {
                self.at += 1;
                self.binary(NOT)
            }
            _ => self.value_operand(),
        }
    }

    pub(super) fn value_operand(&mut self) -> Type {
        match self.datum(0) {
            None => {
                if !self.stopped {
                    self.wants.push(Want::Value);
                    self.stopped = true;
                }
                Type::Any
            }
            Some(Datum::Number(_)) => {
                self.at += 1;
                Type::Number
            }
            Some(Datum::Sign(b'(')) => {
                self.at += 1;
                let listed = std::mem::replace(&mut self.listed, false);
                let kind = self.binary(0);
                self.listed = listed;
                if self.datum(0) == Some(Datum::Sign(b')')) {
                    self.at += 1;
                }
                kind
            }
            Some(Datum::Word(_)) => self.word_value(),
            _ => Type::Any,
        }
    }

    pub(super) fn word_value(&mut self) -> Type {
        let word = self.word().unwrap_or("");
        let is_called = self
            .items
            .get(self.at + 1)
            .is_some_and(|next| next.datum == Datum::Sign(b'(') && !next.spaced);
        let known = (self.types)(word);
        if (known.is_none() || is_called)
            && let Some(function) = functions::find(word)
        {
            self.at += 1;
            return self.call(function);
        }
        self.words.push(self.at);
        self.at += 1;
        if let Some(known) = known {
            return known;
        }
        if let Some((triple, component)) = word.rsplit_once('.')
            && (self.types)(triple).is_some()
            && ["x", "y", "z", "r", "g", "b"].contains(&component)
        {
            return Type::Number;
        }
        if functions::constant(word).is_some() {
            return Type::Number;
        }
        if colours::find(word).is_some() || word.starts_with(char::is_uppercase) {
            return Type::Triple;
        }
        Type::Any
    }

    pub(super) fn call(&mut self, function: &functions::Function) -> Type {
        let mut first = None;
        let mut together = Type::Number;
        if self.datum(0) == Some(Datum::Sign(b'(')) {
            self.at += 1;
            let listed = std::mem::replace(&mut self.listed, false);
            if self.datum(0) != Some(Datum::Sign(b')')) {
                loop {
                    let kind = self.binary(0);
                    first = first.or(Some(kind));
                    together = joined(together, kind, TIMES);
                    if self.datum(0) != Some(Datum::Sign(b',')) {
                        break;
                    }
                    self.at += 1;
                }
            }
            self.listed = listed;
            if self.datum(0) == Some(Datum::Sign(b')')) {
                self.at += 1;
            }
        }
        match function.run {
            Run::One(_) => first.unwrap_or(Type::Number),
            Run::Two(_) | Run::Fold(_) => together,
            Run::Vector | Run::Colour | Run::Cross | Run::Unit => Type::Triple,
            _ => Type::Number,
        }
    }
}

/// The kind of two values that are joined.
fn joined(left: Type, right: Type, strength: u8) -> Type {
    match (left, right) {
        _ if strength <= COMPARE => Type::Number,
        (Type::Triple, _) | (_, Type::Triple) => Type::Triple,
        (Type::Number, Type::Number) => Type::Number,
        _ => Type::Any,
    }
}
