//! A box, which may be turned and sheared.
use super::{Clip, Crossing};
use crate::ray::Ray;
use glam::DVec3;
use scene::quadric::inverse;

/// The points `center + Σ sᵢ·axisᵢ` with −1 ≤ sᵢ ≤ 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    center: DVec3,
    axes: [DVec3; 3],
    /// Unit normals of the faces at the axes' ends.
    normals: [DVec3; 3],
}

impl Cuboid {
    /// Prepares the shape; `None` unless the axes span a volume and all numbers are finite.
    #[must_use]
    pub fn new(center: DVec3, axes: [DVec3; 3]) -> Option<Self> {
        // A face's normal is across the other two axes: the rows of the inverse.
        let rows = inverse(axes)?.transpose();
        let [x, y, z] = [rows.x_axis, rows.y_axis, rows.z_axis].map(DVec3::try_normalize);
        center.is_finite().then_some(Self {
            center,
            axes,
            normals: [x?, y?, z?],
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let mut clip = Clip::whole_line();
        for (axis, normal) in self.axes.iter().zip(self.normals) {
            clip.half_space(ray, self.center + *axis, normal);
            clip.half_space(ray, self.center - *axis, -normal);
        }
        clip.finish(out);
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        (self.center, reach(self.axes))
    }
}

/// Returns the distance from the middle of a box to its furthest corner.
pub(super) fn reach([x, y, z]: [DVec3; 3]) -> f64 {
    let corners = [x + y + z, x + y - z, x - y + z, x - y - z];
    corners.map(DVec3::length).into_iter().fold(0.0, f64::max)
}
