//! A triangle, flat or as a prism of even thickness.
use super::{Clip, Crossing};
use crate::ray::Ray;
use glam::DVec3;

/// The points whose foot lies in a triangle and which are no further from it than `half`; a sheet
/// when that is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prism {
    corners: [DVec3; 3],
    normal: DVec3,
    /// Unit vectors in the plane, across each edge, outwards; edge i starts at corner i.
    sides: [DVec3; 3],
    half: f64,
}

impl Prism {
    /// Prepares the shape; `None` unless the triangle has an area and all numbers are finite.
    #[must_use]
    pub fn new(corners: [DVec3; 3], half: f64) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let [ab, bc, ca] = [b - a, c - b, a - c].map(|edge| edge.cross(normal).try_normalize());
        (corners.iter().all(|c| c.is_finite()) && half >= 0.0).then_some(Self {
            corners,
            normal,
            sides: [ab?, bc?, ca?],
            half,
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        if self.half > 0.0 {
            let mut clip = Clip::whole_line();
            let offset = self.normal * self.half;
            clip.half_space(ray, self.corners[0] + offset, self.normal);
            clip.half_space(ray, self.corners[0] - offset, -self.normal);
            for (corner, side) in self.corners.iter().zip(self.sides) {
                clip.half_space(ray, *corner, side);
            }
            clip.finish(out);
            return;
        }
        let rate = ray.direction.dot(self.normal);
        let t = (self.corners[0] - ray.origin).dot(self.normal) / rate;
        if !t.is_finite() {
            return;
        }
        let p = ray.at(t);
        let mut sides = self.corners.iter().zip(self.sides);
        if sides.all(|(corner, side)| (p - *corner).dot(side) <= 0.0) {
            out.push(Crossing {
                t,
                normal: self.normal,
            });
        }
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        let center = self.corners.iter().sum::<DVec3>() / 3.0;
        let reach = self
            .corners
            .iter()
            .map(|c| c.distance(center))
            .fold(0.0, f64::max);
        (center, (reach * reach + self.half * self.half).sqrt())
    }
}
