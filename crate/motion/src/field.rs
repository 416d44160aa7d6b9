//! The field of segments, and the distance it stands for.

use glam::DVec3;

/// Value and gradient of `∫ ds/|p − s|³` over the segment from `a` to `b`.
///
/// With `A = |p − a|`, `B = |p − b|` and the segment's length l the integral is `l(A + B)/(AB(AB + (p − a)·(p − b)))`, which is
/// without a pole beyond the segment's ends. On the segment itself, where it has none, the value is large and finite.
///
/// ```
/// use glam::DVec3;
///
/// // Of an endless line it is 2/ρ².
/// let (value, gradient) = motion::line(DVec3::new(0.0, 2.0, 0.0), DVec3::X * -1e4, DVec3::X * 1e4);
/// assert!((value - 0.5).abs() < 1e-6);
/// assert!((gradient - DVec3::new(0.0, -0.5, 0.0)).length() < 1e-6);
/// ```
#[must_use]
pub fn line(p: DVec3, a: DVec3, b: DVec3) -> (f64, DVec3) {
    let (to_a, to_b) = (p - a, p - b);
    let (ra, rb) = (to_a.length(), to_b.length());
    let product = ra * rb;
    let length = a.distance(b);
    // On the axis the sum is all rounding.
    let least = 1e-10 * product;
    let sum = (product + to_a.dot(to_b)).max(least);
    if sum <= 0.0 {
        return (0.0, DVec3::ZERO);
    }
    let value = length * (ra + rb) / (product * sum);
    let (ua, ub) = (to_a / ra, to_b / rb);
    let slope = (ua + ub) / (ra + rb) - ua / ra - ub / rb - (ua * rb + ub * ra + to_a + to_b) / sum;
    (value, slope * value)
}

/// The distance from an endless line whose field `∫ ds/d³` has this value: `√(2/value)`.
///
/// ```
/// assert_eq!(motion::distance(0.5), 2.0);
/// ```
#[must_use]
pub fn distance(value: f64) -> f64 {
    (2.0 / value).sqrt()
}
