//! Bounds on profiles and their derivatives between their kinks ([`field::kinks`]), at which the
//! reference divides a ray.
use field::{Kink, Primitive, Profile, Skeleton, Wave, kinks};

/// Bounds on a primitive's profile.
#[derive(Clone, Debug)]
pub struct Factor {
    /// Upper bounds on the factor's magnitude and on its first and second derivatives by length.
    pub largest: [f64; 3],
    /// Whether the factor may be negative.
    pub turns: bool,
    /// Kinks of the factor.
    pub kinks: Vec<Kink>,
}

impl Factor {
    /// Returns the bounds for a primitive.
    pub fn of(primitive: &Primitive) -> Self {
        let Some(profile) = &primitive.profile else {
            return Self {
                largest: [1.0, 0.0, 0.0],
                turns: false,
                kinks: Vec::new(),
            };
        };
        let ends = profile.bounds.map(|b| b * profile.times);
        let size = ends[0].abs().max(ends[1].abs());
        let rise = (ends[1] - ends[0]).abs();
        // First and second derivative of the waves' product.
        let (mut first, mut second) = (0.0, 0.0);
        let mut restricted = [0.0; 2];
        match &primitive.skeleton {
            Skeleton::Segment { base, apex } => {
                let axis = *apex - *base;
                (first, second) = limit_slopes(profile, 0, 1.0 / axis.length());
            }
            Skeleton::Triangle { corners: [a, b, c] } => {
                let (e1, e2) = (*b - *a, *c - *a);
                let normal = e1.cross(e2);
                let area2 = normal.length();
                // Gradients of u, of v and of 1 − u − v.
                let by_u = e2.cross(normal) / (area2 * area2);
                let by_v = normal.cross(e1) / (area2 * area2);
                let rate = by_u.length().max(by_v.length()).max((by_u + by_v).length());
                let (u1, u2) = limit_slopes(profile, 0, rate);
                let (v1, v2) = limit_slopes(profile, 1, rate);
                first = u1 + v1;
                second = u2 + v2 + 2.0 * u1 * v1;
                if profile.restriction != 0.0 {
                    let r = 27.0 * profile.restriction.abs();
                    restricted = [0.75 * r * rate, 6.0 * r * rate * rate];
                }
            }
            Skeleton::Arc { radius, angle, .. } => {
                // Waves count as g = (2t/(1+t²))² with t = ρ/radius, and the angle changes by
                // 1/ρ: g/t ≤ 1.3, g/t² ≤ 4, |g′| ≤ 1.8, |g′|/t ≤ 8, |g″| ≤ 8.
                let (w1, w2) = limit_slopes(profile, 0, 1.0 / angle.max(f64::MIN_POSITIVE));
                let i = 1.0 / radius;
                first = (1.3 * w1 + 1.8) * i;
                second = (4.0 * (w2 + w1) + 16.0 * w1 + 8.0) * i * i;
            }
            // Other bones have no parameters.
            _ => (),
        }
        let kept = profile.restriction.abs().max(1.0);
        Self {
            largest: [
                size * kept,
                rise * first * kept + size * restricted[0],
                rise * second * kept + 2.0 * rise * first * restricted[0] + size * restricted[1],
            ],
            turns: ends[0] < 0.0 || ends[1] < 0.0 || profile.restriction > 1.0,
            kinks: kinks::of(primitive),
        }
    }
}

/// Bounds the first and second derivative of a wave of a profile whose parameter changes by `rate`
/// per unit of length.
fn limit_slopes(profile: &Profile, wave: usize, rate: f64) -> (f64, f64) {
    let (a, b) = match profile.waves[wave] {
        Wave::One | Wave::Step => (0.0, 0.0),
        Wave::X | Wave::Saw => (1.0, 0.0),
        Wave::Sin | Wave::Cos => (0.5, 0.5),
        Wave::Sin2 | Wave::Cos2 => (1.0, 2.0),
        Wave::Hat => (2.0, 0.0),
    };
    let p = (profile.scale[wave] * rate).abs();
    (a * p, b * p * p)
}
