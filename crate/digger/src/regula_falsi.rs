//! Marching, then the regula falsi: the chord's root replaces the end of the bracket that has its
//! sign. In the form called "Illinois", the value at an end that stays twice is halved, without
//! which one end of a curved function's bracket never moves.
use crate::march::{Bracket, MOST_REFINING, TOLERANCE};

/// Returns the root in a bracket.
pub(crate) fn refine(f: &mut dyn FnMut(f64) -> f64, bracket: Bracket) -> f64 {
    let [mut a, mut b] = bracket.ends;
    let [mut fa, mut fb] = bracket.values;
    let mut stayed = 0_i32;
    let mut root = f64::INFINITY;
    for _ in 0..MOST_REFINING {
        let chord = b - fb * (b - a) / (fb - fa);
        // Infinite values, near poles, have no chord.
        let next = if chord >= a && chord <= b {
            chord
        } else {
            0.5 * (a + b)
        };
        let moved = (next - root).abs();
        root = next;
        let value = f(root);
        if value == 0.0 || moved <= TOLERANCE || b - a <= TOLERANCE {
            break;
        }
        if (value > 0.0) == (fb > 0.0) {
            (b, fb) = (root, value);
            stayed = stayed.max(0) + 1;
            if stayed > 1 {
                fa *= 0.5;
            }
        } else {
            (a, fa) = (root, value);
            stayed = stayed.min(0) - 1;
            if stayed < -1 {
                fb *= 0.5;
            }
        }
    }
    root
}
