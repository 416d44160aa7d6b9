//! The reference for pictures: finds crossings with the true surface, slowly.
//!
//! [`Reference`] looks for the places where the whole field, with nothing cut off, equals T, in
//! double precision and by bisection. On an interval of a ray with the middle m and the half-width
//! w Taylor's theorem says `|F(m+x) − F(m) − F′(m)x| ≤ Mx²/2`, where M bounds the second
//! derivative. So an interval has no crossing if `|F(m)−T| > |F′(m)|w + Mw²/2`, and at most one if
//! `|F′(m)| > Mw`, which the signs at its ends then show; any other is halved. M comes from the
//! bones cut into `pieces`, each as far from the interval as its ball. The reference shares the
//! formulas of the field with the code that it judges, and nothing else: no bounds, spans, slabs or
//! depths of influence.
//!
//! Intervals with |F−T| within the rounding of F, or with two crossings closer together than the
//! resolution, are reported as undecided.
mod function;
mod pieces;
mod range;
mod shell;
mod skeleton;
mod terms;
#[cfg(test)]
mod tests;
mod touching;
mod waves;

pub use range::Deformation;
pub use touching::{Substance, TouchingBody};

use field::local::LocalError;
use field::{Kink, Primitive, THRESHOLD};
use function::Function;
use glam::DVec3;
use terms::{Evaluation, FieldTerms, ULP};
use touching::Touching;

/// The points `origin + t·direction`, t > 0.
#[derive(Clone, Copy, Debug)]
struct Ray {
    origin: DVec3,
    /// A unit vector.
    direction: DVec3,
}

impl Ray {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// The field of some primitives, or the smooth maximum of two fields, prepared for searches.
#[derive(Clone, Debug)]
pub struct Reference {
    function: Function,
    /// Kinks of the function.
    kinks: Vec<Kink>,
    /// Evaluations of the whole function so far.
    pub evaluations: u64,
    /// Most intervals for one ray before the search is given up. Most rays need a hundred.
    pub patience: u32,
}

/// A crossing of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// The ray's parameter.
    pub t: f64,
    /// Bound on the error of t.
    pub width: f64,
    /// Whether the ray enters there.
    pub enters: bool,
}

/// Crossings of a ray.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossings {
    /// Whether the ray starts inside.
    pub starts_inside: bool,
    /// The crossings, in order.
    pub roots: Vec<Root>,
    /// Intervals no longer than the resolution (or some that touch) in which the ray comes so near
    /// to the surface that two more crossings cannot be excluded.
    pub undecided: Vec<[f64; 2]>,
    /// Whether the search was completed, or given up after [`patience`](Reference::patience)
    /// intervals.
    pub complete: bool,
}

/// Whether there is surface near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Near {
    /// Surface within this distance.
    Within(f64),
    /// Surface beyond the reach only, or none.
    Beyond,
    /// Undecided.
    Unknown,
}

/// A fault of a reported crossing, or of a report of none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// An interval on the other side of the surface, longer than the tolerance, was missed.
    Missed {
        /// Start of the interval.
        from: f64,
        /// End of the interval.
        to: f64,
        /// Whether all of the interval is within the tolerance of the surface: the ray grazes.
        grazing: bool,
    },
    /// Crossing without a surface within the tolerance, with `|F−T|/|∇F|` there.
    Invented(f64),
}

/// Verdict on a ray's report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Distance of the reported crossing from the true surface, at most; 0 if there is none.
    pub distance: f64,
    /// The fault, if any.
    pub fault: Option<Fault>,
    /// Whether everything was decided.
    pub certain: bool,
}

/// Default of [`Reference::patience`]. A ray along a flat part needs very many intervals.
const PATIENCE: u32 = 40_000;
/// Most cells in a search around one point.
const MOST_CELLS: u32 = 4_000;

impl Reference {
    /// Prepares the field of these primitives.
    #[must_use]
    pub fn new(primitives: Vec<Primitive>) -> Self {
        Self::of(Function::Sum(FieldTerms::new(primitives)))
    }

    /// Prepares the smooth maximum `(a + b + √((a−b)² + k²))/2` of the fields of two sets of
    /// primitives; k > 0.
    #[must_use]
    pub fn smooth_maximum(parts: [Vec<Primitive>; 2], k: f64) -> Self {
        Self::of(Function::SmoothMaximum(
            Box::new(parts.map(FieldTerms::new)),
            k,
        ))
    }

    /// Prepares the union of bodies that touch, which press each other: the largest of their
    /// functions.
    ///
    /// # Errors
    /// If a skeleton cannot be convolved locally.
    pub fn touching(bodies: Vec<TouchingBody>) -> Result<Self, LocalError> {
        Ok(Self::of(Function::Touching(Touching::new(bodies)?)))
    }

    fn of(function: Function) -> Self {
        Self {
            kinks: function.kinks(),
            function,
            evaluations: 0,
            patience: PATIENCE,
        }
    }

    /// Returns F − T and the gradient of F.
    pub fn excess(&mut self, point: DVec3) -> (f64, DVec3) {
        let sample = self.sample(point);
        (sample.excess, sample.gradient)
    }

    fn sample(&mut self, point: DVec3) -> Evaluation {
        self.evaluations += 1;
        self.function.sample(point)
    }

    /// Finds all crossings of `origin + t·direction` (a unit vector), 0 < t < `to`. Two that are
    /// closer together than `resolution` may be left undecided.
    pub fn crossings(
        &mut self,
        origin: DVec3,
        direction: DVec3,
        to: f64,
        resolution: f64,
    ) -> Crossings {
        let ray = Ray { origin, direction };
        let mut found = Crossings {
            starts_inside: self.sample(origin).excess >= 0.0,
            complete: true,
            ..Crossings::default()
        };
        let mut steps = self.patience;
        let mut from = 0.0;
        for kink in self.kinks_along(&ray, to) {
            // Points on both sides of the kink, as close as rounding allows.
            let aside = 1e-13 * (origin.abs().max_element() + kink) + 1e-3 * resolution;
            let [before, after] = [kink - aside, kink + aside];
            if before > from {
                self.search_interval(&ray, [from, before], resolution, &mut steps, &mut found);
                from = before;
            }
            let [a, b] = [from, after].map(|t| self.sample(ray.at(t)).excess >= 0.0);
            if a != b {
                found.roots.push(Root {
                    t: kink,
                    width: after - from,
                    enters: b,
                });
            }
            from = after;
        }
        if from < to {
            self.search_interval(&ray, [from, to], resolution, &mut steps, &mut found);
        }
        found
    }

    /// Returns the parameters at which a ray crosses kinks of the field, in order.
    fn kinks_along(&self, ray: &Ray, to: f64) -> Vec<f64> {
        let mut found: Vec<f64> = self
            .kinks
            .iter()
            .map(|kink| kink.along(ray.origin, ray.direction))
            .filter(|t| *t > 0.0 && *t < to)
            .collect();
        found.sort_unstable_by(f64::total_cmp);
        found
    }

    /// Finds the crossings on an interval on which the field is smooth.
    fn search_interval(
        &mut self,
        ray: &Ray,
        whole: [f64; 2],
        resolution: f64,
        steps: &mut u32,
        found: &mut Crossings,
    ) {
        let mut stack = vec![whole];
        while let Some([a, b]) = stack.pop() {
            if *steps == 0 {
                found.complete = false;
                return;
            }
            *steps -= 1;
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let point = ray.at(middle);
            let rounding = ULP * (point.abs().max_element() + middle);
            let around = half + rounding;
            if let Some(range) = self.function.range(point, around) {
                if range.high < THRESHOLD || range.low > THRESHOLD {
                    continue;
                }
                if 2.0 * half >= resolution {
                    stack.push([middle, b]);
                    stack.push([a, middle]);
                    continue;
                }
            }
            let extent = self.function.extent(point, around, Some(ray.direction));
            if extent.above < THRESHOLD {
                continue;
            }
            let here = self.sample(point);
            let slope = here.gradient.dot(ray.direction);
            let bend = extent.curvature * around;
            let change = slope.abs() + here.slope_noise + 0.5 * bend;
            if here.excess.abs() > change * around + here.noise {
                continue;
            }
            // The sign is uncertain on the whole interval: halving would not help.
            let hopeless = here.excess.abs() + change * around <= here.noise;
            let one_way = slope.abs() - here.slope_noise > bend;
            if one_way || hopeless || 2.0 * half < resolution {
                let [left, right] = [a, b].map(|t| self.sample(ray.at(t)).excess);
                let enters = right >= 0.0;
                if (left >= 0.0) != enters {
                    let root = self.bisect(ray, [a, b], enters, 1e-3 * resolution);
                    found.roots.push(root);
                } else if !one_way {
                    match found.undecided.last_mut() {
                        Some(last) if last[1] == a => last[1] = b,
                        _ => found.undecided.push([a, b]),
                    }
                }
                continue;
            }
            stack.push([middle, b]);
            stack.push([a, middle]);
        }
    }

    /// Refines the crossing between two parameters with different signs.
    fn bisect(&mut self, ray: &Ray, [mut a, mut b]: [f64; 2], enters: bool, width: f64) -> Root {
        while b - a > width {
            let m = 0.5 * (a + b);
            if m <= a || m >= b {
                break;
            }
            let here = self.sample(ray.at(m));
            // Newton's step narrows the interval from both sides at once where it can.
            let slope = here.gradient.dot(ray.direction);
            let newton = m - here.excess / slope;
            let margin = 0.01 * (newton - m).abs() + 0.25 * width;
            if (here.excess >= 0.0) == enters {
                b = m;
            } else {
                a = m;
            }
            for t in [newton - margin, newton + margin] {
                if t > a && t < b {
                    if (self.sample(ray.at(t)).excess >= 0.0) == enters {
                        b = t;
                    } else {
                        a = t;
                    }
                }
            }
        }
        Root {
            t: 0.5 * (a + b),
            width: b - a,
            enters,
        }
    }

    /// Whether there is surface within `reach` of a point.
    pub fn surface_near(&mut self, point: DVec3, reach: f64) -> Near {
        let start = self.sample(point);
        if start.excess.abs() <= start.noise {
            return Near::Within(0.0);
        }
        // Newton's steps along the gradient lead onto the surface, or nearly.
        let (mut at, mut here) = (point, start);
        for _ in 0..6 {
            let square = here.gradient.length_squared();
            let step = here.gradient * (here.excess / square);
            if !step.is_finite() || at.distance(point) > 2.0 * reach {
                break;
            }
            at -= step;
            here = self.sample(at);
            // The surface is between if the sign has changed a little further on.
            let beyond = at - step.normalize_or_zero() * (1e-3 * reach);
            let far = beyond.distance(point);
            if far <= reach {
                let there = self.sample(beyond);
                if there.excess * start.excess <= 0.0 {
                    let near = at.distance(point);
                    let crossed = here.excess * start.excess <= 0.0;
                    return Near::Within(if crossed { near } else { far });
                }
            }
        }
        self.search_ball(point, start, reach)
    }

    /// Does the search of [`Reference::surface_near`] by subdivision of the ball around the point
    /// into cubes.
    fn search_ball(&mut self, point: DVec3, start: Evaluation, reach: f64) -> Near {
        let mut stack = vec![(point, reach)];
        let mut unknown = false;
        for _ in 0..MOST_CELLS {
            let Some((center, half)) = stack.pop() else {
                return if unknown { Near::Unknown } else { Near::Beyond };
            };
            let radius = half * 3.0f64.sqrt() * (1.0 + 1e-12);
            let away = center.distance(point);
            if away - radius > reach {
                continue;
            }
            let here = self.sample(center);
            if here.excess * start.excess <= 0.0 && away <= reach {
                return Near::Within(away);
            }
            if let Some(range) = self.function.range(center, radius)
                && (range.high < THRESHOLD || range.low > THRESHOLD)
            {
                continue;
            }
            let extent = self.function.extent(center, radius, None);
            // Bounds are weaker in balls with kinks.
            let (mut kinked, mut jumps) = (false, false);
            for kink in &self.kinks {
                if kink.normal.dot(center - kink.point).abs() <= radius * (1.0 + 1e-9) {
                    kinked = true;
                    jumps |= kink.jumps;
                }
            }
            let change = if kinked {
                extent.slope
            } else {
                here.gradient.length() + here.slope_noise + 0.5 * extent.curvature * radius
            };
            if !jumps && here.excess.abs() > change * radius + here.noise {
                continue;
            }
            if half < if jumps { 0.05 } else { 1e-3 } * reach {
                unknown = true;
                continue;
            }
            let h = 0.5 * half;
            for i in 0..8u32 {
                let corner = [0, 1, 2].map(|bit| if i >> bit & 1 == 0 { -h } else { h });
                stack.push((center + DVec3::from_array(corner), h));
            }
        }
        Near::Unknown
    }

    /// Judges the first crossing that was reported for a ray, or the report that it has none before
    /// `limit`. `tolerance` returns the tolerance, a length, at a distance.
    pub fn judge(
        &mut self,
        origin: DVec3,
        direction: DVec3,
        reported: Option<f64>,
        limit: f64,
        tolerance: impl Fn(f64) -> f64,
    ) -> Verdict {
        let ray = Ray { origin, direction };
        let mut verdict = Verdict {
            distance: 0.0,
            fault: None,
            certain: true,
        };
        if let Some(t) = reported {
            let at = ray.at(t);
            match self.surface_near(at, tolerance(t)) {
                Near::Within(distance) => verdict.distance = distance,
                Near::Unknown => verdict.certain = false,
                Near::Beyond => {
                    let here = self.sample(at);
                    let away = here.excess.abs() / here.gradient.length();
                    verdict.distance = away;
                    verdict.fault = Some(Fault::Invented(away));
                }
            }
        }
        let end = reported.unwrap_or(limit);
        let found = self.crossings(origin, direction, end, 0.1 * tolerance(0.0));
        verdict.certain &= found.complete;
        // Intervals on the other side than the start's.
        let mut entered = None;
        for root in &found.roots {
            if root.enters != found.starts_inside {
                entered = Some(root.t);
            } else if let Some(from) = entered.take() {
                self.judge_stretch(
                    &ray,
                    [from, root.t],
                    reported,
                    tolerance(from),
                    &mut verdict,
                );
            }
        }
        if let Some(from) = entered {
            self.judge_stretch(&ray, [from, end], reported, tolerance(from), &mut verdict);
        }
        verdict
    }

    /// Judges whether an interval on the other side of the surface was missed.
    fn judge_stretch(
        &mut self,
        ray: &Ray,
        [from, to]: [f64; 2],
        reported: Option<f64>,
        tolerance: f64,
        verdict: &mut Verdict,
    ) {
        if to - from <= tolerance || verdict.fault.is_some() {
            return;
        }
        // Intervals that exist by rounding alone are no faults.
        let deepest = (1..8)
            .map(|i| self.sample(ray.at(from + (to - from) * f64::from(i) / 8.0)))
            .fold(0.0f64, |most, s| most.max(s.excess.abs() / s.noise));
        if deepest <= 4.0 {
            return;
        }
        // A crossing that was reported later is this one if all the way there the ray keeps to the
        // surface: where it grazes, a small distance from the surface is a long one along the ray.
        if let Some(t) = reported
            && self.keeps_near(ray, [from, t], tolerance)
        {
            return;
        }
        verdict.fault = Some(Fault::Missed {
            from,
            to,
            grazing: self.keeps_near(ray, [from, to], tolerance),
        });
    }

    /// Whether an interval of a ray is within `reach` of the surface, tested at some points.
    fn keeps_near(&mut self, ray: &Ray, [from, to]: [f64; 2], reach: f64) -> bool {
        (0..=12).all(|i| {
            let at = ray.at(from + (to - from) * f64::from(i) / 12.0);
            self.surface_near(at, reach) != Near::Beyond
        })
    }
}
