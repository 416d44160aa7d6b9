//! Lagrange interpolation: the polynomial of degree 4 through each five samples in equal steps (the
//! last of which is the first of the next five), and its roots. They are not refined.
use crate::march::step;
use crate::{Side, Sight};
use tracer::{Quest, roots};

/// Finds the first crossing that the quest asks for.
pub(crate) fn first(sight: &mut Sight<'_>, quest: Quest) -> Option<f64> {
    let [from, to] = sight.range;
    let step = step(sight);
    let mut side = Side::unknown(quest);
    let mut first = sight.excess(from).0;
    side.arrive(first > 0.0);
    let mut start = from;
    while start < to {
        let mut samples = [first; 5];
        for (i, sample) in samples.iter_mut().enumerate().skip(1) {
            *sample = sight.excess(start + i as f64 * step).0;
        }
        first = samples[4];
        let polynomial = interpolate(samples);
        let found = roots(&polynomial, 0.0, 4.0);
        let found = found.as_slice();
        for (i, &root) in found.iter().enumerate() {
            let next = found.get(i + 1).copied().unwrap_or(4.0);
            let x = 0.5 * (root + next);
            let value = polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c);
            if side.arrive(value > 0.0) {
                return Some(start + root * step);
            }
        }
        start += 4.0 * step;
        // A root on the border counts once, where the sign changes.
        if side.arrive(first > 0.0) {
            return Some(start);
        }
    }
    None
}

/// Returns the coefficients, by powers of x, of the polynomial through samples at x = 0 … 4 (by
/// Newton's forward differences).
fn interpolate(samples: [f64; 5]) -> [f64; 5] {
    let mut d = samples;
    for order in 1..5 {
        for i in (order..5).rev() {
            d[i] -= d[i - 1];
        }
    }
    [
        d[0],
        d[1] - d[2] / 2.0 + d[3] / 3.0 - d[4] / 4.0,
        d[2] / 2.0 - d[3] / 2.0 + 11.0 * d[4] / 24.0,
        d[3] / 6.0 - d[4] / 4.0,
        d[4] / 24.0,
    ]
}
