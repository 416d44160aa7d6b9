//! Marching, then Brent's method: the inverse parabola through the last three places (or the chord
//! of two) where it falls well within the bracket and shrinks fast enough, halving otherwise.
use crate::march::{Bracket, MOST_REFINING, TOLERANCE};

/// Returns the root in a bracket.
pub(crate) fn refine(f: &mut dyn FnMut(f64) -> f64, bracket: Bracket) -> f64 {
    // The best place so far, the one before it, and the far end of the bracket.
    let [mut before, mut best] = bracket.ends;
    let [mut f_before, mut f_best] = bracket.values;
    let (mut far, mut f_far) = (before, f_before);
    let mut step = best - before;
    let mut last_step = step;
    for _ in 0..MOST_REFINING {
        if (f_far > 0.0) == (f_best > 0.0) {
            (far, f_far) = (before, f_before);
            step = best - before;
            last_step = step;
        }
        if f_far.abs() < f_best.abs() {
            (before, f_before) = (best, f_best);
            (best, far) = (far, best);
            (f_best, f_far) = (f_far, f_best);
        }
        let half = 0.5 * (far - best);
        if half.abs() <= TOLERANCE || f_best == 0.0 {
            break;
        }
        let ratio = f_best / f_before;
        // The step is p/q.
        let (mut p, mut q) = if before == far {
            (2.0 * half * ratio, 1.0 - ratio)
        } else {
            let (u, v) = (f_before / f_far, f_best / f_far);
            (
                ratio * (2.0 * half * u * (u - v) - (best - before) * (v - 1.0)),
                (u - 1.0) * (v - 1.0) * (ratio - 1.0),
            )
        };
        if p > 0.0 {
            q = -q;
        }
        p = p.abs();
        let within = 2.0 * p < (3.0 * half * q - (TOLERANCE * q).abs());
        if last_step.abs() >= TOLERANCE
            && ratio.abs() < 1.0
            && within
            && 2.0 * p < (last_step * q).abs()
        {
            last_step = step;
            step = p / q;
        } else {
            step = half;
            last_step = half;
        }
        (before, f_before) = (best, f_best);
        best += if step.abs() > TOLERANCE {
            step
        } else {
            TOLERANCE.copysign(half)
        };
        f_best = f(best);
    }
    best
}
