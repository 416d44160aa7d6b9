//! An infinite plane.
use super::{Geometry, Map, Skeleton, fits, polygon};
use crate::Kernel;
use crate::bone::Bone;
use crate::term::{Frame, frame};
use glam::{DMat3, DVec3};

pub(super) struct Plane {
    pub point: DVec3,
    pub normal: DVec3,
}

impl Geometry for Plane {
    fn name(&self) -> &'static str {
        "plane"
    }

    fn dimension(&self) -> u8 {
        2
    }

    fn measure(&self) -> f64 {
        f64::INFINITY
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        let n = self.normal.try_normalize().unwrap_or(DVec3::Z);
        point - n * n.dot(point - self.point)
    }

    fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        None
    }

    fn bounds(&self, _: f64) -> Option<(DVec3, DVec3)> {
        None
    }

    fn middle(&self) -> DVec3 {
        self.point
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        vec![(self.point, "a point of the plane")]
    }

    fn is_within(&self, limit: f64) -> bool {
        fits(self.point, limit) && self.normal.is_finite()
    }

    fn normal(&self) -> Option<DVec3> {
        self.normal.try_normalize()
    }

    /// A square of the plane, and the normal.
    fn lines(&self, size: f64) -> Vec<Vec<DVec3>> {
        let (u, v) = self.normal.any_orthonormal_pair();
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let corners = corners.map(|(a, b)| self.point + (u * a + v * b) * size);
        vec![
            polygon::close(&corners),
            vec![self.point, self.point + self.normal * size],
        ]
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        Skeleton::Plane {
            point: map.point(self.point),
            normal: map.normal(self.normal),
        }
    }

    fn place(&self, _: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
        let z = self.normal.try_normalize().unwrap_or(DVec3::Z);
        let x = z.any_orthonormal_vector();
        (
            frame(self.point, DMat3::from_cols(x, z.cross(x), z), s),
            Bone::Plane,
        )
    }
}
