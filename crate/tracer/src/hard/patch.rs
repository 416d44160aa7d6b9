//! A flat triangle that is lit as if it were curved.
use super::Crossing;
use crate::ray::Ray;
use glam::DVec3;

/// A triangle without thickness whose normal is interpolated between those at its corners (Phong).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    corner: DVec3,
    /// Normal of the flat face.
    normal: DVec3,
    /// The weights of the second and the third corner at p are `(p − corner)·shares`.
    shares: [DVec3; 2],
    normals: [DVec3; 3],
    center: DVec3,
    reach: f64,
}

/// Overlap of a patch beyond its edges, relative to its size, so that no ray passes between
/// neighbours.
const EDGE: f64 = 1e-12;

impl Patch {
    /// Prepares the shape; `None` unless the triangle has an area and all numbers are finite. A
    /// normal without length is taken to be the triangle's.
    #[must_use]
    pub fn new(corners: [DVec3; 3], normals: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let (ab, ac) = (b - a, c - a);
        let across = ab.cross(ac);
        let normal = across.try_normalize()?;
        let square = across.length_squared();
        let shares = [ac.cross(across) / square, across.cross(ab) / square];
        let center = (a + b + c) / 3.0;
        let sound = shares.iter().chain(&normals).all(|v| v.is_finite());
        (sound && center.is_finite()).then_some(Self {
            corner: a,
            normal,
            shares,
            normals: normals.map(|n| n.normalize_or(normal)),
            center,
            reach: corners
                .map(|c| c.distance(center))
                .into_iter()
                .fold(0.0, f64::max),
        })
    }

    /// Adds the place where the ray's line crosses the triangle. The normal is the one that light
    /// sees; it is on the same side of the ray as the triangle's own.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let rate = ray.direction.dot(self.normal);
        let t = (self.corner - ray.origin).dot(self.normal) / rate;
        if !t.is_finite() {
            return;
        }
        let way = ray.at(t) - self.corner;
        let [u, v] = self.shares.map(|share| way.dot(share));
        let weights = [1.0 - u - v, u, v];
        if weights.iter().any(|w| w.is_nan() || *w < -EDGE) {
            return;
        }
        let mixed: DVec3 = (0..3).map(|i| self.normals[i] * weights[i]).sum();
        // Opposite normals may cancel.
        let mixed = mixed.normalize_or(self.normal);
        out.push(Crossing {
            t,
            normal: self.turn(mixed, ray.direction),
        });
    }

    /// Turns a normal until it is seen from the same side as the face. Near the outline of a body
    /// the mixed normal of a patch may point away from the eye that sees the patch's outer side; it
    /// is then turned until it is just edge-on, so that light is not taken to come from within.
    fn turn(&self, mixed: DVec3, direction: DVec3) -> DVec3 {
        let face = self.normal * mixed.dot(self.normal).signum();
        let facing = face.dot(direction);
        let tilt = mixed.dot(direction);
        if facing * tilt >= 0.0 {
            return mixed;
        }
        let edge_on = (mixed - direction * tilt).normalize_or(face);
        edge_on + direction * (1e-9 * facing.signum())
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        (self.center, self.reach)
    }
}
