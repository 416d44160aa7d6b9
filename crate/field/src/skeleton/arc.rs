//! A circular arc.
use super::{Geometry, Map, Skeleton, fits};
use crate::Kernel;
use crate::bone::{self, Bone};
use crate::term::{Frame, frame};
use core::f64::consts::{FRAC_PI_8, PI, TAU};
use glam::{DMat3, DVec3};

pub(super) struct Arc {
    pub center: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub radius: f64,
    pub angle: f64,
}

impl Geometry for Arc {
    fn name(&self) -> &'static str {
        "arc"
    }

    fn dimension(&self) -> u8 {
        1
    }

    fn measure(&self) -> f64 {
        self.radius * self.angle.clamp(0.0, TAU)
    }

    fn size(&self) -> f64 {
        self.radius
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        let (u, v) = orthonormal(self.u, self.v);
        let half = self.angle.clamp(0.0, TAU) / 2.0;
        let d = point - self.center;
        // Azimuth from the arc's middle: the nearer end is then found by clamping.
        let (sine, cosine) = libm::sincos(half);
        let (x, y) = (u * cosine + v * sine, v * cosine - u * sine);
        let azimuth = libm::atan2(d.dot(y), d.dot(x)).clamp(-half, half);
        let (sine, cosine) = libm::sincos(azimuth);
        self.center + self.radius * (x * cosine + y * sine)
    }

    fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        if self.angle >= PI {
            return Some((self.center, self.radius));
        }
        // The sphere over the chord holds an arc of up to a half circle.
        let (u, v) = orthonormal(self.u, self.v);
        let (sine, cosine) = libm::sincos(self.angle.max(0.0) / 2.0);
        let middle = self.center + (u * cosine + v * sine) * (self.radius * cosine);
        Some((middle, self.radius * sine))
    }

    /// The box around the circle.
    fn bounds(&self, radius: f64) -> Option<(DVec3, DVec3)> {
        let reach = DVec3::splat(self.radius + radius);
        Some((self.center - reach, self.center + reach))
    }

    fn middle(&self) -> DVec3 {
        self.at(0.5)
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        let labels = [(0.0, "the start"), (0.5, "the middle"), (1.0, "the end")];
        labels.map(|(share, label)| (self.at(share), label)).into()
    }

    fn is_within(&self, limit: f64) -> bool {
        fits(self.center, limit)
            && self.radius.abs() <= limit
            && self.u.is_finite()
            && self.v.is_finite()
            && self.angle.is_finite()
    }

    fn is_finite(&self) -> bool {
        self.is_within(f64::MAX) && self.radius >= 0.0
    }

    fn fault(&self) -> Option<&'static str> {
        let is_point = self.radius <= 0.0 || self.angle <= 0.0;
        is_point.then_some(" has no length (sweep radius or width 0)")
    }

    fn at(&self, share: f64) -> DVec3 {
        let (sine, cosine) = libm::sincos(self.angle * share);
        self.center + (self.u * cosine + self.v * sine) * self.radius
    }

    fn tangent(&self, share: f64) -> Option<DVec3> {
        let (sine, cosine) = libm::sincos(self.angle * share);
        (self.v * cosine - self.u * sine).try_normalize()
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        let [u, v] = map.axes([self.u, self.v]);
        Skeleton::Arc {
            center: map.point(self.center),
            u,
            v,
            radius: map.length(self.radius),
            angle: self.angle,
        }
    }

    fn part(&self, from: f64, to: f64) -> Option<Skeleton> {
        let (sine, cosine) = libm::sincos(self.angle * from);
        Some(Skeleton::Arc {
            center: self.center,
            u: self.u * cosine + self.v * sine,
            v: self.v * cosine - self.u * sine,
            radius: self.radius,
            angle: self.angle * (to - from),
        })
    }

    fn place(&self, _: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
        let (u, v) = orthonormal(self.u, self.v);
        let angle = self.angle.clamp(0.0, TAU);
        let arc = bone::Arc::new(s * self.radius, angle);
        let (sine, cosine) = libm::sincos(angle / 2.0);
        let x = (u * cosine + v * sine) * arc.side;
        let z = u.cross(v);
        let origin = self.center + x * self.radius;
        (
            frame(origin, DMat3::from_cols(x, z.cross(x), z), s),
            Bone::Arc(arc),
        )
    }

    /// A cubic over the angle φ is off by 1.8·10⁻⁵·φ⁶ of the radius, outward: 2.5·10⁻¹³ for π/64,
    /// and 6.6·10⁻⁸ for π/8, less if the circle is many widths large.
    fn cubics(&self, s: f64) -> Vec<[DVec3; 4]> {
        let (u, v) = orthonormal(self.u, self.v);
        let angle = self.angle.clamp(0.0, TAU);
        let fine = PI / 64.0;
        let widest = match s {
            0.0 => fine,
            _ => (FRAC_PI_8 / libm::cbrt((self.radius * s).max(1.0)).sqrt()).max(fine),
        };
        let pieces = (angle / widest).ceil().max(1.0);
        let turn = angle / pieces;
        let reach = 4.0 / 3.0 * libm::tan(turn / 4.0);
        let corner = |i: u32| {
            let (sine, cosine) = libm::sincos(turn * f64::from(i));
            let p = self.center + self.radius * (u * cosine + v * sine);
            (p, self.radius * reach * (v * cosine - u * sine))
        };
        (0..pieces as u32)
            .map(|i| {
                let ((a, along_a), (b, along_b)) = (corner(i), corner(i + 1));
                [a, a + along_a, b - along_b, b]
            })
            .collect()
    }
}

/// Unit vectors in the plane of u and v, the first along u.
pub(crate) fn orthonormal(u: DVec3, v: DVec3) -> (DVec3, DVec3) {
    let u = u.try_normalize().unwrap_or(DVec3::X);
    let v = (v - u * u.dot(v))
        .try_normalize()
        .unwrap_or_else(|| u.any_orthonormal_vector());
    (u, v)
}
