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
    /// `None` unless radius and length are positive and all numbers are finite.
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

    /// See [`super::Solid::crossings`].
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let mut clip = Clip::whole_line();
        clip.half_space(ray, self.base, -self.axis);
        clip.half_space(ray, self.apex, self.axis);
        // The infinite cylinder, in the plane across the axis.
        let across = |v: DVec3| v - self.axis * v.dot(self.axis);
        let start = across(ray.origin - self.base);
        let rate = across(ray.direction);
        let speed = rate.length();
        if speed > 0.0 {
            let way = rate / speed;
            let nearest = -start.dot(way);
            let half = self.radius * self.radius - (start + way * nearest).length_squared();
            if half <= 0.0 {
                return;
            }
            let half = half.sqrt();
            let at = |s: f64| Crossing {
                t: s / speed,
                normal: (start + way * s) / self.radius,
            };
            let (enter, leave) = (at(nearest - half), at(nearest + half));
            if enter.t > clip.enter.t {
                clip.enter = enter;
            }
            if leave.t < clip.leave.t {
                clip.leave = leave;
            }
        } else if start.length_squared() >= self.radius * self.radius {
            return;
        }
        clip.finish(out);
    }

    /// See [`super::Solid::ball`].
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        let half = 0.5 * self.base.distance(self.apex);
        (
            0.5 * (self.base + self.apex),
            (half * half + self.radius * self.radius).sqrt(),
        )
    }
}
