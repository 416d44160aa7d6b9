//! Operands of each kind of parameter.

use super::cursor::{Slots, Type, Want, What, is_beginning};
use crate::grammar::Param;
use rats::commands::{Arity, Kind, Names, OptionSpec, options};
use rats::syntax::Datum;

impl<'p> Slots<'_, 'p> {
    pub(super) fn parameters(
        &mut self,
        parameters: &[Param<'p>],
        options: &'static [OptionSpec],
        named: bool,
    ) {
        for (index, parameter) in parameters.iter().enumerate() {
            // Layers of other textures are a target without a method.
            let is_layers = matches!(parameter.kind, Kind::Method)
                && self.slots.last().is_some_and(|slot| slot.option.is_some());
            if matches!(parameter.kind, Kind::Block) || is_layers {
                continue;
            }
            if named && self.more() && self.is_named() {
                return self.arguments(parameters);
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
            // A copy needs no description.
            let is_copy = matches!(parameter.kind, Kind::Copy(_)) && !first;
            if self.stopped || is_copy {
                return;
            }
        }
    }

    /// Takes the word or sign that goes before a parameter (`to b`); returns whether the parameter
    /// follows.
    pub(super) fn lead(&mut self, parameter: &Param<'p>, needed: bool) -> bool {
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

    /// Returns whether `name =` stands here.
    pub(super) fn is_named(&self) -> bool {
        self.word().is_some() && self.datum(1) == Some(Datum::Sign(b'='))
    }

    /// Reads `name = value …`, to the end.
    pub(super) fn arguments(&mut self, parameters: &[Param<'p>]) {
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

    pub(super) fn is_number_next(&self, options: &[OptionSpec]) -> bool {
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

    /// Returns whether another operand of the parameter follows, as the reader of `rats` decides
    /// it.
    pub(super) fn goes_on(&self, parameter: &Param<'p>, options: &'static [OptionSpec]) -> bool {
        match parameter.kind {
            Kind::Number { .. } | Kind::Whole { .. } => {
                let is_word = matches!(self.datum(0), Some(Datum::Word(_)));
                self.is_number_next(options) || (is_word && options.is_empty())
            }
            Kind::Word(words) => self.is_option_next(words),
            Kind::Copy(_) => self.datum(0) == Some(Datum::Sign(b'=')),
            Kind::Known(Names::Texture) => self.datum(0) == Some(Datum::Sign(b'+')),
            Kind::Known(Names::Node | Names::Object) => {
                let word = self.word().unwrap_or("");
                !options.iter().any(|o| o.name.eq_ignore_ascii_case(word))
            }
            Kind::Block => false,
            _ => !self.is_option_next(options),
        }
    }

    pub(super) fn operand(&mut self, parameter: &Param<'p>) {
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
                self.glue(|datum| !matches!(datum, Datum::Sign(b',' | b'<' | b'>')));
                self.push(start, What::File);
            }
            Kind::Backdrop => {
                if self.word().is_some() {
                    self.glue(|datum| !matches!(datum, Datum::Sign(b',' | b'<' | b'>')));
                    if rats::is_image(self.span(start)) {
                        return self.push(start, What::File);
                    }
                    self.at = start;
                }
                self.triple(false);
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

    /// Reads three numbers, a triple, or `N%`.
    pub(super) fn triple(&mut self, share: bool) {
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

    pub(super) fn second_and_third(&mut self) {
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

    /// Reads the value of a variable.
    pub(super) fn any_value(&mut self) {
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
                Some(Datum::Word(_)) => {
                    let ends = match self.option {
                        Some(_) => options::PRESET_OPTIONS,
                        None => options::VAR_OPTIONS,
                    };
                    !self.is_option_next(ends)
                }
                _ => false,
            };
        if goes_on {
            self.second_and_third();
        } else if self.at >= self.items.len() {
            self.want(1);
        }
    }

    /// A solid, two waves, an image or a colour.
    pub(super) fn method(&mut self) {
        let start = self.at;
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
            self.glue(|datum| !matches!(datum, Datum::Sign(b',' | b'<' | b'>')));
            let end = self.at;
            if self.more()
                && let Some(how) = self.word().and_then(|word| exact(options::MAPPINGS, word))
            {
                let how_at = self.at;
                self.at = end;
                self.push(start, What::File);
                self.at = how_at + 1;
                self.push(how_at, What::Word(how));
                for _ in how.parameters {
                    if self.more() && !self.stopped {
                        self.triple(false);
                    }
                }
                return;
            }
            if rats::is_image(
                &self.text[self.items[start].span().start..self.items[end - 1].span().end],
            ) {
                self.at = end;
                self.push(start, What::File);
                self.want(2);
                self.stopped = true;
                return;
            }
            self.at = start;
        }
        self.triple(false);
    }
}

/// Finds the option of a list that a word names in full, in any case.
fn exact(list: &'static [OptionSpec], word: &str) -> Option<&'static OptionSpec> {
    list.iter().find(|o| o.name.eq_ignore_ascii_case(word))
}
