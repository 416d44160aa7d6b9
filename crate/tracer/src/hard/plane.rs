//! A plane, or a slab of even thickness.
use super::{Clip, Crossing};
use crate::ray::Ray;
use glam::DVec3;

/// The points no further from a plane than `half`; a sheet when that is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: DVec3,
    normal: DVec3,
    half: f64,
}

impl Plane {
    /// Prepares the shape; `None` unless the normal has a direction and all numbers are finite.
    #[must_use]
    pub fn new(point: DVec3, normal: DVec3, half: f64) -> Option<Self> {
        let normal = normal.try_normalize()?;
        (point.is_finite() && half >= 0.0).then_some(Self {
            point,
            normal,
            half,
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if self.half > 0.0 {
            let mut clip = Clip::whole_line();
            let offset = self.normal * self.half;
            clip.half_space(ray, self.point + offset, self.normal);
            clip.half_space(ray, self.point - offset, -self.normal);
            clip.finish(out);
            return;
        }
        let rate = ray.direction.dot(self.normal);
        let t = (self.point - ray.origin).dot(self.normal) / rate;
        if t.is_finite() {
            out.push(Crossing {
                t,
                normal: self.normal,
            });
        }
    }
}
