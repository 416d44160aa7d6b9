//! The values that variables hold and expressions give: numbers, vectors and colours.

use crate::symbol::Symbol;
use glam::DVec3;

/// A value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Scalar(f64),
    /// A vector: three numbers.
    Vector(DVec3),
    /// A colour: red, green, blue, 1 being full.
    Colour(DVec3),
    /// The name that a parameter of a call stands for.
    Name(Symbol),
}

impl Value {
    /// Returns the kind as messages name it: `a number`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a number",
            Self::Vector(_) => "a vector",
            Self::Colour(_) => "a colour",
            Self::Name(_) => "a name",
        }
    }

    /// Applies a function to every number in it.
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Scalar(x) => Self::Scalar(f(x)),
            Self::Vector(v) => Self::Vector(v.map(f)),
            Self::Colour(c) => Self::Colour(c.map(f)),
            Self::Name(name) => Self::Name(name),
        }
    }

    /// Returns whether all its numbers have a property.
    #[must_use]
    pub fn all(&self, property: impl Fn(f64) -> bool) -> bool {
        match self {
            Self::Scalar(x) => property(*x),
            Self::Vector(v) | Self::Colour(v) => v.to_array().into_iter().all(property),
            Self::Name(_) => true,
        }
    }

    /// Joins two values number by number: scalars with scalars, triples with triples of any kind (a
    /// vector and a colour give a colour). `None` for a scalar and a triple.
    #[must_use]
    pub fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Option<Self> {
        let each = |a: DVec3, b: DVec3| DVec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z));
        Some(match (self, other) {
            (Self::Scalar(a), Self::Scalar(b)) => Self::Scalar(f(a, b)),
            (Self::Vector(a), Self::Vector(b)) => Self::Vector(each(a, b)),
            (Self::Colour(a) | Self::Vector(a), Self::Colour(b) | Self::Vector(b)) => {
                Self::Colour(each(a, b))
            }
            _ => return None,
        })
    }

    /// Returns the component `x`, `y`, `z` (or `r`, `g`, `b`) of a triple.
    #[must_use]
    pub fn component(self, name: &str) -> Option<f64> {
        let (Self::Vector(v) | Self::Colour(v)) = self else {
            return None;
        };
        match name {
            "x" | "r" => Some(v.x),
            "y" | "g" => Some(v.y),
            "z" | "b" => Some(v.z),
            _ => None,
        }
    }
}
