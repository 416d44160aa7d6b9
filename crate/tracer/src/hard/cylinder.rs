//! A cylinder with flat lids.
use super::{Clip, Crossing};
use crate::ray::Ray;
use glam::DVec3;

/// The points whose foot on the axis lies between its ends, no further from it than the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    base: DVec3,
    apex: DVec3,
    axis: DVec3,
    radius: f64,
}

impl Cylinder {
    /// Prepares the shape; `None` unless radius and length are positive and all numbers are finite.
    #[must_use]
    pub fn new(base: DVec3, apex: DVec3, radius: f64) -> Option<Self> {
        let axis = (apex - base).try_normalize()?;
        (base.is_finite() && apex.is_finite() && radius > 0.0).then_some(Self {
            base,
            apex,
            axis,
            radius,
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let mut clip = Clip::whole_line();
        clip.half_space(ray, self.base, -self.axis);
        clip.half_space(ray, self.apex, self.axis);
        match wall(ray, self.base, self.axis, self.radius) {
            Wall::Outside => return,
            Wall::Inside => {}
            Wall::Between(enter, leave) => clip.stretch(enter, leave),
        }
        clip.finish(out);
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        let half = 0.5 * self.base.distance(self.apex);
        (
            0.5 * (self.base + self.apex),
            (half * half + self.radius * self.radius).sqrt(),
        )
    }
}

/// The part of a ray's line within an infinite cylinder.
pub(super) enum Wall {
    /// Nothing of the line.
    Outside,
    /// The whole line, which runs along the axis.
    Inside,
    /// The part between the crossings where it enters and where it leaves.
    Between(Crossing, Crossing),
}

/// Finds the part of a ray's line within the infinite cylinder around an axis, a unit vector,
/// through `base`. It is computed in the plane across the axis.
pub(super) fn wall(ray: &Ray, base: DVec3, axis: DVec3, radius: f64) -> Wall {
    let [start, rate] = [ray.origin - base, ray.direction].map(|v| v - axis * v.dot(axis));
    let speed = rate.length();
    if speed > 0.0 {
        let way = rate / speed;
        let nearest = -start.dot(way);
        let half = radius * radius - (start + way * nearest).length_squared();
        if half <= 0.0 {
            return Wall::Outside;
        }
        let half = half.sqrt();
        let [enter, leave] = [nearest - half, nearest + half].map(|s| Crossing {
            t: s / speed,
            normal: (start + way * s) / radius,
        });
        Wall::Between(enter, leave)
    } else if start.length_squared() >= radius * radius {
        Wall::Outside
    } else {
        Wall::Inside
    }
}
