//! Operands and their uses, and a cursor over the operands of a command.

use crate::grammar::Param;
use rats::commands::{Names, OptionSpec};
use rats::syntax::{Datum, Item};
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
    /// Unknown.
    Any,
}

/// Uses of an operand.
#[derive(Clone, Copy, Debug)]
pub enum What {
    /// An option's word.
    Option,
    /// A word that a parameter allows.
    Word(&'static OptionSpec),
    /// A name.
    Name {
        /// The kind of thing that has it.
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
    /// An operand that the command has no use for.
    Extra,
}

/// An operand and what it is for.
#[derive(Clone, Debug)]
pub struct Slot<'p> {
    /// The operand's items, as indices of the command's.
    pub items: Range<usize>,
    /// The use.
    pub what: What,
    /// The parameter it is for.
    pub parameter: Option<Param<'p>>,
    /// The parameter's index among those of its command or option.
    pub index: usize,
    /// The option that the parameter belongs to.
    pub option: Option<&'static OptionSpec>,
}

/// Something that could come next.
#[derive(Clone, Copy, Debug)]
pub enum Want<'p> {
    /// An operand for a parameter; of a triple number `part`.
    Parameter {
        /// The parameter.
        parameter: Param<'p>,
        /// The index of the parameter.
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
    /// A word or sign that leads on.
    Lead(&'static str),
}

/// Reads operands.
pub struct Slots<'i, 'p> {
    /// The command's operands.
    pub(super) items: &'i [Item],
    pub(super) text: &'p str,
    pub(super) types: &'i dyn Fn(&str) -> Option<Type>,
    pub(super) at: usize,
    pub(super) listed: bool,
    pub(super) comparing: bool,
    pub(super) depth: usize,
    /// Whether something is missing that must be there.
    pub(super) stopped: bool,
    pub(super) parameter: Option<Param<'p>>,
    pub(super) index: usize,
    pub(super) option: Option<&'static OptionSpec>,
    /// The operands with their uses.
    pub slots: Vec<Slot<'p>>,
    /// The items that are words in expressions and no functions.
    pub words: Vec<usize>,
    /// The operands and words that could come next where the operands end.
    pub wants: Vec<Want<'p>>,
}

impl<'i, 'p> Slots<'i, 'p> {
    pub(super) fn new(
        items: &'i [Item],
        text: &'p str,
        types: &'i dyn Fn(&str) -> Option<Type>,
    ) -> Self {
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

    pub(super) fn more(&mut self) -> bool {
        while let Some(Datum::Sign(b',' | b'<' | b'>')) = self.datum(0) {
            self.at += 1;
        }
        self.at < self.items.len()
    }

    pub(super) fn datum(&self, ahead: usize) -> Option<Datum> {
        self.items.get(self.at + ahead).map(|item| item.datum)
    }

    pub(super) fn word(&self) -> Option<&'p str> {
        match self.datum(0) {
            Some(Datum::Word(_)) => Some(&self.text[self.items[self.at].span()]),
            _ => None,
        }
    }

    pub(super) fn push(&mut self, start: usize, what: What) {
        self.slots.push(Slot {
            items: start..self.at,
            what,
            parameter: self.parameter,
            index: self.index,
            option: self.option,
        });
    }

    pub(super) fn extra(&mut self) {
        let start = self.at;
        self.parameter = None;
        if let Some(Datum::Word(_)) = self.datum(0) {
            self.words.push(self.at);
        }
        self.at += 1;
        self.push(start, What::Extra);
    }

    /// Notes that the operands end where the parameter could come.
    pub(super) fn want(&mut self, part: u8) {
        if let Some(parameter) = self.parameter {
            self.wants.push(Want::Parameter {
                parameter,
                index: self.index,
                option: self.option,
                part,
            });
        }
    }

    /// Returns the text from an item to the one before this.
    pub(super) fn span(&self, start: usize) -> &'p str {
        match self.items.get(start..self.at) {
            Some([first, .., last]) => &self.text[first.start as usize..last.end as usize],
            Some([one]) => &self.text[one.span()],
            _ => "",
        }
    }

    pub(super) fn name_of(&mut self, of: Names, is_new: bool) {
        let start = self.at;
        if self.name() {
            self.push(start, What::Name { of, is_new });
        } else {
            self.extra();
        }
    }

    /// Takes a name; signs that are not separated from it belong to it.
    pub(super) fn name(&mut self) -> bool {
        self.glue(|datum| matches!(datum, Datum::Sign(b'^')))
    }

    pub(super) fn glue(&mut self, sign: fn(Datum) -> bool) -> bool {
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

    pub(super) fn is_option_next(&self, options: &[OptionSpec]) -> bool {
        if let (Some(Datum::Sign(b'+' | b'*')), Some(Datum::Sign(b'='))) =
            (self.datum(0), self.datum(1))
        {
            return true;
        }
        self.word().is_some_and(|word| is_beginning(options, word))
    }

    /// Takes an option's word, whole or its beginning.
    pub(super) fn option_here(
        &mut self,
        options: &'static [OptionSpec],
    ) -> Option<&'static OptionSpec> {
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
}

/// Returns whether a word is one of these options or the beginning of one.
pub fn is_beginning(options: &[OptionSpec], word: &str) -> bool {
    options.iter().any(|option| option.begins(word))
}

/// Finds the option that a word names, whole or by a beginning that fits one only.
fn find_option(options: &'static [OptionSpec], word: &str) -> Option<&'static OptionSpec> {
    if let Some(exact) = options.iter().find(|o| o.name.eq_ignore_ascii_case(word)) {
        return Some(exact);
    }
    let mut fitting = options.iter().filter(|option| option.begins(word));
    fitting.next().filter(|_| fitting.next().is_none())
}
