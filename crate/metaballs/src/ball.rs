//! Spherical metaballs: the ball around a facet's circumcircle.

use field::Real;
use field::real::Scalar;
use glam::DVec3;

/// Ball in one precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball<S> {
    center: [S; 3],
    /// Radius ρ of the circle.
    radius: S,
}

impl<S: Scalar> Ball<S> {
    pub fn new((center, radius): (DVec3, f64)) -> Self {
        Self {
            center: center.to_array().map(S::round),
            radius: S::round(radius),
        }
    }

    /// Returns the vector from the centre to a point, and ρ.
    #[inline(always)]
    pub fn offset<R: Real<Scalar = S>>(&self, point: [R; 3]) -> ([R; 3], R) {
        let offset = core::array::from_fn(|i| point[i] - R::lift(self.center[i]));
        (offset, R::lift(self.radius))
    }
}

/// Returns the centre and radius of a triangle's circumcircle.
///
/// Where an angle is above 150° the circle would be larger than the longest side L and grow without
/// bound: then it is the circle of the radius L through that side's ends, whose centre lies on the
/// side where the circumcentre does. A triangle without area has one on any side; one that is a
/// point, a radius of 0.
///
/// ```
/// use glam::DVec3;
///
/// let right_angled = [DVec3::ZERO, 4.0 * DVec3::X, 3.0 * DVec3::Y];
/// let (center, radius) = metaballs::circumcircle(&right_angled);
/// assert!(center.distance(DVec3::new(2.0, 1.5, 0.0)) < 1e-15);
/// assert!((radius - 2.5).abs() < 1e-15);
/// ```
#[must_use]
pub fn circumcircle(corners: &[DVec3; 3]) -> (DVec3, f64) {
    // From the longest side: base to tip, and the corner opposite.
    let [a, b, c] = *corners;
    let sides = [(a, b, c), (b, c, a), (c, a, b)];
    let (mut base, mut tip, mut opposite) = sides[0];
    for (from, to, third) in &sides[1..] {
        if from.distance_squared(*to) > base.distance_squared(tip) {
            (base, tip, opposite) = (*from, *to, *third);
        }
    }
    let side = tip - base;
    let length = side.length();
    if length == 0.0 {
        return (base, 0.0);
    }
    let middle = 0.5 * (base + tip);
    let along = side / length;
    let from_middle = opposite - middle;
    let across = from_middle - along * from_middle.dot(along);
    let height = across.length();
    let half = 0.5 * length;
    // Of points `middle + t·across/height`, equally far from `base` and the corner.
    let largest = half * 3f64.sqrt();
    let t = (from_middle.length_squared() - half * half) / (2.0 * height);
    let direction = across
        .try_normalize()
        .unwrap_or_else(|| along.any_orthonormal_vector());
    let t = if t.is_nan() {
        -largest
    } else {
        t.clamp(-largest, largest)
    };
    let radius = (half * half + t * t).sqrt();
    (middle + direction * t, radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circle_passes_through_the_corners() {
        let corners = [
            DVec3::new(0.3, -1.0, 2.0),
            DVec3::new(1.3, 0.2, 2.5),
            DVec3::new(0.1, 0.4, 1.0),
        ];
        for corners in [corners, [corners[1], corners[0], corners[2]]] {
            let (center, radius) = circumcircle(&corners);
            for corner in corners {
                assert!((center.distance(corner) - radius).abs() < 1e-14);
            }
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            assert!((center - corners[0]).dot(normal).abs() < 1e-14);
        }
    }

    #[test]
    fn slivers_have_a_circle_no_larger_than_their_longest_side() {
        for height in [0.2, 0.1, 1e-3, 1e-9, 1e-300, 0.0] {
            let corners = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::new(0.9, height, 0.0)];
            let (center, radius) = circumcircle(&corners);
            assert!((1.0..=2.0 + 1e-12).contains(&radius), "{height}");
            assert!((center.length() - radius).abs() < 1e-12);
        }
        let (center, radius) = circumcircle(&[DVec3::ONE; 3]);
        assert_eq!((center, radius), (DVec3::ONE, 0.0));
    }
}
