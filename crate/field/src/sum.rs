//! The sum of primitives: the field of a convolution surface.
use crate::bound::Nearness;
use crate::far_field::{Cell, FarField, power};
use crate::implicit::{Part, Slack, Variation};
use crate::kinks::{self, Kink};
use crate::{Ball, Bound, Enclosure, Evaluate, Implicit, Jet, Logarithm, Primitive, THRESHOLD};
#[cfg(feature = "widths")]
use crate::{Cut, Shaping, Skeleton, Taper};
use glam::DVec3;
use std::sync::{Arc, OnceLock};
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
///     blobbiness: 2.0,
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
    bounds: OnceLock<Vec<TermBounds>>,
    /// The parts of each bone that tapers, see `parts_by_width`, made at first use.
    #[cfg(feature = "widths")]
    parts: OnceLock<Vec<Vec<Bound>>>,
    /// The hierarchy for those who bear its error, made at first use; `None` if it would not pay.
    far: OnceLock<Option<Box<FarField>>>,
}

/// Fewest terms with an expansion for which a hierarchy pays.
const MANY: usize = 64;
/// Half the side of the hierarchy's cube, over the radius of the ball that holds the surface.
const ROOM: f64 = 1.25;

/// Bounds on a primitive, and where its profile is not smooth.
#[derive(Debug)]
pub(crate) struct TermBounds {
    pub(crate) bound: Bound,
    kinks: Vec<Kink>,
}

impl TermBounds {
    /// Bounds in a ball.
    fn enclose(&self, ball: Ball) -> Enclosure {
        self.enclose_near(ball, self.bound.nearness(ball.center, ball.radius))
    }

    /// Bounds in a ball that is so near to the skeleton.
    fn enclose_near(&self, Ball { center, radius }: Ball, near: Nearness) -> Enclosure {
        let Self { bound, kinks } = self;
        let magnitude = bound.magnitude(near);
        let cut = kinks.iter().filter(|kink| kink.cuts(center, radius));
        let [kinked, jumps] = cut.fold([false, false], |[_, jumps], kink| {
            [true, jumps | kink.jumps]
        });
        Enclosure {
            value: [
                if bound.carves() {
                    -magnitude
                } else {
                    bound.least(center, radius)
                },
                if bound.adds() { magnitude } else { 0.0 },
            ],
            slope: if jumps {
                f64::INFINITY
            } else {
                bound.slope(near)
            },
            curvature: if kinked {
                f64::INFINITY
            } else {
                bound.curvature(near)
            },
        }
    }
}

impl Sum {
    /// The sum of some primitives.
    #[must_use]
    pub fn new(primitives: Vec<Primitive>) -> Self {
        Self {
            primitives,
            bounds: OnceLock::new(),
            #[cfg(feature = "widths")]
            parts: OnceLock::new(),
            far: OnceLock::new(),
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

    /// Computes each term's value.
    #[must_use]
    pub fn weights(&self, point: DVec3) -> Vec<f64> {
        let point = point.to_array();
        self.primitives.iter().map(|p| p.value(point)).collect()
    }

    fn far(&self) -> Option<&FarField> {
        let far = self.far.get_or_init(|| {
            let endless = self.primitives.iter().filter(|p| power(p.kernel).is_some());
            if endless.count() < MANY {
                return None;
            }
            let Ball { center, radius } = self.support()?;
            let field = FarField::new(&self.primitives, center, ROOM * radius);
            let pays = field.count_expansions() >= MANY && radius.is_finite();
            pays.then(|| Box::new(field.with_derivatives()))
        });
        far.as_deref()
    }

    /// Returns the hierarchy's cell around a ball, if its error is at most `error`.
    fn cell(&self, ball: Ball, error: f64) -> Option<&Arc<Cell>> {
        if error <= 0.0 {
            return None;
        }
        let cell = self
            .far()?
            .around(&self.primitives, ball.center, ball.radius)?;
        // A cell that has all terms in its list is of no use.
        (cell.error <= error && cell.near.len() < self.primitives.len()).then_some(cell)
    }

    /// Computes the sum of some terms.
    fn sum_of<R: Evaluate>(&self, terms: &[u32], point: [R; 3]) -> Jet<R> {
        sum(terms.iter().map(|i| &self.primitives[*i as usize]), point)
    }

    fn bounds(&self) -> &[TermBounds] {
        self.bounds.get_or_init(|| {
            let bounds = self.primitives.iter().map(|p| TermBounds {
                bound: Bound::new(p),
                kinks: kinks::of(p),
            });
            bounds.collect()
        })
    }
}

/// Returns bounds on the parts of a bone that tapers, along each of which its radius is halved at
/// most; none if it hardly tapers or has a profile.
#[cfg(feature = "widths")]
fn parts_by_width(primitive: &Primitive) -> Option<Vec<Bound>> {
    let shaping = primitive.tapered.as_deref()?;
    let radii = [0.0, 1.0].map(|share| shaping.at(share).radius);
    let (thick, thin) = (radii[0].max(radii[1]), radii[0].min(radii[1]));
    // Not so for NaN.
    if primitive.profile.is_some() || !(thin > 0.0 && thick > 2.0 * thin) {
        return None;
    }
    let mut shares = vec![0.0];
    let mut radius = 0.5 * thick;
    while radius > thin {
        shares.push((thick - radius) / (thick - thin));
        radius *= 0.5;
    }
    shares.push(1.0);
    if radii[1] > radii[0] {
        shares = shares.iter().rev().map(|share| 1.0 - share).collect();
    }
    let bones = shares.windows(2);
    let bones = bones.map(|ends| primitive.skeleton.part(ends[0], ends[1]));
    let bones: Vec<Skeleton> = bones.collect::<Option<_>>()?;
    let whole: f64 = bones.iter().map(Skeleton::measure).sum();
    let mut before = 0.0;
    let parts = bones.into_iter().map(|bone| {
        let after = before + bone.measure();
        let [start, end] = [before, after].map(|at| shaping.at(at / whole));
        before = after;
        let taper = Some(Taper {
            radius: end.radius,
            blobbiness: end.blobbiness,
        });
        Some(Bound::new(&Primitive::new(
            bone,
            &Shaping { taper, ..start },
            None,
        )?))
    });
    parts.collect()
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

    fn enclose(&self, ball: Ball) -> Enclosure {
        let terms = self.bounds().iter();
        let all = terms.fold(Enclosure::ZERO, |all, term| all.plus(term.enclose(ball)));
        all.about(&self.jet(ball.center), ball.radius)
    }

    fn narrow(&self, ball: Ball, among: Option<&Part>, slack: Slack) -> Option<Part> {
        let terms = self.bounds();
        let each = slack.left_out / terms.len() as f64;
        let before = among.map_or(terms.len(), |among| among.terms.len());
        let inherited = among.and_then(|among| among.far.as_ref());
        let far = self.cell(ball, slack.far).or(inherited);
        // The terms that are left out, and those of the list, are those of the same cell.
        let among = among.filter(|among| match (far, &among.far) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            (own, other) => own.is_none() && other.is_none(),
        });
        let mut part = Part {
            ball,
            terms: Vec::new(),
            rest: among.map_or(Enclosure::ZERO, |among| among.rest),
            far: far.cloned(),
        };
        let mut choose = |i: u32| {
            let bounds = terms[i as usize].enclose(ball);
            let size = bounds.value[1].max(-bounds.value[0]);
            let changes = [
                size,
                bounds.slope * ball.radius,
                bounds.curvature * ball.radius * ball.radius,
            ];
            // NaN is not within bounds, so that such a term is kept.
            if changes.iter().all(|change| *change <= each) {
                part.rest = part.rest.plus(bounds);
            } else {
                part.terms.push(i);
            }
        };
        match (among, far) {
            (Some(among), _) => among.terms.iter().copied().for_each(&mut choose),
            (None, Some(cell)) => cell.near.iter().copied().for_each(&mut choose),
            (None, None) => (0..terms.len() as u32).for_each(&mut choose),
        }
        (4 * part.terms.len() <= 3 * before).then_some(part)
    }

    fn jet_of(&self, part: &Part, point: DVec3) -> Jet<f64> {
        let jet = self.sum_of(&part.terms, point.to_array());
        match &part.far {
            Some(cell) => jet.plus(cell.jet(point)),
            None => jet,
        }
    }

    fn jet8_of(&self, part: &Part, points: [f32x8; 3]) -> Jet<f32x8> {
        let jet = self.sum_of(&part.terms, points);
        match &part.far {
            Some(cell) => jet.plus(cell.jet8(points)),
            None => jet,
        }
    }

    fn variation(&self, part: Option<&Part>, ball: Ball) -> Variation {
        let terms = self.bounds();
        let mut all = Variation {
            range: part.map_or(Enclosure::ZERO, |part| part.rest),
            curvature: part.map_or(0.0, |part| part.rest.curvature),
            third: 0.0,
            rough: part.map_or(0.0, |part| part.rest.curvature),
            jump: 0.0,
            step: 0.0,
        };
        if let Some(cell) = part.and_then(|part| part.far.as_ref()) {
            let [slope, curvature, third] = cell.smooth.derivatives;
            all.range = all.range.plus(Enclosure {
                value: [cell.far_least, cell.far_most],
                slope,
                curvature,
            });
            all.curvature += curvature;
            all.third += third;
        }
        let mut add = |term: &TermBounds| {
            let near = term.bound.nearness(ball.center, ball.radius);
            let range = term.enclose_near(ball, near);
            all.range = all.range.plus(range);
            if range.curvature.is_finite() {
                let third = term.bound.third(near);
                all.curvature += range.curvature;
                if third.is_finite() {
                    all.third += third;
                } else {
                    all.rough += range.curvature;
                }
            } else {
                let curvature = term.bound.curvature(near);
                all.curvature += curvature;
                all.rough += curvature;
                all.jump += term.bound.jump(near).min(2.0 * range.slope);
                if !range.slope.is_finite() {
                    all.step += range.value[1] - range.value[0];
                }
            }
        };
        match part {
            Some(part) => part.terms.iter().for_each(|i| add(&terms[*i as usize])),
            None => terms.iter().for_each(add),
        }
        all
    }

    #[cfg(feature = "widths")]
    fn least_width(&self, part: Option<&Part>, ball: Ball, enough: f64) -> Option<f64> {
        let terms = self.bounds();
        let parts = self.parts.get_or_init(|| {
            let parts = self.primitives.iter().map(parts_by_width);
            parts.map(Option::unwrap_or_default).collect()
        });
        // Each term, or part of one, is large or small in the ball. The widths of small ones count
        // only if all of these are large together.
        let mut least = [Some(f64::INFINITY); 2];
        let mut sum = 0.0;
        let own: &mut dyn Iterator<Item = usize> = match part {
            Some(part) => &mut part.terms.iter().map(|i| *i as usize),
            None => &mut (0..terms.len()),
        };
        for i in own {
            let bounds = match &parts[i][..] {
                [] => core::slice::from_ref(&terms[i].bound),
                parts => parts,
            };
            for bound in bounds {
                let size = bound.magnitude(bound.nearness(ball.center, ball.radius));
                if size == 0.0 {
                    continue;
                }
                let is_small = size < enough;
                let own = (!bound.has_profile()).then(|| bound.kernel_width());
                let all = &mut least[usize::from(is_small)];
                *all = all.zip(own).map(|(all, own)| all.at_most(own));
                if is_small {
                    sum += size;
                }
            }
        }
        let [own, others] = least;
        if sum < enough {
            own
        } else {
            own.zip(others).map(|(own, others)| own.at_most(others))
        }
    }

    fn logarithm(&self) -> Option<Logarithm<'_>> {
        Logarithm::new(&self.primitives, self.bounds())
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
        for (p, TermBounds { bound, .. }) in self.primitives.iter().zip(self.bounds()) {
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
