//! The field of segments, and the distance it stands for.

use glam::DVec3;

/// Value and gradient of `∫ ds/|p − s|³` over the segment from `a` to `b`.
///
/// With `A = |p − a|`, `B = |p − b|` and the segment's length l the integral is
/// `l(A + B)/(AB(AB + (p − a)·(p − b)))`, which is without a pole beyond the segment's ends. On the
/// segment itself, where it has none, the value is large and finite.
///
/// ```
/// use glam::DVec3;
///
/// // Of an endless line it is 2/ρ².
/// let (p, end) = (DVec3::new(0.0, 2.0, 0.0), DVec3::X * 1e4);
/// let (value, gradient) = motion::line(p, -end, end);
/// assert!((value - 0.5).abs() < 1e-6);
/// assert!((gradient - DVec3::new(0.0, -0.5, 0.0)).length() < 1e-6);
/// ```
#[must_use]
pub fn line(p: DVec3, a: DVec3, b: DVec3) -> (f64, DVec3) {
    End::new(p, a).line(&End::new(p, b), a.distance(b))
}

/// View of a point from an end of a segment: the terms that all segments which meet there share.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Vector from the end to the point, its length, and the unit vector in its direction.
    to: DVec3,
    distance: f64,
    unit: DVec3,
    /// The unit vector by the distance.
    bend: DVec3,
}

impl End {
    /// The end `a`, seen by a point.
    pub fn new(p: DVec3, a: DVec3) -> Self {
        let to = p - a;
        let distance = to.length();
        let unit = to / distance;
        Self {
            to,
            distance,
            unit,
            bend: unit / distance,
        }
    }

    /// Computes [`line`] of the segment to another end.
    pub fn line(&self, other: &Self, length: f64) -> (f64, DVec3) {
        let (ra, rb) = (self.distance, other.distance);
        let product = ra * rb;
        // On the axis the sum is all rounding.
        let least = 1e-10 * product;
        let sum = (product + self.to.dot(other.to)).max(least);
        if sum <= 0.0 {
            return (0.0, DVec3::ZERO);
        }
        let value = length * (ra + rb) / (product * sum);
        let (ua, ub) = (self.unit, other.unit);
        let slope = (ua + ub) / (ra + rb)
            - self.bend
            - other.bend
            - (ua * rb + ub * ra + self.to + other.to) / sum;
        (value, slope * value)
    }
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
