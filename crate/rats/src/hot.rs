//! Puts a slider's value into the text.

use crate::HotValue;
use crate::colours;
use std::ops::Range;

/// Returns the text with the literal of a hot variable replaced by a new value. Numbers are written
/// with at most six significant digits; a colour by its name if it has one, else as `rgb(…)`, so
/// that it stays a colour. A range that does not fit the text, or a value that is not finite,
/// changes nothing.
#[must_use]
pub fn set(text: &str, literal: Range<usize>, value: &HotValue) -> String {
    let (Some(before), Some(after)) = (text.get(..literal.start), text.get(literal.end..)) else {
        return text.to_owned();
    };
    if literal.start > literal.end || !is_finite(value) {
        return text.to_owned();
    }
    format!("{before}{}{after}", write(value))
}

/// Returns a value as the language writes it.
#[must_use]
pub fn write(value: &HotValue) -> String {
    match value {
        HotValue::Scalar(x) => number(*x),
        HotValue::Vector(v) => v.map(number).join(" "),
        HotValue::Colour(c) => colours::name_of(*c).map_or_else(
            || {
                let parts = c.map(|x| number((f64::from(x) * 1e4).round() / 1e4));
                format!("rgb({})", parts.join(", "))
            },
            str::to_owned,
        ),
    }
}

fn is_finite(value: &HotValue) -> bool {
    match value {
        HotValue::Scalar(x) => x.is_finite(),
        HotValue::Vector(v) => v.iter().all(|x| x.is_finite()),
        HotValue::Colour(c) => c.iter().all(|x| x.is_finite()),
    }
}

/// Returns the shortest text of the nearest number of six significant digits.
fn number(x: f64) -> String {
    // Through text, because rounding by powers of ten is not exact.
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    // −0 would be read as 0 − 0.
    let rounded = rounded + 0.0;
    if rounded != 0.0 && !(1e-7..1e15).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        let cases = [
            (0.05, "0.05"),
            (0.1 + 0.2, "0.3"),
            (1.0 / 3.0, "0.333333"),
            (-0.0, "0"),
            (-12.0, "-12"),
            (1_234_567.8, "1234570"),
            (1e-9, "1e-9"),
            (2.5e20, "2.5e20"),
        ];
        for (x, text) in cases {
            assert_eq!(number(x), text);
        }
    }

    #[test]
    fn replaces() {
        let text = "var r = 0.05 hot";
        assert_eq!(set(text, 8..12, &HotValue::Scalar(0.1)), "var r = 0.1 hot");
        let vector = HotValue::Vector([1.0, -2.0, 0.5]);
        assert_eq!(set(text, 8..12, &vector), "var r = 1 -2 0.5 hot");
        let colour = HotValue::Colour([1.0, 0.0, 0.0]);
        assert_eq!(set(text, 8..12, &colour), "var r = Red hot");
        let colour = HotValue::Colour([0.25, 0.3333333, 1.0]);
        assert_eq!(
            set(text, 8..12, &colour),
            "var r = rgb(0.25, 0.3333, 1) hot"
        );
        assert_eq!(set(text, 8..99, &colour), text);
        assert_eq!(set("é", 1..1, &colour), "é");
        assert_eq!(set(text, 8..12, &HotValue::Scalar(f64::NAN)), text);
    }
}
