//! The wall of a cylinder, without lids.
use super::Crossing;
use super::cylinder::{Wall, wall};
use crate::ray::Ray;
use glam::DVec3;

/// The points at the radius from the axis whose foot on it lies between its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pipe {
    base: DVec3,
    axis: DVec3,
    length: f64,
    radius: f64,
}

impl Pipe {
    /// Prepares the shape; `None` unless radius and length are positive and all numbers are finite.
    #[must_use]
    pub fn new(base: DVec3, apex: DVec3, radius: f64) -> Option<Self> {
        let axis = (apex - base).try_normalize()?;
        (base.is_finite() && apex.is_finite() && radius > 0.0).then_some(Self {
            base,
            axis,
            length: base.distance(apex),
            radius,
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if let Wall::Between(enter, leave) = wall(ray, self.base, self.axis, self.radius) {
            for crossing in [enter, leave] {
                let along = (ray.at(crossing.t) - self.base).dot(self.axis);
                if (0.0..=self.length).contains(&along) {
                    out.push(crossing);
                }
            }
        }
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        let half = 0.5 * self.length;
        (
            self.base + self.axis * half,
            (half * half + self.radius * self.radius).sqrt(),
        )
    }
}
