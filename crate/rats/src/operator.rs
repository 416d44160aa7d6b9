//! The operators of expressions: their places, and how strongly they bind.
//!
//! The reader that computes values and the one that only tells operands apart both ask here.

use crate::syntax::{Datum, Item};

/// An operator that joins two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `or`
    Or,
    /// `and`
    And,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `==`
    Equal,
    /// `!=`
    Unequal,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Times,
    /// `/`
    Over,
    /// `^`
    Power,
}

/// Strength of `not`, between `and` and the comparisons.
pub const NOT: u8 = 3;
/// Strength of a sign, between `*` and `^`.
pub const SIGN: u8 = 7;

impl Operator {
    /// Returns the operator at an item and the number of its items; `None` if none stands there.
    /// `listed` says whether operands follow each other with nothing but space between, so that `a
    /// -b` is two of them; `comparing` whether it is a condition, where `<` and `>` compare.
    #[must_use]
    pub fn at(
        items: &[Item],
        at: usize,
        text: &str,
        listed: bool,
        comparing: bool,
    ) -> Option<(Self, usize)> {
        let item = items.get(at)?;
        let next = items.get(at + 1);
        let with_equal =
            next.is_some_and(|next| next.datum == Datum::Sign(b'=') && next.start == item.end);
        Some(match item.datum {
            Datum::Sign(sign @ (b'+' | b'-')) => {
                let begins_operand = listed && item.spaced && next.is_some_and(|next| !next.spaced);
                // `+=` belongs to `var`.
                if begins_operand || with_equal {
                    return None;
                }
                (
                    if sign == b'+' {
                        Self::Plus
                    } else {
                        Self::Minus
                    },
                    1,
                )
            }
            Datum::Sign(b'*') if !with_equal => (Self::Times, 1),
            Datum::Sign(b'/') => (Self::Over, 1),
            Datum::Sign(b'^') => (Self::Power, 1),
            Datum::Sign(b'<') if comparing && with_equal => (Self::LessEqual, 2),
            Datum::Sign(b'<') if comparing => (Self::Less, 1),
            Datum::Sign(b'>') if comparing && with_equal => (Self::GreaterEqual, 2),
            Datum::Sign(b'>') if comparing => (Self::Greater, 1),
            Datum::Sign(b'=') if comparing && with_equal => (Self::Equal, 2),
            Datum::Sign(b'!') if comparing && with_equal => (Self::Unequal, 2),
            Datum::Word(_) if comparing => {
                let word = &text[item.span()];
                if word.eq_ignore_ascii_case("and") {
                    (Self::And, 1)
                } else if word.eq_ignore_ascii_case("or") {
                    (Self::Or, 1)
                } else {
                    return None;
                }
            }
            _ => return None,
        })
    }

    /// Returns how strongly it binds: a larger number binds stronger.
    #[must_use]
    pub fn strength(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Less
            | Self::LessEqual
            | Self::Greater
            | Self::GreaterEqual
            | Self::Equal
            | Self::Unequal => 4,
            Self::Plus | Self::Minus => 5,
            Self::Times | Self::Over => 6,
            Self::Power => 8,
        }
    }

    /// Returns the least strength of an operator that belongs to its right side: `^` groups from
    /// the right, the others from the left.
    #[must_use]
    pub fn right_strength(self) -> u8 {
        self.strength() + u8::from(self != Self::Power)
    }

    /// Returns whether it gives a truth, 0 or 1.
    #[must_use]
    pub fn is_logical(self) -> bool {
        self.strength() <= Self::Equal.strength()
    }
}
