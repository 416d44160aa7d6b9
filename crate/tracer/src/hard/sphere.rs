//! A ball.
use super::Crossing;
use crate::ray::Ray;
use glam::DVec3;

/// A ball: `|p − center| ≤ radius`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

impl Sphere {
    /// Prepares the shape; `None` unless the radius is positive and all numbers are finite.
    #[must_use]
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        (center.is_finite() && radius > 0.0).then_some(Self { center, radius })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let to_center = self.center - ray.origin;
        let nearest = to_center.dot(ray.direction);
        // The squared distance from the line, by the foot of the perpendicular: for a far eye the
        // difference of the squared lengths would lose its digits.
        let across = (to_center - ray.direction * nearest).length_squared();
        let half = self.radius * self.radius - across;
        if half > 0.0 {
            let half = half.sqrt();
            for t in [nearest - half, nearest + half] {
                let normal = (ray.at(t) - self.center) / self.radius;
                out.push(Crossing { t, normal });
            }
        }
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        (self.center, self.radius)
    }
}
