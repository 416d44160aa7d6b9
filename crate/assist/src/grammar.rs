//! The parameters of a command, from the table, the library or the text itself.

use rats::commands::{Arity, CommandSpec, Kind, Names, OptionSpec, Parameter, Role, Unit};
use rats::library;
use rats::limits::MAX_MAGNITUDE;
use rats::symbol::Symbols;
use rats::syntax::{Define, Syntax, Takes};
use std::sync::LazyLock;

/// Parameter of a command of the table, the library or the text.
#[derive(Clone, Copy, Debug)]
pub struct Param<'p> {
    /// The name in the synopsis.
    pub name: &'p str,
    /// The kind of value it takes.
    pub kind: Kind,
    /// The meaning.
    pub meaning: &'p str,
    /// The unit.
    pub unit: Unit,
    /// The value if it is left out.
    pub default: &'p str,
    /// The number of times that it is given.
    pub arity: Arity,
    /// Whether it is the material of a shape, which a chain gives.
    pub in_chain: bool,
}

impl From<&Parameter> for Param<'static> {
    fn from(parameter: &Parameter) -> Self {
        Self {
            name: parameter.name,
            kind: parameter.kind,
            meaning: parameter.meaning,
            unit: parameter.unit,
            default: parameter.default,
            arity: parameter.arity,
            in_chain: parameter.in_chain,
        }
    }
}

impl Param<'_> {
    fn parameter(&self) -> Parameter {
        // Only what does not borrow from the text.
        Parameter {
            name: "",
            kind: self.kind,
            meaning: "",
            unit: self.unit,
            default: "",
            arity: self.arity,
            in_chain: self.in_chain,
            role: Role::None,
        }
    }

    /// Returns the range as a sentence's end; empty if any value will do.
    pub fn range(&self) -> String {
        self.parameter().range()
    }

    /// Returns the parameter as a synopsis shows it.
    pub fn synopsis(&self) -> String {
        let name = match self.kind {
            Kind::Switch => String::from("on | off"),
            Kind::Word(words) if words.len() <= 8 => {
                let names: Vec<_> = words.iter().map(|word| word.name).collect();
                names.join(" | ")
            }
            Kind::Block => String::from("{ … }"),
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

/// The parameters and options of a command.
#[derive(Clone, Debug, Default)]
pub struct Grammar<'p> {
    /// The operands.
    pub parameters: Vec<Param<'p>>,
    /// The option words that may follow.
    pub options: &'static [OptionSpec],
    /// Whether operands can be given by name: `turns = 3`.
    pub named: bool,
}

/// Makes a parameter as a define gives it.
fn formal<'p>(name: &'p str, takes: Takes, default: &'p str, meaning: &'p str) -> Param<'p> {
    let kind = match takes {
        Takes::Number => Kind::Number {
            low: -MAX_MAGNITUDE,
            high: MAX_MAGNITUDE,
        },
        Takes::Triple => Kind::Vector,
        Takes::Surface => Kind::Known(Names::Material),
    };
    Param {
        name,
        kind,
        meaning,
        unit: Unit::None,
        default,
        arity: if default.is_empty() {
            Arity::One
        } else {
            Arity::Optional
        },
        in_chain: matches!(takes, Takes::Surface),
    }
}

/// The parameters of the library's commands.
static LIBRARY: LazyLock<Vec<(&'static str, Vec<library::Parameter>)>> = LazyLock::new(|| {
    let commands = rats::commands::all().filter(|spec| spec.is_library());
    commands
        .map(|spec| (spec.name, library::parameters(spec.name)))
        .collect()
});

impl Grammar<'static> {
    /// Returns the parameters of a command of the table.
    pub fn of(spec: &'static CommandSpec) -> Self {
        if !spec.is_library() {
            return Self {
                parameters: spec.parameters.iter().map(Param::from).collect(),
                options: spec.options,
                named: false,
            };
        }
        let found = LIBRARY.iter().find(|(name, _)| *name == spec.name);
        let parameters = found.map_or(&[][..], |(_, parameters)| parameters);
        let parameters = parameters.iter().map(|parameter| {
            let takes = if parameter.is_surface {
                Takes::Surface
            } else if is_triple(parameter.name) {
                Takes::Triple
            } else {
                Takes::Number
            };
            formal(parameter.name, takes, parameter.default, &parameter.meaning)
        });
        Self {
            parameters: parameters.collect(),
            options: &[],
            named: true,
        }
    }
}

impl<'p> Grammar<'p> {
    /// Returns the parameters of a command that the text defines.
    pub fn own(define: &Define, syntax: &Syntax, text: &'p str, symbols: &Symbols<'p>) -> Self {
        let manual = comment_before(text, define.head.span.start);
        let parameters = define.parameters.iter().map(|parameter| {
            let name = symbols.word(parameter.name);
            let default = match &syntax.items[parameter.default.clone()] {
                [first, .., last] => &text[first.start as usize..last.end as usize],
                [one] => &text[one.span()],
                [] => "",
            };
            formal(name, parameter.takes, default, meaning(manual, name))
        });
        Self {
            parameters: parameters.collect(),
            options: &[],
            named: true,
        }
    }

    /// Leaves out the material, as shapes of a chain do.
    #[must_use]
    pub fn in_chain(mut self) -> Self {
        if self.takes_material() {
            self.parameters.remove(0);
        }
        self
    }

    /// Returns whether the first operand is the material of what is made.
    pub fn takes_material(&self) -> bool {
        self.parameters.first().is_some_and(|first| first.in_chain)
    }
}

/// Returns whether a parameter of this name takes a triple: it is written in capitals.
pub fn is_triple(name: &str) -> bool {
    name.chars().any(char::is_alphabetic) && !name.chars().any(char::is_lowercase)
}

/// Returns the comment lines right above a place.
pub fn comment_before(text: &str, byte: usize) -> &str {
    let line = text[..byte].rfind('\n').map_or(0, |at| at + 1);
    let mut start = line;
    while start > 0 {
        let before = text[..start - 1].rfind('\n').map_or(0, |at| at + 1);
        if !text[before..start].trim_start().starts_with('#') {
            break;
        }
        start = before;
    }
    &text[start..line]
}

/// Finds a parameter's meaning in a line of the comment that begins with its name; empty if there
/// is none.
fn meaning<'p>(comment: &'p str, name: &str) -> &'p str {
    let found = comment.lines().find_map(|line| {
        let line = line.trim_start().trim_start_matches('#').trim_start();
        let rest = line.strip_prefix(name)?;
        rest.starts_with("  ").then(|| rest.trim())
    });
    found.unwrap_or("")
}
