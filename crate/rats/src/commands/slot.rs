//! Parameters with the types of their values, from which the rows of the table are made.
//!
//! A [`Slot<K>`] is a [`Parameter`] whose values are read as the type `K::Of`. The table keeps the
//! parameter alone; the type is for the function that runs the command (see `takes!`).

use super::parameter::{Arity, Kind, Names, OptionSpec, Parameter, Role, Unit};
use crate::limits::MAX_MAGNITUDE;
use crate::operands::Share;
use glam::DVec3;
use scene::Rgb;
use std::marker::PhantomData;

/// Parameter whose values have the type of `K`.
pub struct Slot<K> {
    /// The parameter as the table keeps it.
    pub plain: Parameter,
    kind: PhantomData<fn() -> K>,
}

/// Type of names.
#[derive(Debug)]
pub struct Named;
/// Type of words of a list.
#[derive(Debug)]
pub struct Word;
/// Type of colours and names of images.
#[derive(Debug)]
pub struct Backdrop;
/// Type of text to the end of the line; only its place is kept.
#[derive(Debug)]
pub struct Text;
/// Type of operands that their command reads by itself.
#[derive(Debug)]
pub struct Unread;
/// Type of values with their places in the text.
#[derive(Debug)]
pub struct Placed<K>(PhantomData<fn() -> K>);

const fn slot<K>(name: &'static str, kind: Kind, meaning: &'static str) -> Slot<K> {
    Slot {
        plain: Parameter {
            name,
            kind,
            meaning,
            unit: Unit::None,
            default: "",
            arity: Arity::One,
            in_chain: false,
            role: Role::None,
        },
        kind: PhantomData,
    }
}

impl<K> Slot<K> {
    const fn with<L>(self, plain: Parameter) -> Slot<L> {
        Slot {
            plain,
            kind: PhantomData,
        }
    }

    pub const fn unit(self, unit: Unit) -> Self {
        let plain = self.plain;
        self.with(Parameter { unit, ..plain })
    }

    pub const fn optional(self, default: &'static str) -> Slot<Option<K>> {
        let plain = self.plain;
        self.with(Parameter {
            arity: Arity::Optional,
            default,
            ..plain
        })
    }

    pub const fn many(self) -> Slot<Vec<K>> {
        let (plain, arity) = (self.plain, Arity::Many);
        self.with(Parameter { arity, ..plain })
    }

    pub const fn any(self) -> Slot<Vec<K>> {
        let (plain, arity) = (self.plain, Arity::Any);
        self.with(Parameter { arity, ..plain })
    }

    /// Keeps the place of the value in the text, too.
    pub const fn with_place(self) -> Slot<Placed<K>> {
        let plain = self.plain;
        self.with(plain)
    }
}

impl Slot<f64> {
    pub const fn from(self, low: f64, high: f64) -> Self {
        let (plain, kind) = (self.plain, Kind::Number { low, high });
        self.with(Parameter { kind, ..plain })
    }

    pub const fn role(self, role: Role) -> Self {
        let plain = self.plain;
        self.with(Parameter { role, ..plain })
    }

    pub const fn at_least(self, low: f64) -> Self {
        self.from(low, MAX_MAGNITUDE)
    }
}

/// Material of a shape, which shapes leave out in a `chain`.
pub const SN: Slot<Named> = {
    let slot: Slot<Named> = existing("sn", Names::Material, "the material's name");
    let plain = slot.plain;
    slot.with(Parameter {
        in_chain: true,
        ..plain
    })
};

/// Operand `on` or `off`.
pub const ON_OFF: Slot<bool> = slot("on|off", Kind::Switch, "`on` or `off`");

/// Takes a number of any size.
pub const fn number(name: &'static str, meaning: &'static str) -> Slot<f64> {
    let kind = Kind::Number {
        low: -MAX_MAGNITUDE,
        high: MAX_MAGNITUDE,
    };
    slot(name, kind, meaning)
}

/// Takes a length of any sign.
pub const fn length(name: &'static str, meaning: &'static str) -> Slot<f64> {
    number(name, meaning).unit(Unit::Length)
}

/// Takes an angle in degrees.
pub const fn degrees(name: &'static str, meaning: &'static str) -> Slot<f64> {
    number(name, meaning).unit(Unit::Degrees)
}

/// Takes a whole number.
pub const fn whole(name: &'static str, low: u32, high: u32, meaning: &'static str) -> Slot<u32> {
    slot(name, Kind::Whole { low, high }, meaning)
}

/// Takes a place.
pub const fn vector(name: &'static str, meaning: &'static str) -> Slot<DVec3> {
    triple(name, meaning).unit(Unit::Length)
}

/// Takes three numbers without a unit.
pub const fn triple(name: &'static str, meaning: &'static str) -> Slot<DVec3> {
    slot(name, Kind::Vector, meaning)
}

/// Takes a direction.
pub const fn direction(name: &'static str, meaning: &'static str) -> Slot<DVec3> {
    slot(name, Kind::Direction, meaning)
}

/// Takes a colour.
pub const fn colour(name: &'static str, meaning: &'static str) -> Slot<Rgb> {
    slot(name, Kind::Colour, meaning)
}

/// Takes a colour, or a share of another.
pub const fn share(meaning: &'static str) -> Slot<Share> {
    slot("RGB|N%", Kind::Share, meaning)
}

/// Takes a colour, or the name of an image.
pub const fn backdrop(name: &'static str, meaning: &'static str) -> Slot<Backdrop> {
    slot(name, Kind::Backdrop, meaning)
}

/// Takes one of some words.
pub const fn word(
    name: &'static str,
    words: &'static [OptionSpec],
    meaning: &'static str,
) -> Slot<Word> {
    slot(name, Kind::Word(words), meaning)
}

/// Takes a name that the command makes.
pub const fn new(name: &'static str, of: Names, meaning: &'static str) -> Slot<Named> {
    slot(name, Kind::New(of), meaning)
}

/// Takes a name that was made before.
pub const fn existing(name: &'static str, of: Names, meaning: &'static str) -> Slot<Named> {
    slot(name, Kind::Known(of), meaning)
}

/// Takes `=` and a name that was made before, which is copied.
pub const fn copy(name: &'static str, of: Names, meaning: &'static str) -> Slot<Named> {
    slot(name, Kind::Copy(of), meaning)
}

/// Takes a file of the project.
pub const fn file(name: &'static str, meaning: &'static str) -> Slot<Named> {
    slot(name, Kind::File, meaning)
}

/// Takes a file that the command writes.
pub const fn new_file(name: &'static str, meaning: &'static str) -> Slot<Named> {
    slot(name, Kind::NewFile, meaning)
}

/// Takes anything, to the end of the line.
pub const fn text(name: &'static str, meaning: &'static str) -> Slot<Text> {
    slot(name, Kind::Text, meaning)
}

/// Takes an operand that its command reads by itself.
pub const fn unread(name: &'static str, kind: Kind, meaning: &'static str) -> Slot<Unread> {
    slot(name, kind, meaning)
}

/// Option whose operands have the type of `K`.
pub struct Choice<K> {
    /// The option as the table keeps it.
    pub plain: OptionSpec,
    kind: PhantomData<fn() -> K>,
}

// The functions that return slots tell the types and are never called (see `choice!`).
impl<K> Choice<K> {
    const fn of_kind(plain: OptionSpec) -> Self {
        let kind = PhantomData;
        Self { plain, kind }
    }
}

impl Choice<()> {
    pub const fn none(plain: OptionSpec) -> Self {
        Self::of_kind(plain)
    }
}

impl<A> Choice<A> {
    pub const fn one(plain: OptionSpec, _: fn() -> Slot<A>) -> Self {
        Self::of_kind(plain)
    }
}

impl<A, B> Choice<(A, B)> {
    pub const fn two(plain: OptionSpec, _: fn() -> Slot<A>, _: fn() -> Slot<B>) -> Self {
        Self::of_kind(plain)
    }
}

impl<A, B, C> Choice<(A, B, C)> {
    pub const fn three(
        plain: OptionSpec,
        _: fn() -> Slot<A>,
        _: fn() -> Slot<B>,
        _: fn() -> Slot<C>,
    ) -> Self {
        Self::of_kind(plain)
    }
}
