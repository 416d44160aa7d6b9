//! Reads a command's operands as the table says, and keeps where each one stands.
//!
//! [`Reader::given`] goes through the parameters of a command, then through its options; so the table
//! is the one place that knows what a command takes. The few commands with a form of their own (`var`,
//! the method of a `texture`) read their own part with the functions of [`crate::reader`].

use crate::commands::{Arity, Kind, Names, OptionSpec, Parameter};
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::suggest;
use crate::syntax::Datum;
use glam::DVec3;
use std::ops::Range;

/// One operand as it was read.
#[derive(Clone, Debug)]
pub enum Operand<'a> {
    /// A number.
    Number(f64),
    /// Three numbers.
    Triple(DVec3),
    /// A colour.
    Colour([f32; 3]),
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
    pub parameter: &'static str,
    /// Its value.
    pub operand: Operand<'a>,
    /// Where.
    pub span: Range<usize>,
}

/// An option with its operands.
#[derive(Clone, Debug)]
pub struct Chosen<'a> {
    /// The option's whole name.
    pub name: &'static str,
    /// Where its word stands.
    pub span: Range<usize>,
    /// Its operands.
    pub given: Given<'a>,
}

/// All operands of a command or option.
#[derive(Clone, Debug, Default)]
pub struct Given<'a> {
    /// The operands in the order of the text.
    pub operands: Vec<Filled<'a>>,
    /// The options in the order of the text.
    pub options: Vec<Chosen<'a>>,
}

impl<'a> Given<'a> {
    /// The operands of a parameter.
    fn all(&self, parameter: &'static str) -> impl Iterator<Item = &Filled<'a>> {
        self.operands
            .iter()
            .filter(move |filled| filled.parameter == parameter)
    }

    fn one(&self, parameter: &'static str) -> Option<&Operand<'a>> {
        self.all(parameter).next().map(|filled| &filled.operand)
    }

    /// Where a parameter's first operand stands.
    pub fn span(&self, parameter: &'static str) -> Option<Range<usize>> {
        self.all(parameter).next().map(|filled| filled.span.clone())
    }

    /// A number that may have been left out.
    pub fn maybe_number(&self, parameter: &'static str) -> Option<f64> {
        match self.one(parameter) {
            Some(Operand::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// A number, which the table demands.
    pub fn number(&self, parameter: &'static str) -> f64 {
        self.maybe_number(parameter)
            .expect("the table demands this number")
    }

    /// All numbers of a parameter.
    pub fn numbers(&self, parameter: &'static str) -> Vec<f64> {
        self.all(parameter)
            .filter_map(|filled| match filled.operand {
                Operand::Number(number) => Some(number),
                _ => None,
            })
            .collect()
    }

    /// All triples of a parameter.
    pub fn vectors(&self, parameter: &'static str) -> Vec<DVec3> {
        self.all(parameter)
            .filter_map(|filled| match filled.operand {
                Operand::Triple(vector) => Some(vector),
                _ => None,
            })
            .collect()
    }

    /// A triple, which the table demands.
    pub fn vector(&self, parameter: &'static str) -> DVec3 {
        match self.one(parameter) {
            Some(Operand::Triple(vector)) => *vector,
            _ => unreachable!("the table demands the triple {parameter}"),
        }
    }

    /// A colour, which the table demands.
    pub fn colour(&self, parameter: &'static str) -> [f32; 3] {
        match self.one(parameter) {
            Some(Operand::Colour(colour)) => *colour,
            _ => unreachable!("the table demands the colour {parameter}"),
        }
    }

    /// A colour or share, which the table demands.
    pub fn share(&self) -> Share {
        match self.operands.first().map(|filled| &filled.operand) {
            Some(Operand::Share(share)) => *share,
            _ => unreachable!("the table demands a share"),
        }
    }

    /// `on` or `off`, which the table demands.
    pub fn switch(&self) -> bool {
        match self.operands.first().map(|filled| &filled.operand) {
            Some(Operand::Switch(on)) => *on,
            _ => unreachable!("the table demands `on` or `off`"),
        }
    }

    /// A word of the table that may have been left out.
    pub fn word(&self, parameter: &'static str) -> Option<&'static str> {
        match self.one(parameter) {
            Some(Operand::Word(word)) => Some(word.name),
            _ => None,
        }
    }

    /// All words of a parameter.
    pub fn words(&self, parameter: &'static str) -> Vec<(&'static str, Range<usize>)> {
        self.all(parameter)
            .filter_map(|filled| match filled.operand {
                Operand::Word(word) => Some((word.name, filled.span.clone())),
                _ => None,
            })
            .collect()
    }

    /// A name that may have been left out.
    pub fn maybe_name(&self, parameter: &'static str) -> Option<&Name<'a>> {
        match self.one(parameter) {
            Some(Operand::Name(name)) => Some(name),
            _ => None,
        }
    }

    /// A name, which the table demands.
    pub fn name(&self, parameter: &'static str) -> &Name<'a> {
        self.maybe_name(parameter)
            .expect("the table demands this name")
    }

    /// All names of a parameter.
    pub fn names(&self, parameter: &'static str) -> Vec<Name<'a>> {
        self.all(parameter)
            .filter_map(|filled| match &filled.operand {
                Operand::Name(name) => Some(name.clone()),
                _ => None,
            })
            .collect()
    }

    /// An option that was given, the last one if it was given twice.
    pub fn option(&self, name: &'static str) -> Option<&Chosen<'a>> {
        self.options.iter().rev().find(|chosen| chosen.name == name)
    }
}

/// Refuses a node's name that is a word of the block: in a `curve` it would begin another option.
fn refuse_option(name: &Name<'_>, options: &'static [OptionSpec]) -> Outcome<()> {
    let is_same = |option: &&OptionSpec| option.name.eq_ignore_ascii_case(name.text);
    let Some(option) = options.iter().find(is_same) else {
        return Ok(());
    };
    let message = format!("a node cannot be called `{}`", name.text);
    let hint = format!("`{}` is a word of this command: add a digit", option.name);
    Err(Problem::new(name.span.clone(), message).hint(hint))
}

impl<'a> Reader<'_, 'a> {
    /// All operands and options of a command, to its end.
    ///
    /// # Errors
    /// If one is missing, of the wrong kind or out of its range, or if something is left.
    pub fn given(
        &mut self,
        parameters: &'static [Parameter],
        options: &'static [OptionSpec],
    ) -> Outcome<Given<'a>> {
        // `collage columns 2 fn1 fn2`: options of a list of files may come first.
        let mut first = Vec::new();
        if let Some(Kind::File) = parameters.first().map(|parameter| parameter.kind) {
            while let Some((_, word)) = self.peek_word()
                && options.iter().any(|o| o.name.eq_ignore_ascii_case(word))
                && let Some((option, span)) = self.option(options)?
            {
                first.push(Chosen {
                    name: option.name,
                    span,
                    given: self.operands(option.parameters, options)?,
                });
            }
        }
        let mut given = self.operands(parameters, options)?;
        given.options = first;
        given.options.extend(self.chosen(options)?);
        self.end()?;
        Ok(given)
    }

    /// The operands of these parameters; `options` are the words that may follow.
    ///
    /// # Errors
    /// If one is missing, of the wrong kind or out of its range.
    pub fn operands(
        &mut self,
        parameters: &'static [Parameter],
        options: &'static [OptionSpec],
    ) -> Outcome<Given<'a>> {
        let mut given = Given {
            operands: Vec::with_capacity(parameters.len()),
            options: Vec::new(),
        };
        for parameter in parameters {
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
                given.operands.push(Filled {
                    parameter: parameter.name,
                    operand,
                    span: self.since(start),
                });
                first = false;
                if matches!(parameter.arity, Arity::One | Arity::Optional) {
                    break;
                }
            }
        }
        Ok(given)
    }

    /// The options to the end of the command. Without any in the table nothing is read.
    ///
    /// # Errors
    /// If there is something that is no option, or an option's operand is wrong.
    pub fn chosen(&mut self, options: &'static [OptionSpec]) -> Outcome<Vec<Chosen<'a>>> {
        let mut chosen = Vec::new();
        if options.is_empty() {
            return Ok(chosen);
        }
        while let Some((option, span)) = self.option(options)? {
            chosen.push(Chosen {
                name: option.name,
                span,
                given: self.operands(option.parameters, options)?,
            });
        }
        Ok(chosen)
    }

    /// Whether another operand of this parameter follows.
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
            Kind::Known(Names::Node | Names::Object) => !self.is_whole_option_next(options),
            Kind::Block => false,
            _ => !self.is_option_next(options),
        }
    }

    /// The problem that none of these words stands here.
    fn no_such_word(&mut self, words: &'static [OptionSpec], what: &str) -> Box<Problem> {
        let problem = self.expected(what);
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
                    return Err(self.expected(what));
                };
                self.operands(word.parameters, &[])?;
                Operand::Word(word)
            }
            Kind::Copy(_) => {
                if !self.sign(b'=') {
                    return Err(self.expected("`=`"));
                }
                Operand::Name(self.known_name(what)?)
            }
            Kind::Known(Names::Texture) => {
                self.sign(b'+');
                Operand::Name(self.known_name(what)?)
            }
            Kind::Known(_) => Operand::Name(self.known_name(what)?),
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
                return Err(Problem::new(self.here(), format!("expected {what}")));
            }
        })
    }
}
