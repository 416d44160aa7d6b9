//! A piece of a torus with flat lids: a disc swept along an arc.
//!
//! The tube may be fatter than the arc's radius; the disc then reaches over the axis, and the body
//! is still the union of all positions of the disc. So the ray is cut wherever it meets the full
//! torus or a lid's plane, and the crossings are the cuts where being inside changes.
use super::Crossing;
use crate::ray::Ray;
use crate::roots::roots;
use glam::DVec3;

/// A lid: the direction from the centre to it, and across it outwards, in the (u, v) plane.
type Lid = ([f64; 2], [f64; 2]);

/// The union of the discs of radius `radius` across the arc
/// `center + sweep·(cos t·u + sin t·v)`, `0 ≤ t ≤ angle`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube {
    center: DVec3,
    u: DVec3,
    v: DVec3,
    w: DVec3,
    sweep: f64,
    radius: f64,
    /// Directions from the centre to the arc's two ends, in the (u, v) plane.
    start: [f64; 2],
    end: [f64; 2],
    /// Whether the arc turns by more than half a circle.
    reflex: bool,
    /// Whether it turns all the way round.
    closed: bool,
    /// A ball that holds the body.
    ball: (DVec3, f64),
}

impl Tube {
    /// Prepares the shape; `None` unless sweep, angle and radius are positive, u and v span a
    /// plane, and all numbers are finite.
    #[must_use]
    pub fn new(
        center: DVec3,
        [u, v]: [DVec3; 2],
        sweep: f64,
        angle: f64,
        radius: f64,
    ) -> Option<Self> {
        let u = u.try_normalize()?;
        let v = (v - u * v.dot(u)).try_normalize()?;
        let sizes = [sweep, angle, radius];
        if !(sizes.iter().all(|x| *x > 0.0 && x.is_finite()) && center.is_finite()) {
            return None;
        }
        // A circle's piece of up to half a turn lies in the ball over its chord.
        let (sin, cos) = libm::sincos(0.5 * angle);
        let ball = if angle <= core::f64::consts::PI {
            let middle = center + (u * cos + v * sin) * (sweep * cos);
            (middle, sweep * sin + radius)
        } else {
            (center, sweep + radius)
        };
        Some(Self {
            center,
            u,
            v,
            w: u.cross(v),
            sweep,
            radius,
            start: [1.0, 0.0],
            end: [libm::cos(angle), libm::sin(angle)],
            reflex: angle > core::f64::consts::PI,
            closed: angle >= core::f64::consts::TAU * (1.0 - 1e-12),
            ball: (ball.0, ball.1 * (1.0 + 1e-9)),
        })
    }

    /// Whether a direction in the (u, v) plane is within the arc's angle.
    fn sweeps(&self, x: f64, y: f64) -> bool {
        if self.closed {
            return true;
        }
        let after_start = self.start[0] * y - self.start[1] * x >= 0.0;
        let before_end = x * self.end[1] - y * self.end[0] >= 0.0;
        if self.reflex {
            after_start || before_end
        } else {
            after_start && before_end
        }
    }

    /// Whether a point (local coordinates) is in the body.
    fn inside(&self, [x, y, z]: [f64; 3]) -> bool {
        let rho = (x * x + y * y).sqrt();
        let room = self.radius * self.radius - z * z;
        let near = rho - self.sweep;
        let far = rho + self.sweep;
        (near * near < room && self.sweeps(x, y)) || (far * far < room && self.sweeps(-x, -y))
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        // Measure t from the point nearest to the body's middle: the quartic is then well scaled
        // however far the eye is.
        let (ball, reach) = self.ball;
        let shift = (ball - ray.origin).dot(ray.direction);
        let across = ray.at(shift).distance_squared(ball);
        if across > reach * reach {
            return;
        }
        let [o, d] = [ray.at(shift) - self.center, ray.direction]
            .map(|p| [p.dot(self.u), p.dot(self.v), p.dot(self.w)]);
        let at = |t: f64| [o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]];
        // Outside the ball, and above and below the tube, there is nothing.
        let half = (reach * reach - across).sqrt();
        let (mut from, mut to) = (-half, half);
        let lids = [(self.radius - o[2]) / d[2], (-self.radius - o[2]) / d[2]];
        if d[2] != 0.0 {
            from = from.max(lids[0].min(lids[1]));
            to = to.min(lids[0].max(lids[1]));
        } else if o[2].abs() > self.radius {
            return;
        }
        if from >= to {
            return;
        }

        // (|p|² + R² − r²)² = 4R²(x² + y²), with |p|² = t² + 2bt + c.
        let b = o[0] * d[0] + o[1] * d[1] + o[2] * d[2];
        let c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2];
        let k = c + self.sweep * self.sweep - self.radius * self.radius;
        let four = 4.0 * self.sweep * self.sweep;
        let quartic = [
            k * k - four * (o[0] * o[0] + o[1] * o[1]),
            4.0 * b * k - 2.0 * four * (o[0] * d[0] + o[1] * d[1]),
            4.0 * b * b + 2.0 * k - four * (d[0] * d[0] + d[1] * d[1]),
            4.0 * b,
            1.0,
        ];
        // Parameters at which the line is cut, and the lid, if it is one.
        let mut cuts = [(0.0, None); 6];
        let mut count = 0;
        for &t in roots(&quartic, from, to).as_slice() {
            cuts[count] = (t, None);
            count += 1;
        }
        if !self.closed {
            // The outward direction is against the arc's at its start, and along it at its end.
            for (end, out) in [(self.start, -1.0), (self.end, 1.0)] {
                let normal = [-end[1] * out, end[0] * out];
                let rate = d[0] * normal[0] + d[1] * normal[1];
                let t = -(o[0] * normal[0] + o[1] * normal[1]) / rate;
                if t >= from && t <= to {
                    cuts[count] = (t, Some((end, normal)));
                    count += 1;
                }
            }
        }
        let cuts = &mut cuts[..count];
        // They are few, and equal ones stay in order.
        for end in 1..cuts.len() {
            let mut place = end;
            while place > 0 && cuts[place].0 < cuts[place - 1].0 {
                cuts.swap(place, place - 1);
                place -= 1;
            }
        }
        let mut was_inside = false;
        for i in 0..cuts.len() {
            let (t, lid) = cuts[i];
            let next = cuts.get(i + 1).map_or(to, |c| c.0);
            let is_inside = i + 1 < cuts.len() && self.inside(at(0.5 * (t + next)));
            if is_inside != was_inside {
                out.push(Crossing {
                    t: t + shift,
                    normal: self.normal(at(t), lid),
                });
            }
            was_inside = is_inside;
        }
    }

    /// Returns the outward unit normal at a point (local coordinates) of the surface, on a lid if
    /// one is given.
    fn normal(&self, [x, y, z]: [f64; 3], lid: Option<Lid>) -> DVec3 {
        if let Some(([ex, ey], [nx, ny])) = lid {
            // Where a fat disc reaches over the axis, it sweeps the other way.
            let side = if x * ex + y * ey >= 0.0 { 1.0 } else { -1.0 };
            return (self.u * nx + self.v * ny) * side;
        }
        let rho = (x * x + y * y).sqrt();
        // Outwards from the nearest centre of a disc that has this point on its rim: the arc's own
        // side, or, beyond the axis of a fat tube, the opposite one.
        let near = (rho - self.sweep).abs();
        let own = (near * near + z * z - self.radius * self.radius).abs();
        let far = rho + self.sweep;
        let other = (far * far + z * z - self.radius * self.radius).abs();
        let side = if own <= other { 1.0 } else { -1.0 };
        let (cx, cy) = if rho > 0.0 {
            (x / rho * self.sweep * side, y / rho * self.sweep * side)
        } else {
            (0.0, 0.0)
        };
        (self.u * (x - cx) + self.v * (y - cy) + self.w * z)
            .try_normalize()
            .unwrap_or(self.w)
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        self.ball
    }
}
