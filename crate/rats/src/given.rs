//! Reads a command's operands as the table says, and keeps where each one stands.
//!
//! [`Reader::read_given`] goes through the parameters of a command, then through its options; so
//! the table is the one place that knows what a command takes. From the operands it takes the
//! values of the types in its [`Slot`]s. The few commands with a form of their own (`var`, the
//! method of a `texture`) read their own part with the functions of [`crate::reader`].

use crate::commands::slot::{Backdrop, Choice, Named, Placed, Slot, Text, Word};
use crate::commands::{Arity, Kind, Names, OptionSpec, Parameter};
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::suggest;
use crate::syntax::Datum;
use glam::DVec3;
use scene::Rgb;
use std::ops::Range;

/// Operand as it was read.
#[derive(Clone, Debug)]
pub enum Operand<'a> {
    /// A number.
    Number(f64),
    /// A vector: three numbers.
    Triple(DVec3),
    /// A colour.
    Colour(Rgb),
    /// A colour or a share of one.
    Share(Share),
    /// `on` or `off`.
    Switch(bool),
    /// A word of the table.
    Word(&'static OptionSpec),
    /// A name.
    Name(Name<'a>),
    /// Text, of which only the place is kept.
    Text,
}

/// An operand, the parameter it fills and its place.
#[derive(Clone, Debug)]
pub struct Filled<'a> {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// The parameter's index among those of the command or option.
    pub index: usize,
    /// The value.
    pub operand: Operand<'a>,
    /// The place.
    pub span: Range<usize>,
}

/// An option with its operands.
#[derive(Clone, Debug)]
pub struct Chosen<'a> {
    /// The option.
    pub option: &'static OptionSpec,
    /// The place of its word.
    pub span: Range<usize>,
    /// The operands in the order of the text.
    pub operands: Vec<Filled<'a>>,
}

impl<'a> Chosen<'a> {
    /// Returns the values of its operands.
    pub fn values(&self) -> Operands<'_, 'a> {
        Operands::new(&self.operands)
    }
}

impl<K: Values> Choice<K> {
    /// Returns the operands of an option that was given, if it is this one.
    pub fn of<'a>(&self, chosen: &Chosen<'a>) -> Option<K::Of<'a>> {
        if self.is(chosen) {
            chosen.values().next::<K>()
        } else {
            None
        }
    }

    /// Returns whether this is the option that was given.
    pub fn is(&self, chosen: &Chosen<'_>) -> bool {
        chosen.option.name == self.plain.name
    }
}

/// The options of a command in the order of the text.
#[derive(Clone, Debug, Default)]
pub struct Options<'a>(pub Vec<Chosen<'a>>);

impl<'a> Options<'a> {
    /// Returns the options in the order of the text.
    pub fn iter(&self) -> std::slice::Iter<'_, Chosen<'a>> {
        self.0.iter()
    }

    /// Finds the last option of this kind.
    pub fn find<K: Values>(&self, choice: &Choice<K>) -> Option<&Chosen<'a>> {
        self.0.iter().rev().find(|chosen| choice.is(chosen))
    }

    /// Returns whether an option of this kind was given.
    pub fn has<K: Values>(&self, choice: &Choice<K>) -> bool {
        self.find(choice).is_some()
    }

    /// Returns the operands of the last option of this kind.
    pub fn last<K: Values>(&self, choice: &Choice<K>) -> Option<K::Of<'a>> {
        choice.of(self.find(choice)?)
    }

    /// Returns the operands of all options of this kind.
    pub fn all<K: Values>(&self, choice: &Choice<K>) -> impl Iterator<Item = K::Of<'a>> {
        self.0.iter().filter_map(|chosen| choice.of(chosen))
    }
}

/// Operands and options of a command.
#[derive(Clone, Debug, Default)]
pub struct Given<'a> {
    /// The operands in the order of the text.
    pub filled: Vec<Filled<'a>>,
    /// The options.
    pub options: Options<'a>,
    /// The place of the command.
    pub span: Range<usize>,
}

impl<'a> Given<'a> {
    /// Returns the values of the operands.
    pub fn operands(&self) -> Operands<'_, 'a> {
        Operands::new(&self.filled)
    }

    /// Returns the values of the operands for a row of the table.
    pub fn values(&self) -> Taken<'_, 'a> {
        Taken {
            operands: self.operands(),
            span: &self.span,
        }
    }
}

/// The operands of a command, of which a row of the table takes one value after the other.
pub struct Taken<'g, 'a> {
    operands: Operands<'g, 'a>,
    span: &'g Range<usize>,
}

impl<'a> Taken<'_, 'a> {
    /// Takes the value of the next slot.
    ///
    /// # Errors
    /// If it was not read: a slot that is not in the row.
    pub fn take<K: Values>(&mut self, _slot: fn() -> Slot<K>) -> Outcome<K::Of<'a>> {
        let value = self.operands.next::<K>();
        value.ok_or_else(|| Problem::new(self.span, "expected another operand"))
    }
}

/// Operands of a command or option whose values are still to be taken.
#[derive(Clone, Debug)]
pub struct Operands<'g, 'a> {
    rest: &'g [Filled<'a>],
    /// The index of the next parameter.
    index: usize,
}

impl<'g, 'a> Operands<'g, 'a> {
    fn new(filled: &'g [Filled<'a>]) -> Self {
        Self {
            rest: filled,
            index: 0,
        }
    }

    /// Takes the value of the next parameter, or of the next ones; `None` if it is none of this
    /// type.
    pub fn next<K: Values>(&mut self) -> Option<K::Of<'a>> {
        K::take(self)
    }

    /// Takes the next operand if it belongs to the present parameter.
    fn operand(&mut self) -> Option<&'g Filled<'a>> {
        let (first, rest) = self.rest.split_first()?;
        (first.index == self.index).then(|| {
            self.rest = rest;
            first
        })
    }
}

/// Type of a single operand.
pub trait One {
    /// The values.
    type Of<'a>;
    /// Returns the value of an operand; `None` if it has another type.
    fn of<'a>(filled: &Filled<'a>) -> Option<Self::Of<'a>>;
}

macro_rules! one {
    ($kind:ty, $of:ty, $pattern:pat => $value:expr) => {
        impl One for $kind {
            type Of<'a> = $of;
            fn of<'a>(filled: &Filled<'a>) -> Option<$of> {
                match &filled.operand {
                    $pattern => Some($value),
                    _ => None,
                }
            }
        }
    };
}
one!(f64, f64, Operand::Number(number) => *number);
one!(u32, u32, Operand::Number(number) => *number as u32);
one!(DVec3, DVec3, Operand::Triple(triple) => *triple);
one!(Rgb, Rgb, Operand::Colour(colour) => *colour);
one!(Share, Share, Operand::Share(share) => *share);
one!(bool, bool, Operand::Switch(is_on) => *is_on);
one!(Word, &'static str, Operand::Word(word) => word.name);
one!(Named, Name<'a>, Operand::Name(name) => name.clone());

impl One for Text {
    type Of<'a> = Range<usize>;
    fn of<'a>(filled: &Filled<'a>) -> Option<Range<usize>> {
        matches!(filled.operand, Operand::Text).then(|| filled.span.clone())
    }
}

/// The background that a text names.
#[derive(Clone, Debug)]
pub enum Behind<'a> {
    /// A colour.
    Colour(Rgb),
    /// An image of the project.
    Image(Name<'a>),
}

impl One for Backdrop {
    type Of<'a> = Behind<'a>;
    fn of<'a>(filled: &Filled<'a>) -> Option<Behind<'a>> {
        match &filled.operand {
            Operand::Colour(colour) => Some(Behind::Colour(*colour)),
            Operand::Name(name) => Some(Behind::Image(name.clone())),
            _ => None,
        }
    }
}

impl<K: One> One for Placed<K> {
    type Of<'a> = (K::Of<'a>, Range<usize>);
    fn of<'a>(filled: &Filled<'a>) -> Option<Self::Of<'a>> {
        Some((K::of(filled)?, filled.span.clone()))
    }
}

/// Type of one parameter or of several.
pub trait Values {
    /// The values.
    type Of<'a>;
    /// Takes the value of the next parameter or the next ones; `None` if an operand has another
    /// type.
    fn take<'a>(from: &mut Operands<'_, 'a>) -> Option<Self::Of<'a>>;
}

impl<K: One> Values for K {
    type Of<'a> = K::Of<'a>;
    fn take<'a>(from: &mut Operands<'_, 'a>) -> Option<K::Of<'a>> {
        let filled = from.operand();
        from.index += 1;
        K::of(filled?)
    }
}

impl<K: One> Values for Option<K> {
    type Of<'a> = Option<K::Of<'a>>;
    fn take<'a>(from: &mut Operands<'_, 'a>) -> Option<Self::Of<'a>> {
        let filled = from.operand();
        from.index += 1;
        match filled {
            Some(filled) => K::of(filled).map(Some),
            None => Some(None),
        }
    }
}

impl<K: One> Values for Vec<K> {
    type Of<'a> = Vec<K::Of<'a>>;
    fn take<'a>(from: &mut Operands<'_, 'a>) -> Option<Self::Of<'a>> {
        let mut values = Vec::new();
        while let Some(filled) = from.operand() {
            values.push(K::of(filled)?);
        }
        from.index += 1;
        Some(values)
    }
}

impl Values for () {
    type Of<'a> = ();
    fn take<'a>(_: &mut Operands<'_, 'a>) -> Option<()> {
        Some(())
    }
}

impl<A: Values, B: Values> Values for (A, B) {
    type Of<'a> = (A::Of<'a>, B::Of<'a>);
    fn take<'a>(from: &mut Operands<'_, 'a>) -> Option<Self::Of<'a>> {
        Some((A::take(from)?, B::take(from)?))
    }
}

impl<A: Values, B: Values, C: Values> Values for (A, B, C) {
    type Of<'a> = (A::Of<'a>, B::Of<'a>, C::Of<'a>);
    fn take<'a>(from: &mut Operands<'_, 'a>) -> Option<Self::Of<'a>> {
        Some((A::take(from)?, B::take(from)?, C::take(from)?))
    }
}

/// Refuses a node's name that is a word of the block: in a `curve` it would begin another option.
fn refuse_option(name: &Name<'_>, options: &'static [OptionSpec]) -> Outcome<()> {
    let same = options
        .iter()
        .find(|option| option.name.eq_ignore_ascii_case(name.text));
    let Some(option) = same else {
        return Ok(());
    };
    let message = format!("a node cannot be called `{}`", name.text);
    let hint = format!("`{}` is a word of this command: add a digit", option.name);
    Err(Problem::new(&name.span, message).hint(hint))
}

impl<'a> Reader<'_, 'a> {
    /// Reads the operands and options of a command, to its end. In a chain, `chain` fills the first
    /// parameter.
    ///
    /// # Errors
    /// If one is missing, of the wrong kind or out of its range, or if something is left.
    pub fn read_given(
        &mut self,
        parameters: &'static [Parameter],
        options: &'static [OptionSpec],
        chain: Option<Name<'a>>,
    ) -> Outcome<Given<'a>> {
        let span = self.command_span();
        // `collage columns 2 fn1 fn2`: options of a list of files may come first.
        let mut first = Vec::new();
        if let Some(Kind::File) = parameters.first().map(|parameter| parameter.kind) {
            while let Some((_, word)) = self.peek_word()
                && options.iter().any(|o| o.name.eq_ignore_ascii_case(word))
                && let Some((option, span)) = self.option(options)?
            {
                first.push(Chosen {
                    option,
                    span,
                    operands: self.operands(option.parameters, options)?,
                });
            }
        }
        let filled = match (chain, parameters) {
            (Some(name), [first, ..]) => {
                let span = name.span.clone();
                let mut filled = vec![Filled {
                    parameter: first,
                    index: 0,
                    operand: Operand::Name(name),
                    span,
                }];
                self.fill(&mut filled, parameters, options)?;
                filled
            }
            _ => self.operands(parameters, options)?,
        };
        first.extend(self.read_options(options)?);
        self.end()?;
        Ok(Given {
            filled,
            options: Options(first),
            span,
        })
    }

    /// Reads the operands of these parameters; `options` are the words that may follow.
    ///
    /// # Errors
    /// If one is missing, of the wrong kind or out of its range.
    pub fn operands(
        &mut self,
        parameters: &'static [Parameter],
        options: &'static [OptionSpec],
    ) -> Outcome<Vec<Filled<'a>>> {
        let mut filled = Vec::with_capacity(parameters.len());
        self.fill(&mut filled, parameters, options)?;
        Ok(filled)
    }

    /// Reads the operands of the parameters behind those that are filled.
    fn fill(
        &mut self,
        filled: &mut Vec<Filled<'a>>,
        parameters: &'static [Parameter],
        options: &'static [OptionSpec],
    ) -> Outcome<()> {
        for (index, parameter) in parameters.iter().enumerate().skip(filled.len()) {
            if matches!(parameter.kind, Kind::Block) {
                continue;
            }
            let mut first = true;
            loop {
                let needed = first && matches!(parameter.arity, Arity::One | Arity::Many);
                if !needed && !self.goes_on(parameter, options) {
                    break;
                }
                if !first {
                    self.scope.step(1, &self.here())?;
                }
                let start = self.start();
                let operand = self.operand_of(parameter)?;
                if let (Kind::New(Names::Node), Operand::Name(name)) = (parameter.kind, &operand) {
                    refuse_option(name, options)?;
                }
                filled.push(Filled {
                    parameter,
                    index,
                    operand,
                    span: self.since(start),
                });
                first = false;
                if matches!(parameter.arity, Arity::One | Arity::Optional) {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Reads the options to the end of the command. Without any in the table nothing is read.
    ///
    /// # Errors
    /// If there is something that is no option, or an option's operand is wrong.
    pub fn read_options(&mut self, options: &'static [OptionSpec]) -> Outcome<Vec<Chosen<'a>>> {
        let mut chosen = Vec::new();
        if options.is_empty() {
            return Ok(chosen);
        }
        while let Some((option, span)) = self.option(options)? {
            chosen.push(Chosen {
                option,
                span,
                operands: self.operands(option.parameters, options)?,
            });
        }
        Ok(chosen)
    }

    /// Returns whether another operand of this parameter follows.
    fn goes_on(&mut self, parameter: &Parameter, options: &'static [OptionSpec]) -> bool {
        if !self.more() {
            return false;
        }
        match parameter.kind {
            Kind::Number { .. } | Kind::Whole { .. } => self.is_number_next(options),
            Kind::Vector
            | Kind::Direction
            | Kind::Colour
            | Kind::Backdrop
            | Kind::Share
            | Kind::Value => !self.is_option_next(options),
            Kind::Word(words) => self.is_option_next(words),
            Kind::Copy(_) => self.datum() == Some(Datum::Sign(b'=')),
            Kind::Known(Names::Texture) => self.datum() == Some(Datum::Sign(b'+')),
            // Nodes and objects have short names, which are the beginnings of many words.
            Kind::Known(Names::Node | Names::Object) | Kind::New(Names::Object) => {
                !self.is_whole_option_next(options)
            }
            Kind::Block => false,
            _ => !self.is_option_next(options),
        }
    }

    /// Makes the problem that none of these words stands here.
    fn no_such_word(&mut self, words: &'static [OptionSpec], what: &str) -> Box<Problem> {
        let problem = self.missing(what);
        let names = words.iter().map(|word| word.name);
        let Some((_, found)) = self.peek_word() else {
            return problem;
        };
        let hint = suggest::hint(found, names.clone()).unwrap_or_else(|| {
            let names: Vec<_> = names.collect();
            format!("the choices are {}", names.join(", "))
        });
        problem.hint(hint)
    }

    /// Reads an operand of a parameter.
    fn operand_of(&mut self, parameter: &Parameter) -> Outcome<Operand<'a>> {
        let what = parameter.meaning;
        Ok(match parameter.kind {
            Kind::Number { low, high } => {
                Operand::Number(self.number_in(what, low, high, parameter.unit.word())?)
            }
            Kind::Whole { low, high } => Operand::Number(f64::from(self.whole(what, low, high)?)),
            Kind::Vector => Operand::Triple(self.vector(what)?),
            Kind::Direction => Operand::Triple(self.direction(what)?),
            Kind::Colour => Operand::Colour(self.colour(what)?),
            Kind::Share => Operand::Share(self.share(what)?),
            Kind::Switch => Operand::Switch(self.on_off()?),
            Kind::Word(words) => {
                if !self.is_option_next(words) {
                    return Err(self.no_such_word(words, what));
                }
                let Some((word, _)) = self.option(words)? else {
                    return Err(self.missing(what));
                };
                self.operands(word.parameters, &[])?;
                Operand::Word(word)
            }
            Kind::Copy(_) => {
                if !self.sign(b'=') {
                    return Err(self.missing("`=`"));
                }
                Operand::Name(self.old_name(what)?)
            }
            Kind::Known(Names::Texture) => {
                self.sign(b'+');
                Operand::Name(self.old_name(what)?)
            }
            Kind::Known(_) => Operand::Name(self.old_name(what)?),
            Kind::New(_) => Operand::Name(self.new_name(what)?),
            Kind::File | Kind::NewFile => Operand::Name(self.file_name(what)?),
            Kind::Backdrop => match self.image_name() {
                Some(name) => Operand::Name(name),
                None => Operand::Colour(self.colour(what)?),
            },
            Kind::Text => {
                self.at = self.items.len();
                Operand::Text
            }
            // The commands that take these read them themselves.
            Kind::Value | Kind::Condition | Kind::Method | Kind::Block => {
                return Err(Problem::new(&self.here(), format!("expected {what}")));
            }
        })
    }
}
