//! Real roots of polynomials of low degree inside an interval.
//!
//! Between two neighbouring roots of its derivative a polynomial is monotone, so it has at most one
//! root there, which a change of sign shows. Going down the derivatives therefore finds every
//! crossing, with no closed formula that could lose digits and no case that fails. A root where
//! the polynomial touches zero without changing sign is not a crossing and is not reported.

/// Largest degree that [`roots`] takes.
pub const MAX_DEGREE: usize = 4;

/// Roots in ascending order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Roots {
    values: [f64; MAX_DEGREE],
    count: usize,
}

impl Roots {
    /// Returns a single root.
    #[must_use]
    pub fn one(value: f64) -> Self {
        let mut roots = Self::default();
        roots.push(value);
        roots
    }

    /// Returns the roots as a slice.
    #[must_use]
    pub fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }

    fn push(&mut self, value: f64) {
        if self.count < MAX_DEGREE {
            self.values[self.count] = value;
            self.count += 1;
        }
    }
}

/// Returns the values of x in `from..=to` where `Σ coefficients[i]·xⁱ` changes sign, ascending.
///
/// At most [`MAX_DEGREE`]` + 1` coefficients are read. An end of the interval counts when the
/// polynomial is exactly zero there, with or without a sign change: roots on the border of two
/// intervals are reported for both.
#[must_use]
pub fn roots(coefficients: &[f64], from: f64, to: f64) -> Roots {
    let n = coefficients.len().min(MAX_DEGREE + 1);
    let c = &coefficients[..n];
    let mut found = Roots::default();
    if n < 2 || from.is_nan() || to.is_nan() || from > to {
        return found;
    }
    if n == 2 {
        let x = -c[0] / c[1];
        if x >= from && x <= to {
            found.push(x);
        }
        return found;
    }
    let mut derivative = [0.0; MAX_DEGREE];
    for i in 1..n {
        derivative[i - 1] = c[i] * i as f64;
    }
    let turns = roots(&derivative[..n - 1], from, to);
    let mut left = from;
    let mut at_left = value(c, left);
    if at_left == 0.0 {
        found.push(left);
    }
    for &right in turns.as_slice().iter().chain([&to]) {
        let at_right = value(c, right);
        if at_right == 0.0 {
            if right > left {
                found.push(right);
            }
        } else if (at_left < 0.0 && at_right > 0.0) || (at_left > 0.0 && at_right < 0.0) {
            found.push(refine_root(
                |x| (value(c, x), value(&derivative[..n - 1], x)),
                left,
                right,
                0.0,
            ));
        }
        left = right;
        at_left = at_right;
    }
    found
}

/// Computes a polynomial's value by Horner's rule.
fn value(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &a| sum * x + a)
}

/// Finds the root between `a` and `b` of a function that changes sign there; `f` returns its value
/// and derivative. Newton's steps are kept inside a bracket that shrinks, so they always converge.
///
/// Stops when the bracket is narrower than `tolerance` or cannot shrink.
pub fn refine_root(f: impl FnMut(f64) -> (f64, f64), a: f64, b: f64, tolerance: f64) -> f64 {
    refine_root_from(f, [a, b], 0.5 * (a + b), tolerance)
}

/// [`refine_root`] with a first guess between.
pub fn refine_root_from(
    mut f: impl FnMut(f64) -> (f64, f64),
    [mut low, mut high]: [f64; 2],
    start: f64,
    tolerance: f64,
) -> f64 {
    let low_is_negative = f(low).0 < 0.0;
    let mut x = start;
    let mut width = high - low;
    for _ in 0..200 {
        let (value, slope) = f(x);
        if value == 0.0 {
            return x;
        }
        if (value < 0.0) == low_is_negative {
            low = x;
        } else {
            high = x;
        }
        if high - low <= tolerance {
            break;
        }
        let newton = x - value / slope;
        let halved = (high - low) < 0.5 * width;
        width = high - low;
        let next = if newton > low && newton < high && (halved || (newton - x).abs() < 0.25 * width)
        {
            newton
        } else {
            0.5 * (low + high)
        };
        if next == x || next <= low || next >= high {
            break;
        }
        // Newton closes in from one side only: when its step is within the tolerance, done.
        if (next - x).abs() <= tolerance {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Random, count};

    fn multiply(c: &[f64], root: f64) -> Vec<f64> {
        let mut out = vec![0.0; c.len() + 1];
        for (i, &a) in c.iter().enumerate() {
            out[i + 1] += a;
            out[i] -= a * root;
        }
        out
    }

    #[test]
    fn roots_of_built_polynomials_come_back() {
        let mut random = Random::new(7);
        for case in 0..count(20_000) {
            let degree = 1 + case % MAX_DEGREE;
            let mut wanted: Vec<f64> = (0..degree).map(|_| 3.0 * random.unit() - 1.0).collect();
            wanted.sort_unstable_by(f64::total_cmp);
            if wanted.windows(2).any(|w| w[1] - w[0] < 1e-3) {
                continue;
            }
            let c = wanted
                .iter()
                .fold(vec![4.0 * random.unit() - 2.0], |c, &r| multiply(&c, r));
            let found = roots(&c, 0.0, 1.0);
            let wanted: Vec<f64> = wanted
                .into_iter()
                .filter(|&r| (0.0..=1.0).contains(&r))
                .collect();
            assert_eq!(found.as_slice().len(), wanted.len(), "{c:?}");
            for (a, b) in found.as_slice().iter().zip(&wanted) {
                assert!((a - b).abs() < 1e-7, "{a} {b} {c:?}");
            }
        }
    }

    #[test]
    fn polynomials_without_a_crossing_have_no_roots() {
        assert!(roots(&[1.0, 0.0, 1.0], -5.0, 5.0).as_slice().is_empty());
        assert!(roots(&[0.0, 0.0, 0.0], 0.5, 0.25).as_slice().is_empty());
        assert!(roots(&[3.0], 0.0, 1.0).as_slice().is_empty());
        // Vanishing leading coefficients.
        assert_eq!(roots(&[-0.5, 1.0, 0.0, 0.0], 0.0, 1.0).as_slice(), [0.5]);
        for bad in [f64::NAN, f64::INFINITY] {
            let _ = roots(&[bad, 1.0, bad, 2.0, 1.0], 0.0, 1.0);
        }
    }
}
