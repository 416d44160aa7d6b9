//! The result of a fit as text of the language.

use crate::align::Rigid;
use core::fmt::Write as _;
use glam::DVec3;

/// Digits after the first one of a number that is as large as the controls' box.
const DIGITS: f64 = 1e6;

/// Returns the lines that carry out a fit on the last object, or on one of a name: the turn and the
/// shift of the whole mesh, if any, then `deform { control <x y z> move <dx dy dz> … }` with a line
/// for each control. `controls` are as they were before the turn. Numbers are rounded to a
/// millionth of the size of the controls' box.
///
/// ```
/// use fit::{Rigid, deform_lines};
/// use glam::DVec3;
///
/// let controls = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.5)];
/// let moves = [DVec3::ZERO, DVec3::new(0.0, 0.25, 0.0)];
/// assert_eq!(
///     deform_lines(None, &Rigid::IDENTITY, &controls, &moves),
///     "deform {\n  control <0 0 0> move <0 0 0>\n  control <2 0 0.5> move <0 0.25 0>\n}\n"
/// );
/// ```
#[must_use]
pub fn deform_lines(
    name: Option<&str>,
    rigid: &Rigid,
    controls: &[DVec3],
    moves: &[DVec3],
) -> String {
    let size = mesh::Aabb::of_points(controls.iter().copied())
        .size()
        .max_element();
    let grain = if size > 0.0 && size.is_finite() {
        power_of_ten(size / DIGITS)
    } else {
        1e-9
    };
    let mut text = String::new();
    let operand = name.map(|name| format!(" {name}")).unwrap_or_default();
    if *rigid != Rigid::IDENTITY {
        let (axis, angle) = rigid.axis_angle();
        let [x, y, z] = axis.to_array().map(|v| number(v, 1e-12));
        let _ = writeln!(text, "rotate {x} {y} {z} {}{operand}", number(angle, 1e-10));
        let [x, y, z] = rigid.shift.to_array().map(|v| number(v, 0.01 * grain));
        let _ = writeln!(text, "translate {x} {y} {z}{operand}");
    }
    let _ = writeln!(text, "deform{operand} {{");
    for (control, way) in controls.iter().zip(moves) {
        let [place, way] =
            [rigid.apply(*control), *way].map(|v| v.to_array().map(|x| number(x, grain)).join(" "));
        let _ = writeln!(text, "  control <{place}> move <{way}>");
    }
    text.push_str("}\n");
    text
}

/// The power of ten at or below a number above 0.
fn power_of_ten(value: f64) -> f64 {
    let mut unit = 1.0;
    while unit > value && unit > 1e-300 {
        unit /= 10.0;
    }
    while unit * 10.0 <= value {
        unit *= 10.0;
    }
    unit
}

/// Returns a number in decimals, rounded to multiples of a power of ten.
fn number(value: f64, grain: f64) -> String {
    let mut places = 0;
    let mut unit = 1.0;
    while unit > grain * 1.5 && places < 17 {
        unit /= 10.0;
        places += 1;
    }
    let mut text = format!("{value:.places$}");
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" {
        text.remove(0);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact_enough() {
        for (value, grain, text) in [
            (0.0, 1e-6, "0"),
            (-1e-9, 1e-6, "0"),
            (1.5, 1e-6, "1.5"),
            (-0.123_456_78, 1e-6, "-0.123457"),
            (1200.0, 1e-3, "1200"),
            (12.0, 10.0, "12"),
        ] {
            assert_eq!(number(value, grain), text);
        }
        for (value, power) in [(3.2e-6, 1e-6), (0.99, 0.1), (1.0, 1.0), (470.0, 100.0)] {
            assert!((power_of_ten(value) / power - 1.0).abs() < 1e-9, "{value}");
        }
    }
}
