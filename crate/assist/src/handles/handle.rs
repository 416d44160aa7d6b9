//! A handle: a place in the world, the numbers that it stands for, and how the one follows from the
//! others.

use super::decimal::write;
use glam::{DAffine3, DMat3, DVec3};
use rats::provenance::{Number, Source};
use std::ops::Range;

/// Kinds of handles, by the quantity that they move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A place: it follows the hand.
    Point,
    /// A direction: the handle turns around the shape's middle.
    Direction,
    /// A radius: the handle moves to and from the middle.
    Length,
    /// An angle of an arc: the handle moves along its circle.
    Angle,
}

/// Whether a handle can be moved.
#[derive(Clone, Debug, PartialEq)]
pub enum Editable {
    /// The numbers can change, each in a file (an index of [`Project::files`]) at a byte
    /// range.
    Literal {
        /// The places.
        spans: Vec<(usize, Range<usize>)>,
    },
    /// The numbers cannot change.
    Fixed {
        /// Why not, a sentence's end: "is made in a loop".
        why: String,
    },
}

/// A place that stands for numbers of the text.
#[derive(Clone, Debug)]
pub struct Handle {
    /// The quantity that it moves.
    pub kind: Kind,
    /// The place in the world.
    pub place: DVec3,
    /// A label for a person: "the centre".
    pub label: String,
    /// Whether it can be moved.
    pub edit: Editable,
    pub(super) numbers: Vec<Number>,
    pub(super) moves: Moves,
}

impl Handle {
    /// Writes the numbers as the text might give them, short.
    #[must_use]
    pub fn text(&self) -> String {
        let numbers = self.numbers.iter().map(|number| write(number.value, 1e-4));
        numbers.collect::<Vec<_>>().join(" ")
    }
}

/// Way in which a handle's place follows from its numbers.
#[derive(Clone, Copy, Debug)]
pub enum Moves {
    /// `to_world · (x, y, z)`
    Freely(DAffine3),
    /// `anchor + along·(length·growth)`, `along` being a unit vector.
    Along {
        anchor: DVec3,
        along: DVec3,
        growth: f64,
    },
    /// `anchor + size·linear·(x, y, z)`, made a unit vector before it is multiplied by `size`.
    Around {
        anchor: DVec3,
        linear: DMat3,
        size: f64,
    },
    /// The start of an arc if `start`, else its end, on its circle.
    Circle {
        center: DVec3,
        u: DVec3,
        v: DVec3,
        sweep: f64,
        angle: f64,
        turns: f64,
        start: bool,
    },
    Nowhere,
}

/// Makes a handle at the place that its numbers give, and finds whether they can be changed.
pub fn handle(kind: Kind, mut label: String, numbers: Vec<Number>, moves: Moves) -> Handle {
    let mut spans: Vec<(usize, Range<usize>)> = Vec::new();
    let mut variables: Vec<&str> = Vec::new();
    let mut why: Vec<&str> = Vec::new();
    for number in &numbers {
        match &number.source {
            Source::Literal {
                file,
                span,
                variable,
                ..
            } => {
                let place = (*file, span.clone());
                if spans.contains(&place) {
                    why.push("uses one number twice");
                }
                spans.push(place);
                if let Some(name) = variable
                    && !variables.contains(&name.as_str())
                {
                    variables.push(name);
                }
            }
            Source::Computed(reason) => why.push(reason),
        }
    }
    // A direction's three numbers belong together, and so do numbers that are one in the text.
    let twice = why.contains(&"uses one number twice");
    let edit = if spans.is_empty() || twice || (kind == Kind::Direction && !why.is_empty()) {
        let why = why.first().copied().unwrap_or_default();
        Editable::Fixed {
            why: why.to_owned(),
        }
    } else {
        for (axis, number) in ["x", "y", "z"].iter().zip(&numbers) {
            if numbers.len() == 3
                && let Source::Computed(reason) = &number.source
            {
                label += &format!("; its {axis} {reason}");
            }
        }
        match variables.as_slice() {
            [] => {}
            [name] => label += &format!(" (the variable `{name}`)"),
            names => label += &format!(" (the variables `{}`)", names.join("`, `")),
        }
        Editable::Literal { spans }
    };
    let place = place(&numbers, &moves);
    Handle {
        kind,
        place,
        label,
        edit,
        numbers,
        moves,
    }
}

/// Returns three numbers as a vector; NaN if there are not three.
pub fn triple(numbers: &[Number]) -> DVec3 {
    match numbers {
        [x, y, z] => DVec3::new(x.value, y.value, z.value),
        _ => DVec3::NAN,
    }
}

/// Returns the place that numbers give.
fn place(numbers: &[Number], moves: &Moves) -> DVec3 {
    match *moves {
        Moves::Freely(to_world) => to_world.transform_point3(triple(numbers)),
        Moves::Along {
            anchor,
            along,
            growth,
        } => anchor + along * (numbers[0].value * growth),
        Moves::Around {
            anchor,
            linear,
            size,
        } => anchor + (linear * triple(numbers)).normalize_or_zero() * size,
        Moves::Circle {
            center,
            u,
            v,
            sweep,
            angle,
            start,
            ..
        } => {
            let (sin, cos) = libm::sincos(if start { 0.0 } else { angle });
            center + (u * cos + v * sin) * sweep
        }
        Moves::Nowhere => DVec3::NAN,
    }
}
