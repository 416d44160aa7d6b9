//! A quadric as an implicit function.

use field::{Ball, Enclosure, Implicit, Jet, Real, THRESHOLD};
use glam::DVec3;
use scene::Quadric;
use wide::f32x8;

/// T + q·A·q + 2·b·q + c, in the coordinates of a quadric's box.
#[derive(Clone, Copy, Debug)]
pub struct QuadricFunction {
    quadric: Quadric,
    curvature: f64,
}

impl QuadricFunction {
    /// The function of a quadric.
    pub fn new(quadric: &Quadric) -> Self {
        let columns = quadric.square.to_cols_array().map(f64::abs);
        // The largest sum of a row bounds the eigenvalues of a symmetric matrix.
        let rows = [0, 1, 2].map(|i| columns[i] + columns[i + 3] + columns[i + 6]);
        Self {
            quadric: *quadric,
            curvature: 2.0 * rows.into_iter().fold(0.0, f64::max),
        }
    }

    fn sum<R: Real>(&self, q: [R; 3]) -> Jet<R> {
        let Quadric {
            square,
            linear,
            constant,
            ..
        } = self.quadric;
        let square = square.to_cols_array_2d();
        let row = |i: usize| {
            let entry = |j: usize| R::splat(square[j][i]) * q[j];
            entry(0) + entry(1) + entry(2) + R::splat(linear[i])
        };
        let half = [row(0), row(1), row(2)];
        let along = |i: usize| q[i] * (half[i] + R::splat(linear[i]));
        Jet {
            value: along(0) + along(1) + along(2) + R::splat(constant + THRESHOLD),
            gradient: half.map(|x| x + x),
        }
    }
}

impl Implicit for QuadricFunction {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.sum(point.to_array())
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.sum(point)
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.sum(points)
    }

    fn enclose(&self, Ball { center, radius }: Ball) -> Enclosure {
        let jet = self.jet(center);
        let steep = DVec3::from_array(jet.gradient).length();
        Enclosure {
            value: [f64::NEG_INFINITY, f64::INFINITY],
            slope: steep + self.curvature * radius,
            curvature: self.curvature,
        }
        .about(&jet, radius)
    }

    fn shares(&self, _point: DVec3, out: &mut Vec<(u32, f64)>) {
        out.push((0, 1.0));
    }

    fn support(&self) -> Option<Ball> {
        None
    }
}
