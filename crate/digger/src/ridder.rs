//! Marching, then Ridders' method: the values at both ends and in the middle are divided by an
//! exponential factor that makes them lie on a straight line, whose root is taken. It always lies
//! in the bracket, which at least halves in each round.
use crate::march::{Bracket, MOST_REFINING, TOLERANCE};

/// Returns the root in a bracket.
pub(crate) fn refine(f: &mut dyn FnMut(f64) -> f64, bracket: Bracket) -> f64 {
    let [mut a, mut b] = bracket.ends;
    let [mut fa, mut fb] = bracket.values;
    let mut root = f64::INFINITY;
    for _ in 0..MOST_REFINING / 2 {
        let middle = 0.5 * (a + b);
        let value = f(middle);
        // f(m)² − f(a)·f(b) is positive, as the signs at both ends differ.
        let scale = (value * value - fa * fb).sqrt();
        let turn = if fa >= fb { 1.0 } else { -1.0 };
        let step = (middle - a) * turn * value / scale;
        let next = if step.is_finite() {
            (middle + step).clamp(a, b)
        } else {
            middle
        };
        let moved = (next - root).abs();
        root = next;
        let there = f(root);
        if there == 0.0 || moved <= TOLERANCE || b - a <= TOLERANCE {
            break;
        }
        // The narrowest bracket that both new places give.
        for (x, fx) in [(middle, value), (root, there)] {
            if x <= a || x >= b {
                continue;
            }
            if (fx > 0.0) == (fb > 0.0) {
                (b, fb) = (x, fx);
            } else {
                (a, fa) = (x, fx);
            }
        }
    }
    root
}
