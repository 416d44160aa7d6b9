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
        match wall(ray, self.base, self.axis, self.radius) {
            Wall::Outside => return,
            Wall::Inside => {}
            Wall::Between(enter, leave) => clip.stretch(enter, leave),
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

/// Part of a ray's line within an infinite cylinder.
pub(super) enum Wall {
    /// Nowhere.
    Outside,
    /// Everywhere: it runs along the axis.
    Inside,
    /// From where it enters to where it leaves.
    Between(Crossing, Crossing),
}

/// Meets the endless cylinder about an axis through `base`, a unit vector, in the plane across it.
pub(super) fn wall(ray: &Ray, base: DVec3, axis: DVec3, radius: f64) -> Wall {
    let across = |v: DVec3| v - axis * v.dot(axis);
    let start = across(ray.origin - base);
    let rate = across(ray.direction);
    let speed = rate.length();
    if speed > 0.0 {
        let way = rate / speed;
        let nearest = -start.dot(way);
        let half = radius * radius - (start + way * nearest).length_squared();
        if half <= 0.0 {
            return Wall::Outside;
        }
        let half = half.sqrt();
        let at = |s: f64| Crossing {
            t: s / speed,
            normal: (start + way * s) / radius,
        };
        Wall::Between(at(nearest - half), at(nearest + half))
    } else if start.length_squared() >= radius * radius {
        Wall::Outside
    } else {
        Wall::Inside
    }
}
