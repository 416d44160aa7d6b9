//! A triangle.
use super::{Geometry, Map, Skeleton, nearest_of, polygon, segment};
use crate::Kernel;
use crate::bone::{self, Bone};
use crate::term::{Frame, frame};
use glam::{DMat3, DVec3};

pub(super) struct Triangle {
    pub corners: [DVec3; 3],
}

impl Geometry for Triangle {
    fn name(&self) -> &'static str {
        "triangle"
    }

    fn dimension(&self) -> u8 {
        2
    }

    fn measure(&self) -> f64 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).length() / 2.0
    }

    fn size(&self) -> f64 {
        let [a, b, c] = self.corners;
        (b - a).length().max((c - a).length())
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        let (e1, e2) = (b - a, c - a);
        let normal = e1.cross(e2);
        let area = normal.length_squared();
        let d = point - a;
        let v = normal.dot(e1.cross(d)) / area;
        let u = normal.dot(d.cross(e2)) / area;
        // The edges are tested in any case: for a needle's interior u and v are uncertain.
        let inside = area > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| segment::nearest(point, p, q));
        let inside = inside.then(|| a + e1 * u + e2 * v);
        nearest_of(point, edges.into_iter().chain(inside)).unwrap_or(a)
    }

    /// The sphere over the longest side, if the opposite corner is in that, else around.
    fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        let [a, b, c] = self.corners;
        let (p, q, r) = [(a, b, c), (b, c, a), (c, a, b)]
            .into_iter()
            .max_by(|x, y| {
                x.0.distance_squared(x.1)
                    .total_cmp(&y.0.distance_squared(y.1))
            })
            .unwrap_or((a, b, c));
        let middle = (p + q) / 2.0;
        let half = (q - p).length() / 2.0;
        if r.distance(middle) <= half {
            return Some((middle, half));
        }
        let (e1, e2) = (q - p, r - p);
        let normal = e1.cross(e2);
        let offset = (e1.length_squared() * e2.cross(normal)
            + e2.length_squared() * normal.cross(e1))
            / (2.0 * normal.length_squared());
        Some((p + offset, offset.length() * (1.0 + 1e-12)))
    }

    fn middle(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / 3.0
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        self.corners.map(|corner| (corner, "a corner")).into()
    }

    fn fault(&self) -> Option<&'static str> {
        let [a, b, c] = self.corners;
        let (ab, ac) = (b - a, c - a);
        let is_line = ab.cross(ac).length() <= 1e-12 * ab.length() * ac.length();
        is_line.then_some(" has no area")
    }

    fn normal(&self) -> Option<DVec3> {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).try_normalize()
    }

    fn samples(&self) -> Vec<DVec3> {
        let middle = self.middle();
        let halfway = self.corners.map(|corner| middle.lerp(corner, 0.5));
        [middle].into_iter().chain(halfway).collect()
    }

    fn lines(&self, _: f64) -> Vec<Vec<DVec3>> {
        vec![polygon::close(&self.corners)]
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        let corners = self.corners.map(|corner| map.point(corner));
        Skeleton::Triangle { corners }
    }

    fn place(&self, _: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
        let [a, b, c] = self.corners;
        // The normal is best conditioned at the corner opposite the longest side; which one
        // matters only for slivers.
        let x = [b - a, c - b, a - c]
            .into_iter()
            .max_by(|p, q| p.length_squared().total_cmp(&q.length_squared()))
            .and_then(DVec3::try_normalize)
            .unwrap_or(DVec3::X);
        let normal = (b - a).cross(c - a);
        let z = (normal - x * normal.dot(x))
            .try_normalize()
            .unwrap_or_else(|| x.any_orthonormal_vector());
        let axes = DMat3::from_cols(x, z.cross(x), z);
        let origin = a + ((b - a) + (c - a)) / 3.0;
        let corners = [a, b, c].map(|p| {
            let local = axes.transpose() * (p - origin) * s;
            [local.x, local.y]
        });
        (
            frame(origin, axes, s),
            Bone::Triangle(Box::new(bone::Triangle::new(corners))),
        )
    }
}
