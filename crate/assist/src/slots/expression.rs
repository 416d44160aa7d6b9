//! Expressions: which operands belong to one, and the type of its value.

use super::cursor::{Slots, Type, Want};
use rats::colours;
use rats::functions::{self, Run};
use rats::limits::MAX_NESTED_EXPRESSIONS;
use rats::operator::{NOT, Operator, SIGN};
use rats::syntax::{Datum, Item};

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

    /// Reads an expression and returns its type. Takes one item at least, if there is one.
    pub(super) fn value(&mut self) -> Type {
        let start = self.at;
        let kind = self.binary(0);
        if self.at == start && !self.stopped && self.at < self.items.len() {
            self.at += 1;
            return Type::Any;
        }
        kind
    }

    fn binary(&mut self, least: u8) -> Type {
        self.depth += 1;
        if self.depth > MAX_NESTED_EXPRESSIONS {
            self.at = self.items.len();
            self.depth -= 1;
            return Type::Any;
        }
        let mut left = self.prefix();
        while let Some((operator, length)) =
            Operator::at(self.items, self.at, self.text, self.listed, self.comparing)
        {
            if operator.strength() < least {
                break;
            }
            self.at += length;
            let right = self.binary(operator.right_strength());
            left = join(left, right, operator);
        }
        self.depth -= 1;
        left
    }

    fn prefix(&mut self) -> Type {
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

    fn value_operand(&mut self) -> Type {
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

    fn word_value(&mut self) -> Type {
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

    fn call(&mut self, function: &functions::Function) -> Type {
        let mut first = None;
        let mut together = Type::Number;
        if self.datum(0) == Some(Datum::Sign(b'(')) {
            self.at += 1;
            let listed = std::mem::replace(&mut self.listed, false);
            if self.datum(0) != Some(Datum::Sign(b')')) {
                loop {
                    let kind = self.binary(0);
                    first = first.or(Some(kind));
                    together = join(together, kind, Operator::Times);
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

/// Returns the type of two values joined by an operator.
fn join(left: Type, right: Type, operator: Operator) -> Type {
    match (left, right) {
        _ if operator.is_logical() => Type::Number,
        (Type::Triple, _) | (_, Type::Triple) => Type::Triple,
        (Type::Number, Type::Number) => Type::Number,
        _ => Type::Any,
    }
}
