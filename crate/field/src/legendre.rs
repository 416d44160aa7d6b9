//! Gauss–Legendre rules.
//!
//! The rule with n nodes integrates polynomials of degree 2n−1 over [−1, 1] exactly. Its nodes are
//! the roots of Legendre's polynomial Pₙ, found by Newton's method from the estimate
//! `cos(π(i−¼)/(n+½))`; the weights are `2/((1−x²)Pₙ′(x)²)`. All of it is evaluated at compile
//! time.
use crate::Real;
use core::f64::consts::PI;

/// The positive nodes and their weights of the rule with 2·`HALF` nodes, the largest first; each
/// stands for two, x and −x.
pub const fn pairs<const HALF: usize>() -> [(f64, f64); HALF] {
    let mut pairs = [(0.0, 0.0); HALF];
    let mut i = 0;
    while i < HALF {
        let n = 2 * HALF;
        let mut x = cosine(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
        let mut step = 0;
        let mut slope = 0.0;
        // A step doubles the digits, of which the estimate has three or more.
        while step < 5 {
            let (value, derivative) = legendre(n, x);
            slope = derivative;
            x -= value / slope;
            step += 1;
        }
        pairs[i] = (x, 2.0 / ((1.0 - x * x) * slope * slope));
        i += 1;
    }
    pairs
}

/// Selects the rule for R's precision.
#[inline(always)]
pub fn choose<R: Real>(
    single: &'static [(f64, f64)],
    double: &'static [(f64, f64)],
) -> &'static [(f64, f64)] {
    if R::DOUBLE { double } else { single }
}

/// Pₙ(x) and its derivative.
const fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    let mut k = 2;
    while k <= n {
        let next = ((2 * k - 1) as f64 * x * value - (k - 1) as f64 * before) / k as f64;
        before = value;
        value = next;
        k += 1;
    }
    (value, n as f64 * (x * value - before) / (x * x - 1.0))
}

/// Cosine for 0 ≤ x ≤ π/2, to the accuracy of a starting value.
const fn cosine(x: f64) -> f64 {
    let q = x * x;
    1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integrates_powers<const HALF: usize>() {
        let rule = pairs::<HALF>();
        for power in 0..2 * HALF as i32 {
            // Even powers only: the others vanish by symmetry.
            let degree = 2 * power;
            let sum: f64 = rule.iter().map(|(x, w)| 2.0 * w * x.powi(degree)).sum();
            let want = 2.0 / f64::from(degree + 1);
            assert!((sum - want).abs() < 4e-15, "{HALF} {degree}: {sum} {want}");
        }
    }

    #[test]
    fn exact_for_polynomials() {
        integrates_powers::<1>();
        integrates_powers::<2>();
        integrates_powers::<3>();
        integrates_powers::<6>();
        integrates_powers::<8>();
        integrates_powers::<20>();
    }
}
