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
    /// Unit normal of a triangle, unit axis of a segment, axis of an arc.
    axis: DVec3,
    /// Length of a segment.
    length: f64,
    /// Sine and cosine of an arc's angle.
    turn: (f64, f64),
    /// sin(φ/2)/(φ/2) for an arc's largest φ, see [`Bound::nearness`].
    sag: f64,
    /// s².
    width2: f64,
    /// |height| times the skeleton's measure (1 for points, infinite for planes), and times the
    /// integral of the kernel over a line or a plane: the field's size if all of the skeleton were
    /// at one distance, and if the skeleton were infinite.
    whole: f64,
    endless: f64,
    /// The same for the fourth derivative.
    whole4: f64,
    endless4: f64,
    dimension: u8,
    /// Whether the term can be positive and negative.
    positive: bool,
    negative: bool,
    /// Depth of influence.
    pub influence: f64,
    /// With a profile, an estimate of the fourth derivative of its wave over its size; else 0.
    ripple4: f64,
}

/// How near a ball is to a skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// No point of the ball is nearer than this.
    pub distance: f64,
    /// Integrals over an arc are at most this times those over its tangent line at `distance`.
    stretch: f64,
}

/// What is known of a primitive at some nearness.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// `|f|` is at most this.
    pub magnitude: f64,
    /// `|f⁗|` along any ray is at most this. With a profile, whose waves may have kinks and jumps
    /// where no such bound exists, it is an estimate.
    pub fourth: f64,
}

/// An arc seen from anywhere: all that a ball of radius ρ can hold of a circle is a length of πρ;
/// at worst, all of it at the same distance, it amounts to this much of a line.
const WORST_STRETCH: f64 = 8.0 / 3.0;

impl Bound {
    /// The bounds of a primitive.
    #[must_use]
    pub fn new(primitive: &Primitive) -> Self {
        use core::f64::consts::{FRAC_PI_2, PI, TAU};
        let mut skeleton = primitive.skeleton;
        let measure = skeleton.measure();
        let dimension = skeleton.dimension();
        let (mut axis, mut length, mut turn, mut sag) = (DVec3::ZERO, 0.0, (0.0, 1.0), 1.0);
        match &mut skeleton {
            Skeleton::Point { .. } => (),
            Skeleton::Segment { base, apex } => {
                axis = (*apex - *base).normalize_or_zero();
                length = measure;
            }
            Skeleton::Arc { u, v, angle, .. } => {
                // As the field does it.
                *u = u.try_normalize().unwrap_or(DVec3::X);
                *v = (*v - *u * u.dot(*v))
                    .try_normalize()
                    .unwrap_or_else(|| u.any_orthonormal_vector());
                *angle = angle.clamp(0.0, TAU);
                axis = u.cross(*v);
                turn = libm::sincos(*angle);
                let half = 0.5 * angle.min(PI);
                if half > 1e-9 {
                    sag = libm::sin(half) / half;
                }
            }
            Skeleton::Triangle { corners: [a, b, c] } => {
                axis = (*b - *a).cross(*c - *a).normalize_or_zero();
            }
            Skeleton::Plane { normal, .. } => {
                *normal = normal.try_normalize().unwrap_or(DVec3::Z);
            }
        }
        // The Cauchy kernel is the only one yet; its width parameter is s.
        let Kernel::Cauchy = primitive.kernel;
        let s = primitive.width;
        let (low, high) = primitive.profile.map_or((1.0, 1.0), |p| {
            let [a, b] = p.bounds.map(|b| b * p.times);
            (a.min(b), a.max(b))
        });
        let (low, high) = if primitive.height < 0.0 {
            (-high, -low)
        } else {
            (low, high)
        };
        let height = primitive.height.abs() * low.abs().max(high.abs());
        let s2 = s * s;
        let (endless, endless4) = match dimension {
            0 => (1.0, s2 * s2),
            1 => (FRAC_PI_2 / s, s2 * s),
            _ => (PI / s2, s2),
        };
        let ripple = primitive.profile.map_or(0.0, |p| {
            let extent = if dimension == 2 {
                measure.sqrt()
            } else {
                measure
            };
            p.scale[0].abs().max(p.scale[1].abs()).max(1.0) / extent.max(f64::MIN_POSITIVE)
        });
        Self {
            skeleton,
            axis,
            length,
            turn,
            sag,
            width2: s2,
            whole: height * measure,
            endless: height * endless,
            whole4: height * measure * s2 * s2,
            endless4: height * endless4,
            dimension,
            positive: high > 0.0,
            negative: low < 0.0,
            influence: primitive.influence,
            ripple4: (ripple * ripple) * (ripple * ripple),
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
                let along = d.dot(self.axis).clamp(0.0, self.length);
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
                let (sin, cos) = self.turn;
                let before = x * sin - y * cos >= 0.0;
                let swept = if angle > core::f64::consts::PI {
                    y >= 0.0 || before
                } else {
                    y >= 0.0 && before
                };
                if swept {
                    // A point of the arc at angle φ from the foot is no nearer than if the arc
                    // were straight but shorter by the factor sin(φ/2)/(φ/2)·√(ρ/sweep).
                    let shrink = self.sag * ((rho - radius).max(0.0) / sweep).sqrt();
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

    /// The bounds at some nearness.
    #[inline]
    #[must_use]
    pub fn estimate(&self, near: Nearness) -> Estimate {
        let x = 1.0 + self.width2 * near.distance * near.distance;
        let y = 1.0 / x;
        let y2 = y * y;
        let (point, point4) = (y2, point4(x, y));
        let (endless, endless4) = match self.dimension {
            0 => (y2, point4),
            1 => {
                let root = y.sqrt();
                (near.stretch * y * root, near.stretch * line4(y, root))
            }
            _ => (y, plane4(y)),
        };
        let magnitude = (self.endless * endless).min(self.whole * point);
        let fourth = (self.endless4 * endless4).min(self.whole4 * point4);
        Estimate {
            magnitude,
            fourth: fourth + self.ripple4 * magnitude,
        }
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
            if self.estimate(near).magnitude <= share {
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

/// `max |k⁗|/s⁴` at x or more; y = 1/x.
#[inline]
fn point4(x: f64, y: f64) -> f64 {
    let w = x - 1.0;
    let share = (35.0 * w * w - 42.0 * w + 3.0) * y * y;
    (24.0 * (1.005 * share).max(4.3) * (y * y) * (y * y)).min(72.0)
}

/// Its integral over a line, in units of 1/s; y = 1/x, root = √y.
#[inline]
fn line4(y: f64, root: f64) -> f64 {
    let c = 1.0 - y;
    ((103.0 + 729.0 * c * c * c) * (y * y * y * root)).min(90.6)
}

/// Its integral over a plane, in units of 1/s²; y = 1/x.
#[inline]
fn plane4(y: f64) -> f64 {
    let c = 1.0 - y;
    ((121.0 + 775.0 * c * c * c) * (y * y * y)).min(112.0)
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

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
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

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn envelopes_bound_what_they_say() {
        // The point's: over all rays that pass at distance ≥ d.
        for i in 0..400 {
            let x = 1.0 + 0.01 * f64::from(i * i) / 4.0;
            for j in 0..400 {
                let at = x + 0.002 * f64::from(j * j);
                for k in 0..50 {
                    let p2 = 1.0 + (at - 1.0) * f64::from(k) / 49.0;
                    let t = (at - p2).max(0.0).sqrt();
                    assert!(
                        kernel4(p2, t) <= point4(x, 1.0 / x) * (1.0 + 1e-9),
                        "{x} {at} {p2}"
                    );
                }
            }
            // The line's and the plane's: trapezoids over a wide range.
            let (mut line, mut plane) = (0.0, 0.0);
            let reach = 40.0 * x.sqrt();
            let n = 4000;
            for j in 0..n {
                let v = (f64::from(j) + 0.5) / f64::from(n) * reach;
                let dv = reach / f64::from(n);
                line += 2.0 * dv * point4(x + v * v, 1.0 / (x + v * v));
                plane += core::f64::consts::TAU * v * dv * point4(x + v * v, 1.0 / (x + v * v));
            }
            assert!(
                line <= line4(1.0 / x, (1.0 / x).sqrt()) * 1.001,
                "{x} {line} {}",
                line4(1.0 / x, (1.0 / x).sqrt())
            );
            assert!(
                plane <= plane4(1.0 / x) * 1.001,
                "{x} {plane} {}",
                plane4(1.0 / x)
            );
        }
    }

    /// Random primitives of all kinds, at random places, with small balls.
    fn cases(count: u64) -> impl Iterator<Item = (Primitive, DVec3, f64)> {
        let mut state = 11u64;
        let mut unit = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..count).map(move |i| {
            let mut vector = |size: f64| {
                let v = DVec3::new(unit(), unit(), unit());
                (2.0 * v - 1.0) * size
            };
            let size = [0.3, 1.0, 4.0][i as usize / 5 % 3];
            let (a, b, c) = (vector(size), vector(size), vector(size));
            let (u, p) = (vector(1.0).normalize(), vector(1.5 * size + 1.0));
            let v = u.cross(vector(1.0)).normalize();
            let skeleton = match i % 5 {
                0 => Skeleton::Point { center: a },
                1 => Skeleton::Segment { base: a, apex: b },
                2 => Skeleton::Triangle { corners: [a, b, c] },
                3 => Skeleton::Plane {
                    point: a,
                    normal: u,
                },
                _ => Skeleton::Arc {
                    center: a * 0.3,
                    u,
                    v,
                    radius: size * (0.1 + unit()),
                    angle: core::f64::consts::TAU * unit(),
                },
            };
            let shaping = field::Shaping {
                kernel: Kernel::Cauchy,
                radius: 0.5,
                blobbiness: 0.1 + 4.0 * unit(),
                blob_scale: field::BlobScale::Relative,
                strength: if unit() < 0.5 { 1.0 } else { -1.0 },
                influence: 1e-3,
            };
            let primitive = Primitive::new(skeleton, &shaping, None);
            (primitive.expect("a proper primitive"), p, 0.2 * unit())
        })
    }

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn no_field_exceeds_its_bounds() {
        let (mut tightest, mut tightest4) = (0.0f64, 0.0f64);
        for (primitive, center, radius) in cases(4000) {
            let bound = Bound::new(&primitive);
            let near = bound.nearness(center, radius);
            let Estimate { magnitude, fourth } = bound.estimate(near);
            for i in 0..12 {
                // Points of the ball, one of them nearest to the skeleton.
                let way = match i {
                    0 => (primitive.skeleton.nearest(center) - center).normalize_or_zero(),
                    _ => {
                        let a = f64::from(i);
                        DVec3::new(libm::sin(a), libm::cos(a), libm::sin(3.0 * a)).normalize()
                    }
                };
                let p = center + way * radius;
                let reach = primitive.skeleton.distance(p);
                assert!(near.distance <= reach * (1.0 + 1e-12) + 1e-12);
                let value = |p: DVec3| primitive.value(p.to_array());
                assert!(
                    value(p).abs() <= magnitude * (1.0 + 1e-9),
                    "{primitive:?} {p}"
                );
                tightest = tightest.max(value(p).abs() / magnitude);
                // Differences across, along and askew; they see the derivative's mean over 4h, so
                // the ball is taken a little larger.
                let h = 0.03 / primitive.width;
                let around = bound.nearness(center, radius + 2.0 * h);
                let fourth = fourth.max(bound.estimate(around).fourth);
                let d = way.any_orthonormal_vector() * libm::cos(f64::from(i))
                    + way * libm::sin(f64::from(i));
                let d = d.normalize();
                let difference = value(p - d * (2.0 * h)) - 4.0 * value(p - d * h) + 6.0 * value(p)
                    - 4.0 * value(p + d * h)
                    + value(p + d * (2.0 * h));
                let noise = 1e-13 * magnitude / h.powi(4);
                let derivative = (difference / h.powi(4)).abs();
                assert!(
                    derivative <= fourth + noise,
                    "{primitive:?} {p} {derivative} {fourth}"
                );
                tightest4 = tightest4.max(derivative / (fourth + noise));
            }
        }
        // The bounds are not idle either.
        assert!(tightest > 0.9 && tightest4 > 0.5, "{tightest} {tightest4}");
    }
}
