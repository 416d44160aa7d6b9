//! What is known of a primitive without evaluating it: how large its field can be, and how far a
//! Hermite span can be from it, at a given distance or more from its skeleton.
//!
//! All bounds follow from the kernel's. With x = 1+s²d², the Cauchy kernel along any ray,
//! `k(t) = (P²+s²t²)⁻²`, has `|k⁗| = s⁴·24·|35u⁴−42u²+3|/(1+u²)²·X⁻⁴`, where X = P²(1+u²) is the
//! value of x at t. The largest value over all rays that stay at distance ≥ d is integrated over
//! an infinite line or plane; the constants below are upper envelopes of those integrals, checked
//! numerically in this file's tests. A cubic Hermite span of length h is then within
//! `max|f⁗|·h⁴/384` of the function.
use field::{Kernel, Primitive, Skeleton};
use glam::DVec3;

/// Bounds of one primitive.
#[derive(Clone, Debug)]
pub struct Bound {
    skeleton: Skeleton,
    /// Where the skeleton's directions are needed: unit normal of a triangle, unit axis of a segment.
    axis: DVec3,
    /// Length of a segment or arc, area of a triangle.
    measure: f64,
    /// Sine and cosine of an arc's angle.
    turn: (f64, f64),
    /// sin(φ/2)/(φ/2) for an arc's largest φ, see [`Bound::nearness`].
    sag: f64,
    /// s².
    width2: f64,
    width: f64,
    /// |height|, times the profile's largest magnitude.
    height: f64,
    /// Whether the term can be positive and negative.
    positive: bool,
    negative: bool,
    /// Depth of influence.
    pub influence: f64,
    /// The profile's largest rate of change, radians per unit of u or v; 0 without one.
    ripple: f64,
}

/// How near a ball is to a skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// No point of the ball is nearer than this.
    pub distance: f64,
    /// Integrals over an arc are at most this times those over its tangent line at `distance`.
    stretch: f64,
}

/// An arc seen from anywhere: `4π/3` over `π/2`, see [`Bound::nearness`].
const WORST_STRETCH: f64 = 8.0 / 3.0;

impl Bound {
    /// The bounds of a primitive.
    #[must_use]
    pub fn new(primitive: &Primitive) -> Self {
        let (axis, measure) = match primitive.skeleton {
            Skeleton::Point { .. } => (DVec3::ZERO, 0.0),
            Skeleton::Segment { base, apex } => {
                ((apex - base).normalize_or_zero(), base.distance(apex))
            }
            Skeleton::Arc {
                u,
                v,
                radius,
                angle,
                ..
            } => (u.cross(v), radius * angle),
            Skeleton::Triangle { corners: [a, b, c] } => {
                let n = (b - a).cross(c - a);
                (n.normalize_or_zero(), 0.5 * n.length())
            }
            Skeleton::Plane { normal, .. } => (normal, f64::INFINITY),
        };
        let (mut turn, mut sag) = ((0.0, 1.0), 1.0);
        if let Skeleton::Arc { angle, .. } = primitive.skeleton {
            turn = libm::sincos(angle);
            let half = 0.5 * angle.min(core::f64::consts::PI);
            sag = if half > 1e-9 {
                libm::sin(half) / half
            } else {
                1.0
            };
        }
        // The Cauchy kernel is the only one yet; its width parameter is s.
        let Kernel::Cauchy = primitive.kernel;
        let (low, high) = primitive.profile.map_or((1.0, 1.0), |p| {
            let [a, b] = p.bounds.map(|b| b * p.times);
            (a.min(b), a.max(b))
        });
        let (low, high) = if primitive.height < 0.0 {
            (-high, -low)
        } else {
            (low, high)
        };
        Self {
            skeleton: primitive.skeleton,
            axis,
            measure,
            turn,
            sag,
            width2: primitive.width * primitive.width,
            width: primitive.width,
            height: primitive.height.abs() * low.abs().max(high.abs()),
            positive: high > 0.0,
            negative: low < 0.0,
            influence: primitive.influence,
            ripple: primitive
                .profile
                .map_or(0.0, |p| p.scale[0].abs().max(p.scale[1].abs()).max(1.0)),
        }
    }

    /// How near the points of a ball come to the skeleton.
    #[must_use]
    pub fn nearness(&self, center: DVec3, radius: f64) -> Nearness {
        let mut stretch = 1.0;
        let distance = match self.skeleton {
            Skeleton::Point { center: c } => center.distance(c),
            Skeleton::Segment { base, .. } => {
                let d = center - base;
                let along = d.dot(self.axis).clamp(0.0, self.measure);
                d.distance(self.axis * along)
            }
            Skeleton::Arc {
                center: c,
                u,
                v,
                radius: sweep,
                angle,
            } => {
                let d = center - c;
                let (x, y, z) = (d.dot(u), d.dot(v), d.dot(self.axis));
                let rho = (x * x + y * y).sqrt();
                // A point of the arc at angle φ from the foot is no nearer than if the arc were
                // straight but shorter by the factor sin(φ/2)/(φ/2)·√(ρ/sweep).
                let shrink = self.sag * ((rho - radius).max(0.0) / sweep).sqrt();
                let (sin, cos) = self.turn;
                let before = x * sin - y * cos >= 0.0;
                let swept = if angle > core::f64::consts::PI {
                    y >= 0.0 || before
                } else {
                    y >= 0.0 && before
                };
                if swept {
                    stretch = (1.0 / shrink).clamp(1.0, WORST_STRETCH);
                    let off = rho - sweep;
                    (off * off + z * z).sqrt()
                } else {
                    stretch = WORST_STRETCH;
                    let start = (x - sweep) * (x - sweep) + y * y;
                    let (ex, ey) = (x - sweep * cos, y - sweep * sin);
                    (start.min(ex * ex + ey * ey) + z * z).sqrt()
                }
            }
            Skeleton::Triangle { corners } => self.triangle_distance(corners, center),
            Skeleton::Plane { point, normal } => (center - point).dot(normal).abs(),
        };
        Nearness {
            distance: (distance - radius).max(0.0),
            stretch,
        }
    }

    fn triangle_distance(&self, corners: [DVec3; 3], p: DVec3) -> f64 {
        let mut inside = true;
        let mut nearest = f64::INFINITY;
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let edge = b - a;
            let d = p - a;
            inside &= edge.cross(d).dot(self.axis) >= 0.0;
            let along = (d.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(d.distance_squared(edge * along));
        }
        if inside {
            (p - corners[0]).dot(self.axis).abs()
        } else {
            nearest.sqrt()
        }
    }

    /// `|f|` is at most this.
    #[must_use]
    pub fn magnitude(&self, near: Nearness) -> f64 {
        use core::f64::consts::{FRAC_PI_2, PI};
        let x = 1.0 + self.width2 * near.distance * near.distance;
        let point = 1.0 / (x * x);
        let line = || near.stretch * FRAC_PI_2 / (self.width * x * x.sqrt());
        self.height
            * match self.skeleton {
                Skeleton::Point { .. } => point,
                Skeleton::Segment { .. } | Skeleton::Arc { .. } => line().min(self.measure * point),
                Skeleton::Triangle { .. } => (PI / (self.width2 * x)).min(self.measure * point),
                Skeleton::Plane { .. } => PI / (self.width2 * x),
            }
    }

    /// `|f⁗|` along any ray is at most this.
    #[must_use]
    pub fn fourth_derivative(&self, near: Nearness) -> f64 {
        let s2 = self.width2;
        let x = 1.0 + s2 * near.distance * near.distance;
        let point = || s2 * s2 * point4(x);
        let bound = self.height
            * match self.skeleton {
                Skeleton::Point { .. } => point(),
                Skeleton::Segment { .. } | Skeleton::Arc { .. } => {
                    (near.stretch * s2 * self.width * line4(x)).min(self.measure * point())
                }
                Skeleton::Triangle { .. } => (s2 * plane4(x)).min(self.measure * point()),
                Skeleton::Plane { .. } => s2 * plane4(x),
            };
        if self.ripple == 0.0 {
            return bound;
        }
        // A profile multiplies the field by a wave that is not smooth everywhere, so this is an
        // estimate: the wave's own fourth derivative on top, at its rate along the skeleton.
        let length = match self.skeleton {
            Skeleton::Triangle { .. } => self.measure.sqrt(),
            _ => self.measure,
        };
        let rate = self.ripple / length.max(f64::MIN_POSITIVE);
        bound + self.magnitude(near) * (rate * rate) * (rate * rate)
    }

    /// A distance from the skeleton beyond which `|f|` is at most `share`.
    #[must_use]
    pub fn distance_of(&self, share: f64) -> f64 {
        let mut distance = self.influence.max(f64::MIN_POSITIVE);
        // Every field falls at least as fast as 1/d², so this doubles a few times only.
        for _ in 0..64 {
            let near = Nearness {
                distance,
                stretch: WORST_STRETCH,
            };
            if self.magnitude(near) <= share {
                break;
            }
            distance *= 2.0;
        }
        distance
    }

    /// Whether the term can be above zero.
    #[must_use]
    pub fn adds(&self) -> bool {
        self.positive
    }

    /// Whether the term can be below zero.
    #[must_use]
    pub fn carves(&self) -> bool {
        self.negative
    }
}

/// `max |k⁗|/s⁴` at x or more.
fn point4(x: f64) -> f64 {
    let w = x - 1.0;
    let x2 = x * x;
    let share = (35.0 * w * w - 42.0 * w + 3.0) / x2;
    (24.0 * (1.005 * share).max(4.3) / (x2 * x2)).min(72.0)
}

/// Its integral over a line, in units of 1/s.
fn line4(x: f64) -> f64 {
    let c = 1.0 - 1.0 / x;
    ((103.0 + 729.0 * c * c * c) / (x * x * x * x.sqrt())).min(90.6)
}

/// Its integral over a plane, in units of 1/s².
fn plane4(x: f64) -> f64 {
    let c = 1.0 - 1.0 / x;
    ((121.0 + 775.0 * c * c * c) / (x * x * x)).min(112.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `|k⁗|/s⁴` of `(P²+t²)⁻²`, from the formula in this module's introduction.
    fn kernel4(p2: f64, t: f64) -> f64 {
        let u2 = t * t / p2;
        let x = p2 * (1.0 + u2);
        24.0 * (35.0 * u2 * u2 - 42.0 * u2 + 3.0).abs() / (1.0 + u2).powi(2) / x.powi(4)
    }

    #[test]
    fn the_kernels_fourth_derivative_formula_agrees_with_differences() {
        let h = 1e-2;
        for (p2, t) in [(1.0, 0.0), (1.0, 0.4), (2.0, 1.3), (5.0, 3.0)] {
            let k = |t: f64| (p2 + t * t).powi(-2);
            let d = (k(t - 2.0 * h) - 4.0 * k(t - h) + 6.0 * k(t) - 4.0 * k(t + h)
                + k(t + 2.0 * h))
                / h.powi(4);
            let exact: f64 = kernel4(p2, t);
            assert!(
                (d.abs() - exact).abs() < 2e-2 * exact.max(0.1),
                "{d} {exact}"
            );
        }
    }

    #[test]
    fn envelopes_bound_what_they_say() {
        // The point's: over all rays that pass at distance ≥ d.
        for i in 0..400 {
            let x = 1.0 + 0.01 * f64::from(i * i) / 4.0;
            for j in 0..400 {
                let at = x + 0.002 * f64::from(j * j);
                for k in 0..50 {
                    let p2 = 1.0 + (at - 1.0) * f64::from(k) / 49.0;
                    let t = (at - p2).max(0.0).sqrt();
                    assert!(kernel4(p2, t) <= point4(x) * (1.0 + 1e-9), "{x} {at} {p2}");
                }
            }
            // The line's and the plane's: trapezoids over a wide range.
            let (mut line, mut plane) = (0.0, 0.0);
            let reach = 40.0 * x.sqrt();
            let n = 4000;
            for j in 0..n {
                let v = (f64::from(j) + 0.5) / f64::from(n) * reach;
                let dv = reach / f64::from(n);
                line += 2.0 * dv * point4(x + v * v);
                plane += core::f64::consts::TAU * v * dv * point4(x + v * v);
            }
            assert!(line <= line4(x) * 1.001, "{x} {line} {}", line4(x));
            assert!(plane <= plane4(x) * 1.001, "{x} {plane} {}", plane4(x));
        }
    }
}
