//! A point.
use super::{Geometry, Map, Skeleton};
use crate::Kernel;
use crate::bone::Bone;
use crate::term::{Frame, frame};
use glam::{DMat3, DVec3};

pub(super) struct Point {
    pub center: DVec3,
}

impl Geometry for Point {
    fn name(&self) -> &'static str {
        "point"
    }

    fn dimension(&self) -> u8 {
        0
    }

    fn measure(&self) -> f64 {
        1.0
    }

    fn nearest(&self, _: DVec3) -> DVec3 {
        self.center
    }

    fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        Some((self.center, 0.0))
    }

    fn middle(&self) -> DVec3 {
        self.center
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        vec![(self.center, "the centre")]
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        let center = map.point(self.center);
        Skeleton::Point { center }
    }

    fn place(&self, _: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
        (frame(self.center, DMat3::IDENTITY, s), Bone::Point)
    }
}
