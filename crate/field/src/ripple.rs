//! Bounds on a profile's derivatives along a line between its [kinks](crate::kinks). With the
//! bounds on a field without its profile they bound the derivatives of the product (Leibniz).
//!
//! Along a segment or a triangle the waves are functions of linear parameters, whose rates are
//! known. Around an arc they are functions of the angle θ = Im log z, whose derivatives along a
//! line are at most `(k−1)!/ρᵏ` at a distance ρ from the circle's axis; by Faà di Bruno's formula
//! so are those of a wave S of it,
//!
//! `S₁/ρ, (S₂+S₁)/ρ², (S₃+3S₂+2S₁)/ρ³, (S₄+6S₃+11S₂+6S₁)/ρ⁴`.
//!
//! There they count as `g·S` with `g = (2q/(1+q²))²`, `q = ρ/radius` (see [`waves`](crate::waves)).
//! With `y = 1/(1+q²)` it is `g = 4q²y²`, `|g′| ≤ 8qy²`, and `|g⁽ʲ⁾| ≤ 4(j+1)!·y^(1+j/2)`. So
//! towards the axis the first two derivatives of the product stay finite, and the third and fourth
//! do not.
use crate::{Profile, Skeleton, Wave};
use core::f64::consts::TAU;

/// Bounds on the derivatives of a profile's factor, over the factor's largest size.
#[derive(Clone, Debug)]
pub struct Ripple {
    /// First to fourth derivative along any line; for an arc, of the wave by the angle.
    by: [f64; 4],
    /// Radius of an arc, and the waves' largest contribution to the factor; `None` for other
    /// skeletons.
    arc: Option<[f64; 2]>,
}

/// Factors `4(j+1)!` of the bounds on the derivatives of g, see the module.
const FADE: [f64; 5] = [4.0, 8.0, 24.0, 96.0, 480.0];
/// Largest values of the derivatives of g.
const FADE_MOST: [f64; 5] = [1.0, 1.74, 8.0, 30.0, 192.0];
/// Binomial coefficients of the orders 2 to 4.
const BINOMIAL: [[f64; 5]; 3] = [
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

impl Ripple {
    /// Bounds for a profile along a skeleton. `None` if the profile is constant.
    #[must_use]
    pub fn of(profile: &Profile, skeleton: &Skeleton) -> Option<Self> {
        let [low, high] = profile.bounds;
        let rise = (high - low).abs() / low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        // Along a side without a length the parameter is constant.
        let one_over = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
        let wave = |i: usize, rate: f64| {
            let rate = (profile.scale[i] * rate).abs();
            let powers = [
                rate,
                rate * rate,
                rate * rate * rate,
                (rate * rate) * (rate * rate),
            ];
            let most = derivatives(profile.waves[i]);
            core::array::from_fn::<f64, 4, _>(|k| times(most[k], powers[k]))
        };
        let (by, arc) = match skeleton {
            Skeleton::Segment { .. } => {
                let by = wave(0, one_over(skeleton.measure())).map(|d| times(rise, d));
                (by, None)
            }
            Skeleton::Triangle { corners: [a, b, c] } => {
                let (e1, e2) = (*b - *a, *c - *a);
                let inverse = one_over(e1.cross(e2).length());
                let [u, v, w] = [e2, e1, e2 - e1].map(|edge| edge.length() * inverse);
                let waves = product(&with_value(1.0, wave(0, u)), &with_value(1.0, wave(1, v)));
                let factor = with_value(1.0, waves.map(|d| times(rise, d)));
                // 1 − restriction·(1−27λ₀λ₁λ₂), where products of two of these are at most ¼.
                let steep = 27.0 * profile.restriction.abs();
                let rate = u.max(v).max(w);
                let b = [0.25 * (u + v + w), 2.0 * rate * rate, 6.0 * u * v * w, 0.0];
                let kept = with_value(1.0, b.map(|d| times(steep, d)));
                (product(&factor, &kept), None)
            }
            // Without a length there is no field.
            Skeleton::Arc { .. } if skeleton.measure() <= 0.0 => return None,
            Skeleton::Arc { radius, angle, .. } => {
                let [s1, s2, s3, s4] = wave(0, one_over(angle.min(TAU)));
                let by = [
                    s1,
                    s2 + s1,
                    s3 + 3.0 * s2 + 2.0 * s1,
                    s4 + 6.0 * s3 + 11.0 * s2 + 6.0 * s1,
                ];
                let rise = if profile.waves[0] == Wave::One {
                    0.0
                } else {
                    rise
                };
                (by, Some([radius.max(f64::MIN_POSITIVE), rise]))
            }
            // Other bones have no parameters that a profile could follow.
            _ => return None,
        };
        let changes = arc.map_or(by != [0.0; 4], |[_, rise]| rise > 0.0);
        changes.then_some(Self { by, arc })
    }

    /// Returns bounds on the first to fourth derivative along any line, at a distance of
    /// `axis_distance` or more from an arc's axis.
    #[must_use]
    pub fn derivatives(&self, axis_distance: f64) -> [f64; 4] {
        let Some([radius, rise]) = self.arc else {
            return self.by;
        };
        let q = axis_distance / radius;
        let y = 1.0 / (1.0 + q * q);
        let root = y.sqrt();
        let powers = [y, y * root, y * y, y * y * root, y * y * y];
        let g: [f64; 5] = core::array::from_fn(|j| (FADE[j] * powers[j]).min(FADE_MOST[j]));
        let [c1, c2, c3, c4] = self.by;
        let square = y * y;
        // 4qy² is largest at q² = 1/3.
        let near = if 3.0 * q * q < 1.0 {
            1.3
        } else {
            4.0 * q * square
        };
        let (once, twice) = (1.0 / q, 1.0 / (q * q));
        let product = [
            g[1] + c1 * near,
            g[2] + (16.0 * c1 + 4.0 * c2) * square,
            g[3] + times(3.0 * c1 * g[2] + (24.0 * c2 + 4.0 * c3) * square, once),
            g[4] + times(4.0 * c1 * g[3], once)
                + times(6.0 * c2 * g[2] + (32.0 * c3 + 4.0 * c4) * square, twice),
        ];
        let inverse = 1.0 / radius;
        let mut scale = rise;
        product.map(|d| {
            scale *= inverse;
            times(scale, d)
        })
    }

    /// Returns bounds on the derivatives of orders 2 to 4 of the field times the factor, from those
    /// of the field (orders 0 to 4) and of the factor (orders 1 to 4).
    #[must_use]
    pub fn of_product(field: &[f64; 5], factor: &[f64; 4]) -> [f64; 3] {
        let [_, rest @ ..] = product(field, &with_value(1.0, *factor));
        rest
    }
}

/// Returns bounds on a wave's derivatives between its kinks. Waves with kinks get those of a sine,
/// for callers that ignore kinks.
fn derivatives(wave: Wave) -> [f64; 4] {
    match wave {
        Wave::One => [0.0; 4],
        Wave::X | Wave::Saw | Wave::Step => [1.0; 4],
        Wave::Hat => [2.0, 1.0, 1.0, 1.0],
        Wave::Sin | Wave::Cos => [0.5; 4],
        Wave::Sin2 | Wave::Cos2 => [1.0, 2.0, 4.0, 8.0],
    }
}

fn with_value(value: f64, [a, b, c, d]: [f64; 4]) -> [f64; 5] {
    [value, a, b, c, d]
}

/// The first to the fourth derivative of a product (Leibniz).
fn product(a: &[f64; 5], b: &[f64; 5]) -> [f64; 4] {
    let first = times(a[1], b[0]) + times(a[0], b[1]);
    let [second, third, fourth] = [2, 3, 4].map(|m: usize| {
        (0..=m)
            .map(|k| BINOMIAL[m - 2][k] * times(a[m - k], b[k]))
            .sum::<f64>()
    });
    [first, second, third, fourth]
}

/// Product of two bounds, with 0·∞ = 0.
pub(crate) fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlobScale, Kernel, Primitive, Shaping};
    use glam::DVec3;
    use trials::{Random, count};

    /// The factor along random lines near arcs, segments and triangles, at five places close to
    /// each other: its derivatives by differences are within the bounds, and come near to them.
    #[test]
    fn factors_change_no_faster_than_told() {
        const SMOOTH: [Wave; 5] = [Wave::X, Wave::Sin, Wave::Cos, Wave::Sin2, Wave::Cos2];
        let mut random = Random::new(6);
        let mut next = || random.range(-1.0, 1.0);
        // Largest ratio of a derivative to its bound, by kind of skeleton and order.
        let mut nearest = [[0.0f64; 4]; 3];
        // Fewer do not come near to the bounds.
        for case in 0..count(6000).max(6000) {
            let mut place = || DVec3::new(next(), next(), next());
            let (a, b, c) = (place(), place(), place());
            let skeleton = match case % 3 {
                0 => Skeleton::Arc {
                    center: a,
                    u: DVec3::X,
                    v: DVec3::Y,
                    radius: 0.2 + b.x.abs(),
                    angle: 1.0 + 5.0 * b.y.abs(),
                },
                1 => Skeleton::Segment { base: a, apex: b },
                _ => Skeleton::Triangle { corners: [a, b, c] },
            };
            let profile = Profile {
                waves: [SMOOTH[case / 3 % 5], SMOOTH[case / 15 % 5]],
                scale: [1.0 + 6.0 * next().abs(), 1.0 + 3.0 * next().abs()],
                bounds: [0.3 * next(), 1.0],
                times: 1.0,
                restriction: if case % 2 == 0 { 0.0 } else { next().abs() },
            };
            let shaping = Shaping {
                kernel: Kernel::Cauchy,
                radius: 0.2,
                blobbiness: 1.0,
                blob_scale: BlobScale::Relative,
                strength: 1.0,
                influence: 1e-3,
                taper: None,
            };
            let Some(ripple) = Ripple::of(&profile, &skeleton) else {
                continue;
            };
            let Some(primitive) = Primitive::new(skeleton.clone(), &shaping, Some(profile)) else {
                continue;
            };
            let term = &primitive.prepared.double;
            let waves = term.waves.as_ref().expect("a profile");
            // Near the skeleton, where parameters are between 0 and 1.
            let [s, t] = [0.5 + 0.4 * next(), 0.5 * (0.5 + 0.4 * next())];
            let (origin, size) = match &skeleton {
                Skeleton::Arc { radius, angle, .. } => {
                    let (y, x) = (libm::sin(s * angle), libm::cos(s * angle));
                    (a + DVec3::new(x, y, 0.0) * (radius * (0.4 + t)), *radius)
                }
                Skeleton::Segment { .. } => (a.lerp(b, s), a.distance(b)),
                _ => {
                    let sides = (b - a).cross(c - a).length();
                    (
                        a + (b - a) * (0.6 * s) + (c - a) * (0.6 * t),
                        sides.min(1.0),
                    )
                }
            };
            let direction = DVec3::new(next(), next(), next()).normalize();
            let step = 2e-3 * size / (1.0 + profile.scale[0]);
            let kinks = crate::kinks::of(&primitive);
            if kinks.iter().any(|kink| kink.cuts(origin, 3.0 * step)) {
                continue;
            }
            let point = |i: i32| origin + direction * (step * f64::from(i));
            let [m2, m1, o, p1, p2] = [-2, -1, 0, 1, 2]
                .map(|i| waves.jet(term.frame.local_point(point(i)).to_array()).value);
            let found = [
                (p1 - m1) / (2.0 * step),
                (p1 - 2.0 * o + m1) / (step * step),
                (p2 - 2.0 * p1 + 2.0 * m1 - m2) / (2.0 * step.powi(3)),
                (p2 - 4.0 * p1 + 6.0 * o - 4.0 * m1 + m2) / step.powi(4),
            ];
            let axis_distance = [-2, 2].map(|i| {
                let away = point(i) - a;
                libm::sqrt(away.x * away.x + away.y * away.y)
            });
            let bounds = ripple.derivatives(axis_distance[0].min(axis_distance[1]));
            for (order, (found, bound)) in found.into_iter().zip(bounds).enumerate() {
                // Differences lose digits.
                let lost = 1e-14 / step.powi(order as i32 + 1);
                let most = bound * profile.largest();
                let found = found.abs() - lost;
                assert!(
                    found <= most * 1.01,
                    "{case}, order {}: {found} > {most} at {axis_distance:?} of {skeleton:?} \
                     {profile:?}",
                    order + 1
                );
                let near = &mut nearest[case % 3][order];
                *near = near.max(found / most.max(1e-300));
            }
        }
        for near in nearest.iter().flatten() {
            assert!(*near > 0.15, "{nearest:?}");
        }
    }

    /// The derivatives of `e^t·e^(2t)` at 0 are the powers of 3.
    #[test]
    fn a_product_has_all_of_its_terms() {
        let bounds = Ripple::of_product(&[1.0; 5], &[2.0, 4.0, 8.0, 16.0]);
        assert_eq!(bounds, [9.0, 27.0, 81.0]);
        // An unbounded derivative of the field counts only if the factor is not constant in that
        // order.
        let field = [1.0, 1.0, 1.0, f64::INFINITY, f64::INFINITY];
        assert_eq!(Ripple::of_product(&field, &[0.0; 4])[0], 1.0);
    }
}
