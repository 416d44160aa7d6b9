//! Primitives as boxes of space see them: bounds on their size there, and on the error of their
//! interpolants.
use super::expansion::{AXES, NODES};
use super::{DIAGONAL, MISPLACED, Smooth, power};
use crate::bone::Bone;
use crate::{Bound, Cut, Primitive, Skeleton};
use glam::DVec3;
use wide::f32x8;

/// A primitive as others see it from afar.
#[derive(Clone, Debug)]
pub struct Source {
    /// Ball around its skeleton.
    pub center: DVec3,
    pub around: f64,
    /// Half the sides of a box around it.
    pub extent: DVec3,
    /// Bound on the field times the kernel's reciprocal ([`Bound::far`]), and the least width
    /// parameter.
    pub whole: f64,
    pub width: f64,
    /// The largest width parameter.
    pub finest: f64,
    /// Factor of a point without a profile; `None` for all others.
    pub point: Option<f32>,
    /// The bounds of all others.
    pub bound: Option<Box<Bound>>,
    pub adds: bool,
    /// The kernel's exponent and softening; an exponent of 0 tells that there is no expansion.
    pub power: i32,
    pub softening: f64,
}

/// A primitive as seen from a box.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Bound on its size in the box.
    pub magnitude: f64,
    /// Bound on the error of its expansion, or of leaving it out.
    pub error: f64,
    /// Largest slope over the size, about, for the effect of a place that is rounded to single
    /// precision.
    pub steep: f64,
}

/// A kernel without end at a distance: the bound on the field, and `1/b` with `b² = ε² + u²`.
struct Afar {
    own: f64,
    inverse: f64,
}

impl Source {
    /// Computes a primitive's bounds.
    pub fn of(primitive: &Primitive) -> Self {
        let bound = Bound::new(primitive);
        let [whole, width] = bound.far();
        let ball = primitive.skeleton.bounding_sphere();
        let (center, around) = ball.unwrap_or((DVec3::ZERO, f64::INFINITY));
        let plain = !bound.has_profile() && ball.is_some() && whole.is_finite();
        let kernel = power(primitive.kernel).filter(|_| plain);
        let (power, softening) = kernel.unwrap_or_default();
        let term = &primitive.prepared.double;
        let is_point = power > 0 && matches!(term.form.bone, Bone::Point);
        Self {
            center,
            around,
            extent: match primitive.skeleton {
                Skeleton::Point { .. } => DVec3::ZERO,
                Skeleton::Segment { base, apex } => (0.5 * (apex - base)).abs(),
                _ => DVec3::splat(around),
            },
            whole,
            width,
            finest: primitive.width,
            point: is_point.then_some(term.amplitude as f32),
            adds: bound.adds(),
            power,
            softening,
            bound: (!is_point).then(|| Box::new(bound)),
        }
    }

    /// Bounds on derivatives of the primitive in a box of this half extent, and on the slope of its
    /// interpolant's error, given the bound on that error itself.
    ///
    /// With `A = 1 − I` the error `A₁f + I₁A₂f + I₁I₂A₃f` has the derivative by x₁ of a term `A₁g`
    /// as its own bound times `n²/w` (n nodes, half extent w), since `|(g − Ig)′| ≤ |ω′|/n!·|g⁽ⁿ⁾|`
    /// (Shadrin 1995) for the nodes' polynomial `ω = 2(w/2)ⁿTₙ(x/w)`; a polynomial `I₁g` less, by
    /// Markov's inequality. By another coordinate, `A₁` remains with a mixed derivative of order
    /// n+1, which on a line through space is no larger than that along it:
    /// `(n+1)!·C_{n+1}(1)·b^(−e−n−1)`.
    pub fn smooth(&self, center: DVec3, half: f64, error: f64) -> Smooth {
        let Some(near) = self.afar(center, half) else {
            let Some(bound) = &self.bound else {
                return Smooth::UNKNOWN;
            };
            let near = bound.nearness(center, half * DIAGONAL);
            let derivatives = [bound.slope(near), bound.curvature(near), bound.third(near)];
            return Smooth {
                derivatives,
                slope_error: derivatives[0],
            };
        };
        let Afar { own, inverse } = near;
        let e = f64::from(self.power);
        // s/b, by which each derivative grows.
        let rate = self.finest * inverse;
        let first = own * e * rate;
        let second = first * (e + 1.0) * rate;
        let n = NODES as f64;
        let q = 0.5 * half * rate;
        let sixth = GEGENBAUER[self.power as usize - 1].high * (n + e) / (n + 1.0);
        let mixed =
            2.0 * own * (q * q * q * q * q) * (2.0 * q * (n + 1.0) * sixth) * (1.0 + LAMBDA);
        Smooth {
            derivatives: [first, second, second * (e + 2.0) * rate],
            slope_error: AXES * (n * n * error + mixed) / half,
        }
    }

    /// Returns the field's bound in a box; `None` if its kernel has no expansion.
    fn afar(&self, center: DVec3, half: f64) -> Option<Afar> {
        if self.power == 0 {
            return None;
        }
        let away = (self.center - center).abs();
        let outside = (away - half).max(DVec3::ZERO).length();
        let mut distance = (outside - self.around).at_least(0.0);
        if let Some(bound) = &self.bound {
            distance = distance.at_least(bound.nearness(center, half * DIAGONAL).distance);
        }
        Some(self.from(distance))
    }

    fn from(&self, distance: f64) -> Afar {
        let u = distance * self.width;
        let inverse = 1.0 / (self.softening + u * u).sqrt();
        let own = self.whole * (0..self.power).fold(1.0, |product, _| product * inverse);
        Afar { own, inverse }
    }

    /// Counts the axes along which a line through the box may be seen from a part of the skeleton
    /// at an angle with a larger cosine than this, squared: `cos² ≤ X²/(X² + R²)`, with the largest
    /// X along the axis and the least R across it.
    fn steep_axes(&self, away: DVec3, half: f64, square: f64) -> usize {
        let most = (away + half + self.extent) * self.finest;
        let least = (away - half - self.extent).max(DVec3::ZERO) * self.width;
        let least = least * least;
        let base = self.softening + least.element_sum();
        let steep = (0..3).filter(|&axis| {
            let across = base - least[axis];
            square * across < (1.0 - square) * most[axis] * most[axis]
        });
        steep.count()
    }

    /// Computes bounds on the primitive in a box of this half extent.
    pub fn bounds_in(&self, center: DVec3, half: f64) -> Seen {
        let away = (self.center - center).abs();
        let outside = (away - half).max(DVec3::ZERO).length();
        let mut distance = (outside - self.around).at_least(0.0);
        let mut magnitude = f64::INFINITY;
        let mut steep = 0.0;
        if let Some(bound) = &self.bound {
            let near = bound.nearness(center, half * DIAGONAL);
            distance = distance.at_least(near.distance);
            magnitude = bound.magnitude(near);
            steep = bound.relative_slope(near);
        }
        if self.power == 0 {
            return Seen {
                magnitude,
                error: magnitude,
                steep,
            };
        }
        let Afar { own, inverse } = self.from(distance);
        let magnitude = magnitude.at_most(own);
        let q = 0.5 * self.finest * half * inverse;
        let bounds = GEGENBAUER[self.power as usize - 1];
        let factor = bounds.factor(self.steep_axes(away, half, bounds.square));
        Seen {
            magnitude,
            error: own * (q * q * q * q * q) * factor,
            steep,
        }
    }
}

/// Bounds on the Gegenbauer polynomial C₅ of order e/2, e = 1 to 4: everywhere, and up to a cosine.
#[derive(Clone, Copy)]
struct Gegenbauer {
    /// Value at 1, the largest.
    high: f64,
    /// Largest size up to the cosine whose square is `square`.
    low: f64,
    /// Square of that cosine.
    square: f64,
}

const GEGENBAUER: [Gegenbauer; 4] = [
    Gegenbauer {
        high: 1.0,
        low: 0.42,
        square: 0.91,
    },
    Gegenbauer {
        high: 6.0,
        low: 1.44,
        square: 0.833,
    },
    Gegenbauer {
        high: 21.0,
        low: 3.3,
        square: 0.767,
    },
    Gegenbauer {
        high: 56.0,
        low: 6.2,
        square: 0.71,
    },
];

/// Lebesgue's constant of one axis.
const LAMBDA: f64 = 1.99;

impl Gegenbauer {
    /// Returns `2(c₁ + Λc₂ + Λ²c₃)`, where `high` axes may exceed the cosine.
    fn factor(self, high: usize) -> f64 {
        let [c1, c2, c3] = [0, 1, 2].map(|axis| if axis < high { self.high } else { self.low });
        2.0 * (c1 + LAMBDA * c2 + LAMBDA * LAMBDA * c3)
    }
}

/// Primitives side by side that are all points of one kernel.
#[derive(Debug)]
pub struct Points {
    /// Place, width parameter, bound on the field over the kernel.
    place: [Vec<f32>; 3],
    scale: Vec<f32>,
    pub whole: Vec<f32>,
    pub power: i32,
    pub softening: f32,
    /// Largest coordinate of a place.
    furthest: f64,
    /// Factors of [`Gegenbauer::factor`] for 0 to 3 axes.
    factors: [f32; 4],
    square: f32,
}

impl Points {
    /// Gathers the sources; `None` if they are not all points of one kernel.
    pub fn of(sources: &[Source]) -> Option<Self> {
        let power = sources.first()?.power;
        if !sources
            .iter()
            .all(|s| s.point.is_some() && s.power == power)
        {
            return None;
        }
        let all = |of: &dyn Fn(&Source) -> f64| sources.iter().map(|s| of(s) as f32).collect();
        let furthest = sources.iter().map(|s| s.center.abs().max_element());
        let bounds = GEGENBAUER[power as usize - 1];
        Some(Self {
            place: core::array::from_fn(|i| all(&|s| s.center[i])),
            scale: all(&|s| s.finest),
            whole: all(&|s| s.whole),
            power,
            softening: sources[0].softening as f32,
            furthest: furthest.fold(0.0, f64::max),
            factors: core::array::from_fn(|high| bounds.factor(high) as f32),
            square: bounds.square as f32,
        })
    }

    /// Computes bounds on sizes and errors of some points in a box, rounded upwards, and appends
    /// them to `seen`.
    pub fn bounds_in(&self, center: DVec3, half: f64, candidates: &[u32], seen: &mut Vec<Seen>) {
        let coordinates = self.furthest + center.abs().max_element();
        // Places are rounded.
        let wide = half * (1.0 + 1e-6) + MISPLACED * coordinates;
        let half = f32x8::splat(wide as f32);
        let center = center.as_vec3().to_array().map(f32x8::splat);
        let (zero, one) = (f32x8::splat(0.0), f32x8::splat(1.0));
        let softening = f32x8::splat(self.softening);
        let square = f32x8::splat(self.square * (1.0 - 1e-4));
        let rest = f32x8::splat(1.0 - self.square * (1.0 - 1e-4));
        let [f0, f1, f2, f3] = self.factors.map(f32x8::splat);
        let up = f32x8::splat(1.0 + 1e-4);
        for block in candidates.chunks(8) {
            let gather = |row: &[f32]| {
                f32x8::new(core::array::from_fn(|lane| {
                    row[block[lane.min(block.len() - 1)] as usize]
                }))
            };
            let (scale, whole) = (gather(&self.scale), gather(&self.whole));
            // A squared distance in squared kernel widths is times this.
            let widths = scale * scale;
            let away: [f32x8; 3] =
                core::array::from_fn(|i| (gather(&self.place[i]) - center[i]).abs());
            let outside = away
                .map(|x| (x - half).fast_max(zero))
                .map(|x| x * x * widths);
            let [x, y, z] = outside;
            let base = softening + x + y + z;
            let inverse = one / base;
            let size = match self.power {
                1 => inverse.sqrt(),
                2 => inverse,
                3 => inverse * inverse.sqrt(),
                _ => inverse * inverse,
            };
            let size = whole * size * up;
            let inner = f32x8::splat(0.25) * half * half * widths * inverse;
            let five = inner * inner * inner.sqrt();
            // cos² = X²/(X² + R²), with the largest X and the least R in the box.
            let mut high = zero;
            for (own, outside) in away.iter().zip(outside) {
                let most = *own + half;
                let steep = (square * (base - outside)).simd_lt(rest * (most * most * widths));
                high += steep.select(one, zero);
            }
            let factor = f32x8::splat(0.5).simd_lt(high).select(f1, f0);
            let factor = f32x8::splat(1.5).simd_lt(high).select(f2, factor);
            let factor = f32x8::splat(2.5).simd_lt(high).select(f3, factor);
            let error = size * five * factor * up;
            let (size, error) = (size.to_array(), error.to_array());
            seen.extend((0..block.len()).map(|lane| Seen {
                magnitude: f64::from(size[lane]),
                error: f64::from(error[lane]),
                steep: 0.0,
            }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bounds on Gegenbauer polynomials: everywhere, and up to the cosine, where they are
    /// nearly reached.
    #[test]
    fn gegenbauer_polynomials_are_bounded() {
        for (bounds, e) in GEGENBAUER.iter().zip(1..) {
            let order = 0.5 * f64::from(e);
            let polynomial = |x: f64| {
                let (mut before, mut own) = (1.0, 2.0 * order * x);
                for n in 2..=5 {
                    let n = f64::from(n);
                    let next = 2.0 * x * (n + order - 1.0) * own - (n + 2.0 * order - 2.0) * before;
                    (before, own) = (own, next / n);
                }
                own.abs()
            };
            let (mut low, mut high) = (0.0f64, 0.0f64);
            for i in 0..=10_000 {
                let x = f64::from(i) * 1e-4;
                high = high.max(polynomial(x));
                if x * x <= bounds.square {
                    low = low.max(polynomial(x));
                }
            }
            assert!(high <= bounds.high * (1.0 + 1e-12), "{e}: {high}");
            assert!(low <= bounds.low && low > 0.9 * bounds.low, "{e}: {low}");
        }
    }

    /// Interpolation of a single point's field at the nodes of a box is no further off than its
    /// bound, which is nearly reached.
    #[test]
    fn interpolants_of_points_are_within_their_bounds() {
        use crate::{BlobScale, Kernel, Shaping, Skeleton};
        let mut random = trials::Random::new(6);
        // Fewer do not come near to the bound.
        let cases = trials::count(400).max(400);
        let nodes: [f64; 5] =
            core::array::from_fn(|i| libm::cos(core::f64::consts::PI * (2 * i + 1) as f64 / 10.0));
        // Lagrange's polynomials.
        let weights = |x: f64| -> [f64; 5] {
            core::array::from_fn(|i| {
                let others = (0..5).filter(|j| *j != i);
                others
                    .map(|j| (x - nodes[j]) / (nodes[i] - nodes[j]))
                    .product()
            })
        };
        for kernel in [
            Kernel::Inverse,
            Kernel::Squared,
            Kernel::Cubed,
            Kernel::Cauchy,
        ] {
            let (mut tightest, mut checked) = (0.0f64, 0);
            for case in 0..cases {
                let mut direction = random.direction();
                if case % 2 == 0 {
                    // The direction is nearly that of an axis.
                    direction = (DVec3::X + 0.1 * direction).normalize();
                }
                let center = direction * (random.range(1.5, 3.5));
                let shaping = Shaping {
                    kernel,
                    radius: random.range(0.05, 0.55),
                    blobbiness: 2.0,
                    blob_scale: BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                let point = Primitive::new(Skeleton::Point { center }, &shaping, None);
                let point = point.expect("flesh");
                let half = 0.6;
                let points = Points::of(&[Source::of(&point)]).expect("a point");
                let mut seen = Vec::new();
                points.bounds_in(DVec3::ZERO, half, &[0], &mut seen);
                let value = |x: f64, y: f64, z: f64| point.value([x, y, z].map(|c| c * half));
                for _ in 0..6 {
                    let place = random.vector(1.0).to_array();
                    let [u, v, w] = place.map(weights);
                    let mut told = 0.0;
                    for k in 0..5 {
                        for j in 0..5 {
                            for i in 0..5 {
                                let own = value(nodes[i], nodes[j], nodes[k]);
                                told += u[i] * v[j] * w[k] * own;
                            }
                        }
                    }
                    let want = value(place[0], place[1], place[2]);
                    assert!(want.abs() <= seen[0].magnitude, "{kernel:?} {seen:?}");
                    let off = (told - want).abs();
                    let most = seen[0].error;
                    assert!(off <= most, "{kernel:?} {center}: {off} > {most}");
                    tightest = tightest.max(off / most);
                    checked += 1;
                }
            }
            assert!(
                tightest > 0.1 && checked == 6 * cases,
                "{kernel:?}: {tightest}"
            );
        }
    }
}
