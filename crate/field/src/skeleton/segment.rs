//! A line segment.
use super::{Geometry, Map, Skeleton};
use crate::Kernel;
use crate::bone::{self, Bone};
use crate::term::{Frame, frame};
use glam::{DMat3, DVec3};

pub(super) struct Segment {
    pub base: DVec3,
    pub apex: DVec3,
}

impl Geometry for Segment {
    fn name(&self) -> &'static str {
        "segment"
    }

    fn dimension(&self) -> u8 {
        1
    }

    fn measure(&self) -> f64 {
        (self.apex - self.base).length()
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        nearest(point, self.base, self.apex)
    }

    fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        let Self { base, apex } = *self;
        Some(((base + apex) / 2.0, (apex - base).length() / 2.0))
    }

    fn middle(&self) -> DVec3 {
        (self.base + self.apex) * 0.5
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        vec![(self.base, "the base"), (self.apex, "the apex")]
    }

    fn fault(&self) -> Option<&'static str> {
        (self.base == self.apex).then_some("'s ends are the same point")
    }

    fn at(&self, share: f64) -> DVec3 {
        self.base.lerp(self.apex, share)
    }

    fn tangent(&self, _: f64) -> Option<DVec3> {
        (self.apex - self.base).try_normalize()
    }

    fn lines(&self, _: f64) -> Vec<Vec<DVec3>> {
        vec![vec![self.base, self.apex]]
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        let [base, apex] = [self.base, self.apex].map(|p| map.point(p));
        Skeleton::Segment { base, apex }
    }

    fn part(&self, from: f64, to: f64) -> Option<Skeleton> {
        let [base, apex] = [from, to].map(|share| self.at(share));
        Some(Skeleton::Segment { base, apex })
    }

    fn place(&self, _: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
        let Self { base, apex } = *self;
        let x = (apex - base).try_normalize().unwrap_or(DVec3::X);
        let y = x.any_orthonormal_vector();
        let half = s * (apex - base).length() / 2.0;
        (
            frame((base + apex) / 2.0, DMat3::from_cols(x, y, x.cross(y)), s),
            Bone::Segment(bone::Segment { half }),
        )
    }

    fn cubics(&self, _: f64) -> Vec<[DVec3; 4]> {
        vec![[0.0, 1.0, 2.0, 3.0].map(|i| self.base + (self.apex - self.base) * (i / 3.0))]
    }
}

/// The point of a segment nearest to `point`.
pub(crate) fn nearest(point: DVec3, base: DVec3, apex: DVec3) -> DVec3 {
    let d = apex - base;
    let square = d.length_squared();
    if square == 0.0 {
        return base;
    }
    base + d * ((point - base).dot(d) / square).clamp(0.0, 1.0)
}
