//! What each operand of a command is for, found without running anything.
//!
//! This follows the reader of operands (`reader`, `given`, `expression`), but instead of values it knows
//! only whether something is a number or a triple, and instead of stopping at a mistake it goes on. Where
//! the operands end it notes what could come next.

use super::grammar::{Grammar, Param};
use crate::colours;
use crate::commands::{Arity, Kind, Names, OptionSpec, options};
use crate::functions::{self, Run};
use crate::limits::MAX_NESTED_EXPRESSIONS;
use crate::syntax::{Datum, Item};
use std::ops::Range;

/// The kind of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// A number.
    Number,
    /// A vector or colour.
    Triple,
    /// A name that a parameter stands for.
    Name,
    /// Not known.
    Any,
}

/// What an operand is.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// An option's word.
    Option,
    /// One of the words that a parameter allows.
    Word(&'static OptionSpec),
    /// A name.
    Name {
        /// Of what.
        of: Names,
        /// Whether it is made here.
        is_new: bool,
    },
    /// A file's name.
    File,
    /// A number, the first, second or third (0, 1, 2) of the parameter.
    Number(u8),
    /// A vector or colour.
    Triple,
    /// Text, a condition, `on` or `off`.
    Other,
    /// A word or sign that only leads on: `=`, `to`.
    Lead,
    /// The name of a parameter in `turns = 3`.
    Named,
    /// One that the command has no use for.
    Extra,
}

/// An operand and what it is for.
#[derive(Clone, Debug)]
pub struct Slot<'p> {
    /// The operand's items, as indices of the command's.
    pub items: Range<usize>,
    /// What it is.
    pub what: What,
    /// The parameter it is for.
    pub parameter: Option<Param<'p>>,
    /// The parameter's index among those of its command or option.
    pub index: usize,
    /// The option that the parameter belongs to.
    pub option: Option<&'static OptionSpec>,
}

/// What could come next.
#[derive(Clone, Copy, Debug)]
pub enum Want<'p> {
    /// An operand for a parameter; of a triple number `part`.
    Parameter {
        /// The parameter.
        parameter: Param<'p>,
        /// Its index.
        index: usize,
        /// The option it belongs to.
        option: Option<&'static OptionSpec>,
        /// The first, second or third number.
        part: u8,
    },
    /// A value in the middle of an expression.
    Value,
    /// An option.
    Options(&'static [OptionSpec]),
    /// This word.
    Lead(&'static str),
}

/// Reads operands.
pub struct Slots<'i, 'p> {
    /// The command's operands.
    items: &'i [Item],
    text: &'p str,
    types: &'i dyn Fn(&str) -> Option<Type>,
    at: usize,
    listed: bool,
    comparing: bool,
    depth: usize,
    /// Whether something is missing that must be there.
    stopped: bool,
    parameter: Option<Param<'p>>,
    index: usize,
    option: Option<&'static OptionSpec>,
    /// All operands.
    pub slots: Vec<Slot<'p>>,
    /// The items that are words in expressions and no functions.
    pub words: Vec<usize>,
    /// What could come next.
    pub wants: Vec<Want<'p>>,
}

impl<'i, 'p> Slots<'i, 'p> {
    /// Reads the operands of a command; `types` knows the variables.
    pub fn read(
        items: &'i [Item],
        text: &'p str,
        grammar: &Grammar<'p>,
        types: &'i dyn Fn(&str) -> Option<Type>,
    ) -> Self {
        let mut slots = Self::new(items, text, types);
        slots.parameters(&grammar.parameters, grammar.options, grammar.named);
        slots.options(grammar.options);
        while slots.more() {
            slots.extra();
        }
        slots
    }

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

    fn new(items: &'i [Item], text: &'p str, types: &'i dyn Fn(&str) -> Option<Type>) -> Self {
        Self {
            items,
            text,
            types,
            at: 0,
            listed: true,
            comparing: false,
            depth: 0,
            stopped: false,
            parameter: None,
            index: 0,
            option: None,
            slots: Vec::new(),
            words: Vec::new(),
            wants: Vec::new(),
        }
    }

    fn more(&mut self) -> bool {
        while let Some(Datum::Sign(b',' | b'<' | b'>')) = self.datum(0) {
            self.at += 1;
        }
        self.at < self.items.len()
    }

    fn datum(&self, ahead: usize) -> Option<Datum> {
        self.items.get(self.at + ahead).map(|item| item.datum)
    }

    fn word(&self) -> Option<&'p str> {
        match self.datum(0) {
            Some(Datum::Word(_)) => Some(&self.text[self.items[self.at].span()]),
            _ => None,
        }
    }

    fn push(&mut self, start: usize, what: What) {
        self.slots.push(Slot {
            items: start..self.at,
            what,
            parameter: self.parameter,
            index: self.index,
            option: self.option,
        });
    }

    fn extra(&mut self) {
        let start = self.at;
        self.parameter = None;
        if let Some(Datum::Word(_)) = self.datum(0) {
            self.words.push(self.at);
        }
        self.at += 1;
        self.push(start, What::Extra);
    }

    /// Notes that the operands end where the parameter could come.
    fn want(&mut self, part: u8) {
        if let Some(parameter) = self.parameter {
            self.wants.push(Want::Parameter {
                parameter,
                index: self.index,
                option: self.option,
                part,
            });
        }
    }

    fn parameters(
        &mut self,
        parameters: &[Param<'p>],
        options: &'static [OptionSpec],
        named: bool,
    ) {
        for (index, parameter) in parameters.iter().enumerate() {
            if matches!(parameter.kind, Kind::Block) {
                continue;
            }
            if named && self.more() && self.is_named() {
                return self.named(parameters);
            }
            self.parameter = Some(*parameter);
            self.index = index;
            let mut first = true;
            loop {
                let needed = first && matches!(parameter.arity, Arity::One | Arity::Many);
                if !self.lead(parameter, needed) {
                    break;
                }
                if !self.more() {
                    self.want(0);
                    self.stopped = needed;
                    break;
                }
                if !needed && !self.goes_on(parameter, options) {
                    break;
                }
                let before = self.at;
                self.operand(parameter);
                if self.stopped || self.at == before {
                    break;
                }
                first = false;
                if matches!(parameter.arity, Arity::One | Arity::Optional) {
                    break;
                }
            }
            // What is copied needs no description.
            let is_copy = matches!(parameter.kind, Kind::Copy(_)) && !first;
            if self.stopped || is_copy {
                return;
            }
        }
    }

    /// Takes the word or sign that goes before a parameter (`to b`); whether the parameter follows.
    fn lead(&mut self, parameter: &Param<'p>, needed: bool) -> bool {
        let lead = match parameter.name.split_once(' ') {
            Some((lead @ ("=" | "to" | "step"), _)) => lead,
            _ => return true,
        };
        if matches!(parameter.kind, Kind::Copy(_)) {
            return true;
        }
        let lead: &'static str = match lead {
            "=" => "=",
            "to" => "to",
            _ => "step",
        };
        if !self.more() {
            self.wants.push(Want::Lead(lead));
            self.stopped = needed;
            return false;
        }
        let found = if lead == "=" {
            self.datum(0) == Some(Datum::Sign(b'='))
        } else {
            self.word()
                .is_some_and(|word| word.eq_ignore_ascii_case(lead))
        };
        if found {
            self.at += 1;
            self.push(self.at - 1, What::Lead);
        }
        found
    }

    /// Whether `name =` stands here.
    fn is_named(&self) -> bool {
        self.word().is_some() && self.datum(1) == Some(Datum::Sign(b'='))
    }

    /// `name = value …`, to the end.
    fn named(&mut self, parameters: &[Param<'p>]) {
        while self.more() {
            if !self.is_named() {
                self.extra();
                continue;
            }
            let name = self.word().unwrap_or("");
            let index = parameters.iter().position(|p| p.name == name);
            self.parameter = index.map(|index| parameters[index]);
            self.index = index.unwrap_or(0);
            self.at += 1;
            self.push(self.at - 1, What::Named);
            self.at += 1;
            self.push(self.at - 1, What::Lead);
            let Some(index) = index else { continue };
            if self.more() {
                self.operand(&parameters[index]);
            } else {
                self.want(0);
                self.stopped = true;
            }
            if self.stopped {
                return;
            }
        }
    }

    fn options(&mut self, options: &'static [OptionSpec]) {
        if options.is_empty() {
            return;
        }
        while !self.stopped {
            if !self.more() {
                self.wants.push(Want::Options(options));
                return;
            }
            let start = self.at;
            let Some(option) = self.option_here(options) else {
                self.extra();
                continue;
            };
            self.parameter = None;
            self.option = Some(option);
            self.push(start, What::Option);
            let parameters: Vec<Param<'_>> = option.parameters.iter().map(Param::from).collect();
            self.parameters(&parameters, options, false);
            self.option = None;
        }
    }

    /// Takes an option's word, whole or its beginning.
    fn option_here(&mut self, options: &'static [OptionSpec]) -> Option<&'static OptionSpec> {
        if let (Some(Datum::Sign(sign)), Some(Datum::Sign(b'='))) = (self.datum(0), self.datum(1)) {
            let spelled = [sign, b'='];
            let option = options.iter().find(|o| o.name.as_bytes() == spelled)?;
            self.at += 2;
            return Some(option);
        }
        let start = self.at;
        self.word()?;
        self.name();
        let word = self.span(start);
        let found = find_option(options, word);
        if found.is_none() {
            self.at = start;
        }
        found
    }

    /// The text from an item to the one before this.
    fn span(&self, start: usize) -> &'p str {
        match self.items.get(start..self.at) {
            Some([first, .., last]) => &self.text[first.start as usize..last.end as usize],
            Some([one]) => &self.text[one.span()],
            _ => "",
        }
    }

    fn is_option_next(&self, options: &[OptionSpec]) -> bool {
        if let (Some(Datum::Sign(b'+' | b'*')), Some(Datum::Sign(b'='))) =
            (self.datum(0), self.datum(1))
        {
            return true;
        }
        self.word().is_some_and(|word| is_beginning(options, word))
    }

    fn is_number_next(&self, options: &[OptionSpec]) -> bool {
        match self.datum(0) {
            Some(Datum::Number(_)) => true,
            Some(Datum::Sign(b'-' | b'+' | b'(')) => !self.is_option_next(&[]),
            Some(Datum::Word(_)) => {
                let word = self.word().unwrap_or("");
                !is_beginning(options, word) && (self.types)(word) == Some(Type::Number)
            }
            _ => false,
        }
    }

    /// As [`crate::reader::Reader`] decides it.
    fn goes_on(&self, parameter: &Param<'p>, options: &'static [OptionSpec]) -> bool {
        match parameter.kind {
            Kind::Number { .. } | Kind::Whole { .. } => {
                let is_word = matches!(self.datum(0), Some(Datum::Word(_)));
                self.is_number_next(options) || (is_word && options.is_empty())
            }
            Kind::Word(words) => self.is_option_next(words),
            Kind::Copy(_) => self.datum(0) == Some(Datum::Sign(b'=')),
            Kind::Known(Names::Texture) => self.datum(0) == Some(Datum::Sign(b'+')),
            Kind::Block => false,
            _ => !self.is_option_next(options),
        }
    }

    fn operand(&mut self, parameter: &Param<'p>) {
        let start = self.at;
        match parameter.kind {
            Kind::Number { .. } | Kind::Whole { .. } => {
                self.value();
                self.push(start, What::Number(0));
            }
            Kind::Vector | Kind::Direction | Kind::Colour => self.triple(false),
            Kind::Share => self.triple(true),
            Kind::Value => self.any_value(),
            Kind::Switch => {
                self.at += 1;
                self.push(start, What::Other);
            }
            Kind::Word(words) => match self.option_here(words) {
                Some(word) => {
                    self.push(start, What::Word(word));
                    let inner: Vec<Param<'_>> = word.parameters.iter().map(Param::from).collect();
                    if !inner.is_empty() {
                        let outer = (self.parameter, self.index, self.option);
                        self.option = Some(word);
                        self.parameters(&inner, &[], false);
                        (self.parameter, self.index, self.option) = outer;
                    }
                }
                None => self.extra(),
            },
            Kind::Copy(of) => {
                self.at += 1;
                self.push(start, What::Lead);
                if self.more() {
                    self.name_of(of, false);
                } else {
                    self.want(1);
                    self.stopped = true;
                }
            }
            Kind::Known(of) => {
                if of == Names::Texture && self.datum(0) == Some(Datum::Sign(b'+')) {
                    self.at += 1;
                    self.push(start, What::Lead);
                    if !self.more() {
                        self.want(0);
                        self.stopped = true;
                        return;
                    }
                }
                self.name_of(of, false);
            }
            Kind::New(of) => {
                self.name_of(of, true);
                if parameter.name.ends_with(" =") {
                    if !self.more() {
                        self.wants.push(Want::Lead("="));
                        self.stopped = true;
                    } else if self.datum(0) == Some(Datum::Sign(b'=')) {
                        self.at += 1;
                        self.push(self.at - 1, What::Lead);
                    }
                }
            }
            Kind::File | Kind::NewFile => {
                self.glued(|datum| !matches!(datum, Datum::Sign(b',' | b'<' | b'>')));
                self.push(start, What::File);
            }
            Kind::Text => {
                self.at = self.items.len();
                self.push(start, What::Other);
            }
            Kind::Condition => {
                (self.listed, self.comparing) = (false, true);
                self.value();
                (self.listed, self.comparing) = (true, false);
                self.push(start, What::Other);
            }
            Kind::Method => self.method(),
            Kind::Block => {}
        }
    }

    fn name_of(&mut self, of: Names, is_new: bool) {
        let start = self.at;
        if self.name() {
            self.push(start, What::Name { of, is_new });
        } else {
            self.extra();
        }
    }

    /// Takes a name; signs that are not separated from it belong to it.
    fn name(&mut self) -> bool {
        self.glued(|datum| matches!(datum, Datum::Sign(b'^')))
    }

    fn glued(&mut self, sign: fn(Datum) -> bool) -> bool {
        let part = |datum| matches!(datum, Datum::Word(_) | Datum::Number(_)) || sign(datum);
        if !self.datum(0).is_some_and(part) {
            return false;
        }
        self.at += 1;
        while self
            .items
            .get(self.at)
            .is_some_and(|item| !item.spaced && part(item.datum))
        {
            self.at += 1;
        }
        true
    }

    /// Three numbers, a triple, or `N%`.
    fn triple(&mut self, share: bool) {
        let start = self.at;
        match self.value() {
            Type::Number => {
                let percent = self
                    .items
                    .get(self.at)
                    .is_some_and(|item| item.datum == Datum::Sign(b'%') && !item.spaced);
                if share && percent {
                    self.at += 1;
                    return self.push(start, What::Number(0));
                }
                self.push(start, What::Number(0));
                self.second_and_third();
            }
            _ => self.push(start, What::Triple),
        }
    }

    fn second_and_third(&mut self) {
        for part in 1..3 {
            if self.stopped {
                return;
            }
            if !self.more() {
                self.want(part);
                self.stopped = true;
                return;
            }
            let start = self.at;
            self.value();
            if self.at == start {
                return;
            }
            self.push(start, What::Number(part));
        }
    }

    /// The value of a variable.
    fn any_value(&mut self) {
        let start = self.at;
        let first = self.value();
        if first != Type::Number {
            return self.push(start, What::Triple);
        }
        self.push(start, What::Number(0));
        let goes_on = self.more()
            && match self.datum(0) {
                Some(Datum::Number(_) | Datum::Sign(b'-' | b'(')) => true,
                Some(Datum::Sign(b'+')) => self.datum(1) != Some(Datum::Sign(b'=')),
                Some(Datum::Word(_)) => !self.is_option_next(options::VAR),
                _ => false,
            };
        if goes_on {
            self.second_and_third();
        } else if self.at >= self.items.len() {
            self.want(1);
        }
    }

    /// A solid, two waves, an image or a colour.
    fn method(&mut self) {
        let start = self.at;
        let exact = |list: &'static [OptionSpec], word: &str| {
            list.iter().find(|o| o.name.eq_ignore_ascii_case(word))
        };
        if self.word().is_some() {
            self.name();
            let word = self.span(start);
            if let Some(wave) = exact(options::WAVES, word) {
                self.push(start, What::Word(wave));
                if !self.more() {
                    self.want(1);
                    self.stopped = true;
                    return;
                }
                let second = self.at;
                if self.name()
                    && let Some(wave) = exact(options::WAVES, self.span(second))
                {
                    return self.push(second, What::Word(wave));
                }
                self.at = second;
                return self.extra();
            }
            if let Some(solid) = exact(options::SOLIDS, word) {
                return self.push(start, What::Word(solid));
            }
            self.at = start;
            self.glued(|datum| !matches!(datum, Datum::Sign(b',' | b'<' | b'>')));
            let end = self.at;
            if self.more()
                && let Some(how) = self.word()
                && ["plain", "region"]
                    .iter()
                    .any(|w| w.eq_ignore_ascii_case(how))
            {
                let how_at = self.at;
                self.at = end;
                self.push(start, What::File);
                self.at = how_at + 1;
                self.push(how_at, What::Lead);
                if how.eq_ignore_ascii_case("region") {
                    for _ in 0..6 {
                        if self.more() && !self.stopped {
                            self.triple(false);
                        }
                    }
                }
                return;
            }
            self.at = start;
        }
        self.triple(false);
    }

    /// An expression; its kind. Takes one item at least, if there is one.
    fn value(&mut self) -> Type {
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
    fn operator(&self) -> Option<(u8, usize)> {
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

const NOT: u8 = 3;
const COMPARE: u8 = 4;
const TIMES: u8 = 6;
const SIGN: u8 = 7;
const POWER: u8 = 8;

/// The kind of two values that are joined.
fn joined(left: Type, right: Type, strength: u8) -> Type {
    match (left, right) {
        _ if strength <= COMPARE => Type::Number,
        (Type::Triple, _) | (_, Type::Triple) => Type::Triple,
        (Type::Number, Type::Number) => Type::Number,
        _ => Type::Any,
    }
}

/// Whether a word is one of these options or the beginning of one.
fn is_beginning(options: &[OptionSpec], word: &str) -> bool {
    options.iter().any(|option| option.begins(word))
}

/// The option that a word names, whole or by a beginning that fits one only.
pub fn find_option(options: &'static [OptionSpec], word: &str) -> Option<&'static OptionSpec> {
    if let Some(exact) = options.iter().find(|o| o.name.eq_ignore_ascii_case(word)) {
        return Some(exact);
    }
    let mut fitting = options.iter().filter(|option| option.begins(word));
    fitting.next().filter(|_| fitting.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assist::Index;
    use crate::assist::walk;
    use crate::parser::parse;
    use crate::symbol::Symbols;
    use crate::{File, Project, commands, compile, library};

    /// The operands of a text's commands that the static reader has no use for.
    fn extras(text: &str) -> Vec<String> {
        let project = Project {
            files: vec![File {
                name: String::from("main.rat"),
                text: text.to_owned(),
            }],
        };
        let mut symbols = Symbols::default();
        let syntax = parse(text, &mut symbols);
        let mut starts = Vec::new();
        walk::commands(&syntax.block, &mut |command| {
            starts.push(command.word_span.start);
        });
        let mut extras = Vec::new();
        for start in starts {
            let index = Index::at(&project, Some((0, start)));
            let here = index.here.expect("a command");
            // The head of `define` is read by the parser; what is unknown is not run.
            let is_known = here.spec.is_some() || here.own.is_some();
            if here.word == "define" || !is_known {
                continue;
            }
            for (span, slot) in here.operands {
                let missing = slot.parameter.is_none() && slot.option.is_none();
                if matches!(slot.what, What::Extra) || missing {
                    extras.push(format!("{}: {}", here.word, &text[span]));
                }
            }
        }
        extras
    }

    /// The static reader reads what the evaluator reads: where there is no error, every operand has
    /// its use.
    #[test]
    fn every_operand_has_a_use() {
        let mut texts: Vec<String> = commands::all()
            .map(|spec| spec.example.to_owned())
            .collect();
        texts.extend(library::FILES.iter().map(|(_, text)| (*text).to_owned()));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
        for entry in std::fs::read_dir(folder).expect("the examples") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|ending| ending == "rat") {
                let text = std::fs::read_to_string(path).expect("a text");
                if text.len() < 10_000 {
                    texts.push(text);
                }
            }
        }
        let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/diagnostics");
        for entry in std::fs::read_dir(corpus).expect("the corpus") {
            let text = std::fs::read_to_string(entry.expect("an entry").path()).expect("a text");
            for section in text.split("\n### ") {
                let body = section.split_once('\n').map_or("", |(_, body)| body);
                if !body.contains("#! error") && !body.contains("#file ") {
                    texts.push(body.to_owned());
                }
            }
        }
        assert!(texts.len() > 150, "only {} texts", texts.len());
        let mut found = Vec::new();
        for text in texts {
            let project = Project {
                files: vec![File {
                    name: String::from("main.rat"),
                    text: text.clone(),
                }],
            };
            let errors = compile(&project).diagnostics;
            if errors.iter().all(|d| d.severity != crate::Severity::Error) {
                found.extend(extras(&text));
            }
        }
        assert!(found.is_empty(), "{found:#?}");
    }
}
