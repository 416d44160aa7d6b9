//! The operands of commands: the kinds, units and ranges from which the reader checks them and
//! the manual, the hints of errors and the editor explain them.

use crate::limits::MAX_MAGNITUDE;

/// Kinds of values that a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number from `low` to `high`.
    Number {
        /// The least.
        low: f64,
        /// The largest.
        high: f64,
    },
    /// A whole number from `low` to `high`.
    Whole {
        /// The least.
        low: u32,
        /// The largest.
        high: u32,
    },
    /// A vector, or three numbers.
    Vector,
    /// A vector that is not 0.
    Direction,
    /// A colour's name, a colour or three numbers.
    Colour,
    /// A colour, or a share of another: `N%`.
    Share,
    /// `on` or `off`.
    Switch,
    /// A number, a vector or a colour.
    Value,
    /// A truth: a comparison of numbers.
    Condition,
    /// A word of a list.
    Word(&'static [OptionSpec]),
    /// A name that the command makes.
    New(Names),
    /// A name that was made before.
    Known(Names),
    /// `=` and a name that was made before, which is copied.
    Copy(Names),
    /// A way to texture: a solid, two waves, a colour or an image.
    Method,
    /// A colour, or an image of the project.
    Backdrop,
    /// A file of the project.
    File,
    /// A file that the command writes.
    NewFile,
    /// Anything, to the end of the line.
    Text,
    /// Commands in `{ … }`.
    Block,
}

/// Kinds of things that have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Names {
    /// A material (`surface`).
    Material,
    /// A texture.
    Texture,
    /// An object, chain or instance.
    Object,
    /// A variable.
    Variable,
    /// A command.
    Command,
    /// A node of a skeleton.
    Node,
    /// A set of values for sliders.
    Preset,
}

impl Names {
    /// Returns the word by which messages call it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Material => "material",
            Self::Texture => "texture",
            Self::Object => "object",
            Self::Variable => "variable",
            Self::Command => "command",
            Self::Node => "node",
            Self::Preset => "preset",
        }
    }
}

/// Unit of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Nothing: a count, a factor, a share.
    None,
    /// The units of the model.
    Length,
    /// Degrees.
    Degrees,
    /// Pixels.
    Pixels,
}

impl Unit {
    /// Returns the word of the manual; empty for a plain number.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Length => "model units",
            Self::Degrees => "degrees",
            Self::Pixels => "pixels",
        }
    }
}

/// The part of a shape that a number says, by which a hand takes hold of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Nothing that a hand could move.
    None,
    /// The radius, at the base if the shape has two.
    Radius,
    /// The radius at the apex.
    ApexRadius,
    /// The radius at the node that stands before it.
    NodeRadius,
    /// The radius of the circle that an arc lies on.
    Sweep,
    /// The angle where an arc begins.
    Start,
    /// The angle from there to an arc's end.
    Width,
    /// The length of a box along x (0), y (1) or z (2).
    Side(usize),
}

/// Number of times that a parameter is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arity {
    /// Exactly once.
    One,
    /// Once or not at all.
    Optional,
    /// Once or more.
    Many,
    /// Never, once or more.
    Any,
}

/// A parameter of a command or option.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// The name in the synopsis; UPPERCASE is a triple.
    pub name: &'static str,
    /// The kind of value it takes.
    pub kind: Kind,
    /// The meaning: `the tube radius`. Messages say that this was expected.
    pub meaning: &'static str,
    /// The unit.
    pub unit: Unit,
    /// The value if it is left out; empty if it cannot be, or if there is none.
    pub default: &'static str,
    /// The number of times that it is given.
    pub arity: Arity,
    /// Whether it is the material of a shape, which shapes leave out in a `chain`, as the chain
    /// gives it.
    pub in_chain: bool,
    /// The part of a shape that it says.
    pub role: Role,
}

impl Parameter {
    /// Returns the range as a sentence's end; empty if any value will do.
    #[must_use]
    pub fn range(&self) -> String {
        match self.kind {
            Kind::Number { low, high } => range(low, high),
            Kind::Whole { low, high } => {
                format!("whole, {}", range(f64::from(low), f64::from(high)))
            }
            _ => String::new(),
        }
    }

    /// Returns the parameter as the synopsis shows it.
    #[must_use]
    pub fn synopsis(&self) -> String {
        let name = match self.kind {
            Kind::Switch => String::from("on | off"),
            Kind::Word(words) if words.len() <= 8 => {
                let names: Vec<_> = words.iter().map(|word| word.name).collect();
                names.join(" | ")
            }
            Kind::Block if self.arity == Arity::One => String::from("{ … }"),
            _ => self.name.to_owned(),
        };
        match self.arity {
            Arity::One => name,
            Arity::Optional => format!("[{name}]"),
            Arity::Many => format!("{name} …"),
            Arity::Any => format!("[{name} …]"),
        }
    }
}

/// An option word of a command.
#[derive(Debug)]
pub struct OptionSpec {
    /// The whole word.
    pub name: &'static str,
    /// The operands, which follow it.
    pub parameters: &'static [Parameter],
    /// The meaning, a few words.
    pub meaning: &'static str,
    /// The value if it is left out.
    pub default: &'static str,
}

impl OptionSpec {
    /// Returns whether its name begins with a word, in any case: options may be shortened.
    #[must_use]
    pub fn begins(&self, word: &str) -> bool {
        let start = self.name.get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    }

    /// Returns the word and what follows it.
    #[must_use]
    pub fn synopsis(&self) -> String {
        join(self.name, self.parameters)
    }
}

/// Joins a name and the synopses of its operands.
pub(super) fn join(name: &str, parameters: &[Parameter]) -> String {
    let mut text = name.to_owned();
    for parameter in parameters {
        text += " ";
        text += &parameter.synopsis();
    }
    text
}

fn range(low: f64, high: f64) -> String {
    match (low > -MAX_MAGNITUDE, high < MAX_MAGNITUDE) {
        (true, true) => format!("from {low} to {high}"),
        (true, false) => format!("at least {low}"),
        (false, true) => format!("at most {high}"),
        (false, false) => String::new(),
    }
}
