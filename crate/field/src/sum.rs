//! The sum of primitives: the field of a convolution surface.
use crate::kinks::{self, Kink};
use crate::{Ball, Bound, Enclosure, Evaluate, Implicit, Jet, Primitive, THRESHOLD};
use glam::DVec3;
use std::sync::OnceLock;
use wide::f32x8;

/// The field F(p) = Σ fᵢ(p), with nothing cut off.
///
/// ```
/// use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
/// use glam::DVec3;
///
/// let shaping = Shaping {
///     kernel: Kernel::Gauss,
///     radius: 0.5,
///     blobbiness: -2.0,
///     blob_scale: BlobScale::Relative,
///     strength: 1.0,
///     influence: 1e-3,
///     taper: None,
/// };
/// let point = Skeleton::Point { center: DVec3::ZERO };
/// let sum: Sum = Primitive::new(point, &shaping, None).into_iter().collect();
/// // A point's surface is a sphere of its radius.
/// let on_surface = sum.jet(DVec3::new(0.3, 0.0, 0.4));
/// assert!((on_surface.value - THRESHOLD).abs() < 1e-12);
/// ```
#[derive(Debug, Default)]
pub struct Sum {
    /// The terms.
    pub primitives: Vec<Primitive>,
    /// Bounds of each term for enclosures, made at first use.
    bounds: OnceLock<Vec<Known>>,
}

/// A primitive's bounds, and where its profile is not smooth.
#[derive(Debug)]
struct Known {
    bound: Bound,
    kinks: Vec<Kink>,
}

impl Sum {
    /// The sum of some primitives.
    #[must_use]
    pub fn new(primitives: Vec<Primitive>) -> Self {
        Self {
            primitives,
            bounds: OnceLock::new(),
        }
    }

    /// Value and gradient, in double precision.
    #[must_use]
    pub fn jet(&self, point: DVec3) -> Jet<f64> {
        self.sum(point.to_array())
    }

    /// Value and gradient in any precision; pictures use `f32` and `f32x8`.
    #[must_use]
    pub fn sum<R: Evaluate>(&self, point: [R; 3]) -> Jet<R> {
        sum(&self.primitives, point)
    }

    /// Each term's value.
    #[must_use]
    pub fn weights(&self, point: DVec3) -> Vec<f64> {
        let point = point.to_array();
        self.primitives.iter().map(|p| p.value(point)).collect()
    }

    fn known(&self) -> &[Known] {
        self.bounds.get_or_init(|| {
            let known = |p| Known {
                bound: Bound::new(p),
                kinks: kinks::of(p),
            };
            self.primitives.iter().map(known).collect()
        })
    }
}

/// Value and gradient of the sum of some primitives, added up in their order.
#[must_use]
pub fn sum<'a, R: Evaluate>(
    primitives: impl IntoIterator<Item = &'a Primitive>,
    point: [R; 3],
) -> Jet<R> {
    primitives
        .into_iter()
        .fold(Jet::zero(), |sum, primitive| sum.plus(primitive.jet(point)))
}

impl Clone for Sum {
    fn clone(&self) -> Self {
        Self::new(self.primitives.clone())
    }
}

impl FromIterator<Primitive> for Sum {
    fn from_iter<I: IntoIterator<Item = Primitive>>(primitives: I) -> Self {
        Self::new(primitives.into_iter().collect())
    }
}

impl Implicit for Sum {
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
        let mut all = Enclosure::ZERO;
        for Known { bound, kinks } in self.known() {
            let near = bound.nearness(center, radius);
            let magnitude = bound.magnitude(near);
            let cut = kinks.iter().filter(|kink| kink.cuts(center, radius));
            let [kinked, jumps] = cut.fold([false, false], |[_, jumps], kink| {
                [true, jumps | kink.jumps]
            });
            let unless = |broken: bool, bound: f64| if broken { f64::INFINITY } else { bound };
            all = all.plus(Enclosure {
                value: [
                    if bound.carves() { -magnitude } else { 0.0 },
                    if bound.adds() { magnitude } else { 0.0 },
                ],
                slope: unless(jumps, bound.slope(near)),
                curvature: unless(kinked, bound.curvature(near)),
            });
        }
        all.about(&self.jet(center), radius)
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        let point = point.to_array();
        for (i, primitive) in (0..).zip(&self.primitives) {
            let value = primitive.value(point);
            if value > 0.0 {
                out.push((i, value));
            }
        }
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        let share = level / self.primitives.len().max(1) as f64;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (p, Known { bound, .. }) in self.primitives.iter().zip(self.known()) {
            if !bound.adds() {
                continue;
            }
            let (center, around) = p.bounding_sphere()?;
            let reach = around - p.influence + bound.distance_of(share);
            (low, high) = (low.min(center - reach), high.max(center + reach));
        }
        let (center, radius) = if low.x <= high.x {
            (0.5 * (low + high), 0.5 * low.distance(high))
        } else {
            (DVec3::ZERO, 0.0)
        };
        Some(Ball { center, radius })
    }
}
