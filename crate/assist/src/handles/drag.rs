//! Moving a handle: the numbers that bring it to a place, and the changes of the texts.

use super::decimal::{power, write};
use super::handle::{Editable, Handle, Moves, triple};
use glam::{DMat3, DVec3};
use rats::TextEdit;
use rats::limits::MAX_MAGNITUDE;
use rats::provenance::{Number, Source};

/// Computes the changes of the texts that bring a handle to `to`, or as near as its numbers allow.
/// `grain`, a length of the world above 0 (say, that of a pixel), says how exactly: numbers get no
/// more digits than that needs, and a number that is that near already stays as it is written.
///
/// The changes are in the order of the text, apart from each other; made from the last to the
/// first, no range moves under another. There are none if the handle is fixed, or a number would be
/// out of range.
#[must_use]
pub fn drag(handle: &Handle, to: DVec3, grain: f64) -> Vec<TextEdit> {
    if matches!(handle.edit, Editable::Fixed { .. }) || !to.is_finite() {
        return Vec::new();
    }
    let grain = if grain.is_finite() {
        grain.clamp(1e-12, 1e12)
    } else {
        1e-6
    };
    let Some(values) = values(handle, to, grain) else {
        return Vec::new();
    };
    let mut edits: Vec<TextEdit> = Vec::new();
    for (number, (value, grain)) in handle.numbers.iter().zip(values) {
        let Source::Literal {
            file,
            span,
            negated,
            ..
        } = &number.source
        else {
            continue;
        };
        if !value.is_finite() || value.abs() > MAX_MAGNITUDE {
            return Vec::new();
        }
        if (value - number.value).abs() <= 0.5 * grain {
            continue;
        }
        let value = if *negated { -value } else { value };
        edits.push(TextEdit {
            file: *file,
            span: span.clone(),
            text: write(value, grain),
        });
    }
    field::heap_sort(&mut edits, |a, b| {
        (a.file, a.span.start) < (b.file, b.span.start)
    });
    edits
}

/// Computes the numbers that bring a handle to a place, each with its own grain.
fn values(handle: &Handle, to: DVec3, grain: f64) -> Option<Vec<(f64, f64)>> {
    let numbers = &handle.numbers;
    let first = numbers.first()?.value;
    Some(match handle.moves {
        Moves::Freely(to_world) => {
            let now = triple(numbers);
            let new = now + free_move(&to_world.matrix3, numbers, to - handle.place)?;
            (0..3)
                .map(|k| (new[k], power(grain / to_world.matrix3.col(k).length())))
                .collect()
        }
        Moves::Along {
            anchor,
            along,
            growth,
        } => {
            let grain = power(grain / growth);
            // A shape without a radius is none, and its handle would be lost.
            let least = if first > 0.0 { grain.min(first) } else { grain };
            vec![(((to - anchor).dot(along) / growth).max(least), grain)]
        }
        Moves::Around { anchor, linear, .. } => {
            let length = triple(numbers).length();
            let new = (linear.inverse() * (to - anchor)).try_normalize()? * length;
            let grain = power(length * 1e-3);
            new.to_array().map(|x| (x, grain)).to_vec()
        }
        Moves::Circle {
            center,
            u,
            v,
            sweep,
            angle,
            turns,
            start,
        } => {
            let from = to - center;
            let (x, y) = (from.dot(u), from.dot(v));
            if x == 0.0 && y == 0.0 {
                return None;
            }
            let turned = libm::atan2(y, x);
            let grain = power((grain / sweep).to_degrees().clamp(1e-6, 1.0));
            if start {
                vec![(first + turns * turned.to_degrees(), grain)]
            } else {
                const TURN: f64 = std::f64::consts::TAU;
                let near = turned + ((angle - turned) / TURN).round() * TURN;
                let width = near.to_degrees().clamp(1.0, 360.0);
                vec![(turns * width, grain)]
            }
        }
        Moves::Nowhere => return None,
    })
}

/// Computes the change, of the numbers that can change, which comes nearest to moving their point
/// by `moved`.
fn free_move(linear: &DMat3, numbers: &[Number], moved: DVec3) -> Option<DVec3> {
    let free: Vec<usize> = (0..3)
        .filter(|k| matches!(numbers[*k].source, Source::Literal { .. }))
        .collect();
    let mut change = DVec3::ZERO;
    match *free {
        [k] => change[k] = linear.col(k).dot(moved) / linear.col(k).length_squared(),
        [j, k] => {
            // The normal equations of two unknowns.
            let (a, b) = (linear.col(j), linear.col(k));
            let determinant = a.length_squared() * b.length_squared() - a.dot(b) * a.dot(b);
            let (p, q) = (a.dot(moved), b.dot(moved));
            change[j] = (p * b.length_squared() - q * a.dot(b)) / determinant;
            change[k] = (q * a.length_squared() - p * a.dot(b)) / determinant;
        }
        [_, _, _] => change = linear.inverse() * moved,
        _ => return None,
    }
    change.is_finite().then_some(change)
}
