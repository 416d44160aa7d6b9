//! Bounds on a primitive's field at a given distance or more from its skeleton: its size, its
//! derivatives, and the error of a cubic Hermite span.
//!
//! A field is an integral of kernels. So a bound on the kernel at a distance
//! ([`envelope`](crate::envelope)) bounds the field when multiplied by the skeleton's length or
//! area, or integrated over an infinite line or plane; the smaller counts.
mod place;

use crate::envelope::{self, PEANO, Roughness};
use crate::influence::Crowding;
use crate::kernel::Tail;
use crate::ripple::Ripple;
use crate::{Cut, Kernel, Primitive};
use glam::DVec3;
use place::Place;

/// Bounds of one primitive.
#[derive(Clone, Debug)]
pub struct Bound {
    place: Place,
    /// Bound on the length of an arc or a curve that fits into a ball; `None` for other bones.
    crowding: Option<Box<Crowding>>,
    kernel: Kernel,
    /// Width parameter of the kernel, an inverse length; the smallest of a tapered bone, since
    /// kernels and envelopes fall with the width parameter times the distance.
    width: f64,
    /// Largest width parameter, by which derivatives grow.
    finest: f64,
    /// |height| times the skeleton's measure (1 for points, infinite for planes): times the kernel
    /// it is the field where all of the skeleton is at one distance.
    whole: f64,
    /// |height|·width^−dimension, the factor on integrals over an infinite line or plane in kernel
    /// widths. Infinite where there is no such bound.
    endless: f64,
    /// The square of the skeleton's length, or its area, in kernel widths: 0 for points.
    size: f64,
    /// Radius of a ball around `middle` that holds the skeleton; only compact kernels use it.
    extent: f64,
    middle: DVec3,
    dimension: u8,
    /// Whether the term can be positive.
    positive: bool,
    /// Whether the term can be negative.
    negative: bool,
    /// Depth of influence.
    pub influence: f64,
    /// Bounds on the profile, if any.
    ripple: Option<Box<Ripple>>,
    /// Largest slope of the profile over its size, per unit of length.
    variation: f64,
    /// Value of [`Bound::log_bend`].
    log_bend: f64,
}

/// Position of a ball relative to a skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// Distance of the ball from the skeleton, or less.
    pub distance: f64,
    /// Whether all of the skeleton is within a compact kernel's support of every point of the ball.
    within: bool,
    /// Ratio of an integral over an arc to that over its tangent line at `distance`, or more;
    /// infinite where there is no such bound.
    arc_factor: f64,
    /// Distance of the ball from an arc's axis, or less.
    axis_distance: f64,
}

impl Nearness {
    /// Nearness of a point whose distance from the skeleton is all that is known.
    #[must_use]
    pub fn at(distance: f64) -> Self {
        Self {
            distance,
            within: false,
            arc_factor: f64::INFINITY,
            axis_distance: 0.0,
        }
    }
}

/// Bounds on a primitive's field at some [`Nearness`].
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// Bound on `|f|`.
    pub magnitude: f64,
    /// Bound on the error of the cubic Hermite interpolant on a span of the given length. With a
    /// profile: a bound where that is smooth, an estimate in its [`kinks`](crate::kinks).
    pub error: f64,
    /// Bound on the fourth derivative of f along any line; infinite if unknown.
    pub fourth: f64,
}

/// Length h of a span as factors on derivatives: `cₘhᵐ` for the orders m = 2 to 4, with Peano's
/// constants.
#[derive(Clone, Copy, Debug)]
pub struct SpanLength([f64; 3]);

impl SpanLength {
    /// Prepares the length of a span on a ray with unit direction.
    #[must_use]
    pub fn new(h: f64) -> Self {
        Self([
            PEANO[0] * h * h,
            PEANO[1] * h * h * h,
            PEANO[2] * (h * h) * (h * h),
        ])
    }

    /// Factor from a bound on the fourth derivative to a bound on the span's error.
    #[must_use]
    pub fn fourth(&self) -> f64 {
        self.0[2]
    }
}

/// Largest `arc_factor` for which [`Crowding`] is not evaluated: there it seldom gives a smaller
/// bound, and costs an arctangent.
const NEARLY_STRAIGHT: f64 = 1.2;

impl Bound {
    /// The bounds of a primitive.
    #[must_use]
    pub fn new(primitive: &Primitive) -> Self {
        let skeleton = &primitive.skeleton;
        let measure = skeleton.measure();
        let dimension = skeleton.dimension();
        let (kernel, finest) = (primitive.kernel, primitive.width);
        let mut width = finest;
        let (low, high) = primitive.profile.as_ref().map_or((1.0, 1.0), |p| {
            let [a, b] = p.bounds.map(|b| b * p.times);
            (a.at_most(b), a.at_least(b))
        });
        let (low, high) = if primitive.height < 0.0 {
            (-high, -low)
        } else {
            (low, high)
        };
        let mut height = primitive.height.abs() * low.abs().at_least(high.abs());
        let mut whole = height * measure;
        if let Some([mass, density, thinness]) = primitive.taper_bounds() {
            // Bounds hold for the whole bone at its smallest width parameter; those over lines at
            // its largest density, too.
            whole = height * mass;
            height *= density;
            width *= thinness.sqrt();
        }
        let endless = match dimension {
            0 => 1.0,
            1 => 1.0 / width,
            _ => 1.0 / (width * width),
        };
        let (middle, extent) = skeleton
            .bounding_sphere()
            .unwrap_or((DVec3::ZERO, f64::INFINITY));
        let profile = primitive.profile.as_ref();
        let ripple = profile.and_then(|p| Ripple::of(p, skeleton));
        let variation = ripple.as_ref().map_or(0.0, |r| r.derivatives(0.0)[0]);
        let is_bell =
            kernel == Kernel::Gauss && primitive.height > 0.0 && primitive.tapered.is_none();
        let log_bend = if is_bell {
            finest * finest
        } else {
            f64::INFINITY
        };
        let size = match dimension {
            0 => 0.0,
            1 => (measure * finest) * (measure * finest),
            _ => measure * finest * finest,
        };
        Self {
            place: Place::of(primitive, width),
            size,
            crowding: Crowding::of(skeleton, measure, width).map(Box::new),
            kernel,
            width,
            finest,
            whole,
            endless: height * endless,
            extent,
            middle,
            dimension,
            positive: high > 0.0,
            negative: low < 0.0,
            influence: primitive.influence,
            log_bend: if high > 0.0 { log_bend } else { 0.0 },
            ripple: ripple.map(Box::new),
            variation,
        }
    }

    /// Returns how near a ball comes to the skeleton.
    #[must_use]
    pub fn nearness(&self, center: DVec3, radius: f64) -> Nearness {
        let place::Near {
            distance,
            arc_factor,
            axis_distance,
        } = self.place.nearness(center, radius);
        let within = self.kernel.is_compact()
            && (center.distance(self.middle) + radius + self.extent) * self.finest <= 1.0;
        Nearness {
            distance: (distance - radius).at_least(0.0),
            within,
            arc_factor,
            axis_distance,
        }
    }

    /// Factor ≤ 1 on the length of a span along a direction (within `spread` of it) for its error:
    /// below 1 along an infinite plane, where the field does not change.
    #[inline]
    #[must_use]
    pub fn shortened(&self, direction: DVec3, spread: f64) -> f64 {
        match &self.place {
            Place::Plane { normal, .. } => {
                (normal.dot(direction).abs() + spread + 1e-9).at_most(1.0)
            }
            _ => 1.0,
        }
    }

    /// Returns the bounds at some nearness, for spans of some length.
    #[inline(always)] // Pictures spend their time here.
    #[must_use]
    pub fn estimate(&self, near: Nearness, length: &SpanLength) -> Estimate {
        let (kernel, width) = (self.kernel, self.finest);
        let u = near.distance * self.width;
        // Derivatives by length instead of by kernel widths.
        let order = envelope::order(kernel);
        let by_width = [
            width * width,
            width * width * width,
            width * width * (width * width),
        ];
        let magnitude;
        let rough = if let Some((point, rough)) = kernel.value_and_roughness(u)
            && self.size <= 1.0 + u * u
        {
            // The bone is further away than its size: the bound for an infinite line or plane would
            // hardly be smaller.
            magnitude = self.whole * point;
            self.whole * rough
        } else if self.dimension == 0 {
            magnitude = self.whole * kernel.at_most(u);
            self.whole * envelope::rough_point(kernel, u)
        } else {
            magnitude = self.magnitude(near);
            let Roughness {
                point,
                line,
                plane,
                outward,
            } = envelope::roughness(kernel, u);
            let over_endless = match self.dimension {
                1 => match &self.crowding {
                    Some(crowding) if near.arc_factor > NEARLY_STRAIGHT => {
                        let crowded = crowding.integral_bound(
                            u,
                            |u| envelope::rough_point(kernel, u),
                            |_, _| outward,
                        );
                        (near.arc_factor * line).at_most(crowded)
                    }
                    Some(_) => near.arc_factor * line,
                    None => line,
                },
                _ => plane,
            };
            (self.endless * over_endless).at_most(self.whole * point)
        };
        let rough = rough * by_width[order - 2];
        if let Some(ripple) = &self.ripple {
            return self.estimate_with_profile(ripple, near, magnitude, rough, length);
        }
        let mut error = rough * length.0[order - 2];
        // Derivatives are 0 beyond a compact kernel's support.
        let mut fourth = if order == 4 || rough == 0.0 {
            rough
        } else {
            f64::INFINITY
        };
        if near.within {
            let inside = self.whole * kernel.inside()[1] * by_width[2];
            error = error.at_most(inside * length.0[2]);
            fourth = fourth.at_most(inside);
        }
        Estimate {
            magnitude,
            error,
            fourth,
        }
    }

    /// Returns the bounds with a profile: the smallest error over the orders of the product's
    /// derivatives. `rough` bounds the field's derivative of its kernel's order without the
    /// profile.
    #[inline(never)]
    fn estimate_with_profile(
        &self,
        ripple: &Ripple,
        near: Nearness,
        magnitude: f64,
        rough: f64,
        length: &SpanLength,
    ) -> Estimate {
        let order = envelope::order(self.kernel);
        let mut field = [f64::INFINITY; 5];
        field[0] = magnitude;
        for (i, own) in field.iter_mut().enumerate().take(order).skip(1) {
            *own = self.derivative(near, i);
        }
        field[order] = rough;
        if near.within {
            let mut scale = self.whole * (self.finest * self.finest);
            for (own, inside) in field[3..].iter_mut().zip(self.kernel.inside()) {
                scale *= self.finest;
                *own = own.at_most(scale * inside);
            }
        }
        let bounds = Ripple::of_product(&field, &ripple.derivatives(near.axis_distance));
        let errors = bounds.iter().zip(&length.0).map(|(d, h)| d * h);
        Estimate {
            magnitude,
            // `at_most` ignores NaN.
            error: errors.fold(f64::INFINITY, f64::at_most),
            fourth: f64::INFINITY,
        }
    }

    /// Returns a bound on `|∇f|` (a Lipschitz constant of f in the ball), where the profile, if
    /// any, is smooth.
    #[must_use]
    pub fn slope(&self, near: Nearness) -> f64 {
        let own = self.derivative(near, 1);
        if self.ripple.is_none() {
            return own;
        }
        let [first, ..] = self.factor(near);
        own + self.magnitude(near) * first
    }

    /// Estimates the largest |∇f|/|f|, for the effect of coordinates rounded to single precision:
    /// the profile's plus that of a Gaussian three widths out (only negligible parts of a field are
    /// steeper), or, if the field falls as a power k of the distance d, at most k/d.
    #[inline]
    #[must_use]
    pub fn relative_slope(&self, near: Nearness) -> f64 {
        let steepest = 8.0 * self.finest + self.variation;
        steepest.at_most(self.power() / near.distance)
    }

    /// Returns the size of the terms that a face's formula adds up: sums over edges cancel beside a
    /// face, and rounding is relative to their terms, not to the field. 0 for other bones and for
    /// kernels with a pole.
    #[inline]
    #[must_use]
    pub fn cancels(&self) -> f64 {
        if self.dimension == 2 && self.whole.is_finite() && !self.kernel.has_pole() {
            let plane = self.endless * self.kernel.plane(0.0).0;
            plane.at_most(self.whole)
        } else {
            0.0
        }
    }

    /// Largest exponent of the field's decay with distance; infinite if it falls faster than any
    /// power.
    #[inline]
    #[must_use]
    pub fn power(&self) -> f64 {
        match self.kernel.tail() {
            Tail::Power { .. } if self.ripple.is_none() => 4.0,
            _ => f64::INFINITY,
        }
    }

    /// Returns a bound on the second derivative of f along any line (a Lipschitz constant of the
    /// slope along a ray in the ball), where the profile, if any, is smooth.
    #[must_use]
    pub fn curvature(&self, near: Nearness) -> f64 {
        let own = self.derivative(near, 2);
        if self.ripple.is_none() {
            return own;
        }
        let [first, second, ..] = self.factor(near);
        own + (2.0 * self.derivative(near, 1) * first + self.magnitude(near) * second)
    }

    /// Returns a bound on the third derivative of f along any line in the ball, where the profile,
    /// if any, is smooth; infinite if the second derivative may jump there.
    #[must_use]
    pub fn third(&self, near: Nearness) -> f64 {
        let is_outside = self.kernel.is_compact() && near.distance * self.width >= 1.0;
        let own = if is_outside {
            return 0.0;
        } else if self.kernel.smoothness() >= 2 {
            self.derivative(near, 3)
        } else if near.within {
            let scale = self.finest * self.finest * self.finest;
            self.whole * self.kernel.inside()[0] * scale
        } else {
            f64::INFINITY
        };
        if self.ripple.is_none() {
            return own;
        }
        let [first, second, third, _] = self.factor(near);
        own + 3.0 * self.derivative(near, 2) * first
            + 3.0 * self.derivative(near, 1) * second
            + self.magnitude(near) * third
    }

    /// Returns a bound on the jump of the gradient of f at a [kink](crate::kinks) of the profile.
    #[must_use]
    pub fn jump(&self, near: Nearness) -> f64 {
        let [first, ..] = self.factor(near);
        2.0 * self.magnitude(near) * first
    }

    /// Returns bounds on the first to fourth derivative of the profile's factor, over its size; 0
    /// without a profile.
    fn factor(&self, near: Nearness) -> [f64; 4] {
        match &self.ripple {
            Some(ripple) => ripple.derivatives(near.axis_distance),
            None => [0.0; 4],
        }
    }

    /// Returns a bound on the first, second or third derivative along any line, without the
    /// profile.
    fn derivative(&self, near: Nearness, order: usize) -> f64 {
        let kernel = self.kernel;
        let u = near.distance * self.width;
        let Roughness {
            point,
            line,
            plane,
            outward,
        } = envelope::derivative(kernel, order, u);
        let over_endless = match (self.dimension, &self.place) {
            (0, _) => point,
            (1, _) => match &self.crowding {
                Some(crowding) => {
                    let crowded = crowding.integral_bound(
                        u,
                        |u| envelope::derivative(kernel, order, u).point,
                        |_, _| outward,
                    );
                    (near.arc_factor * line).at_most(crowded)
                }
                None => line,
            },
            // Planes of the inverse kernel: the slope's own formula, `2πz(G(z²) − G(z²+100))`, from
            // above; it jumps in the plane, and has a slope of less than 1 elsewhere.
            (_, Place::Plane { .. }) if !kernel.is_finite_over(1) => match order {
                1 => core::f64::consts::TAU,
                2 if u > 0.0 => core::f64::consts::TAU,
                _ => f64::INFINITY,
            },
            _ => plane,
        };
        let least = smaller(self.whole * point, self.endless * over_endless);
        (0..order).fold(least, |bound, _| bound * self.finest)
    }

    /// Returns a bound on `|f|`.
    #[inline]
    #[must_use]
    pub fn magnitude(&self, near: Nearness) -> f64 {
        let u = near.distance * self.width;
        let kernel = self.kernel;
        let point = kernel.at_most(u);
        let line = || kernel.line_at_most(u, point);
        let endless = match self.dimension {
            0 => point,
            1 if let Some(crowding) = &self.crowding
                && near.arc_factor > NEARLY_STRAIGHT =>
            {
                let crowded =
                    crowding.integral_bound(u, |u| kernel.value(u), |a, b| kernel.between(a, b));
                if near.arc_factor.is_finite() {
                    crowded.at_most(near.arc_factor * line())
                } else {
                    crowded
                }
            }
            1 if self.crowding.is_some() => near.arc_factor * line(),
            1 => line(),
            // The integral over an infinite plane diverges; that over a face is largest for a disc
            // of its area around the foot of the perpendicular.
            _ if self.whole.is_finite() && !kernel.is_finite_over(2) => {
                let near = u * u;
                let far = near + self.size / core::f64::consts::PI;
                core::f64::consts::PI * kernel.over_ring(near, far) * (1.0 + 1e-12)
            }
            _ => kernel.plane(u).0,
        };
        smaller(self.whole * point, self.endless * endless)
    }

    /// Returns a bound from below on f in a ball, ≥ 0: 0 but for kernels with a pole on a point or
    /// a curve, near which the field is much larger than its slope tells. Kernels fall with
    /// distance, so that the part of a curve within a length l of the nearest point gives l·h(d +
    /// l) or more.
    #[must_use]
    pub fn least(&self, center: DVec3, radius: f64) -> f64 {
        let is_plain = self.width == self.finest && self.ripple.is_none() && !self.negative;
        // The distance is known exactly from points, segments and arcs.
        let is_line = matches!(
            self.place,
            Place::Point(_) | Place::Segment { .. } | Place::Arc(_)
        );
        if !(self.kernel.has_pole() && is_plain && is_line) {
            return 0.0;
        }
        let distance = self.place.nearness(center, 0.0).distance + radius;
        let at = |more: f64| self.kernel.value((distance + more) * self.width);
        if self.dimension == 0 {
            return self.whole * at(0.0);
        }
        // At least half of the curve lies on one side of the nearest point.
        let half = 0.5 * self.size.sqrt() / self.finest;
        let density = self.whole / (2.0 * half);
        let (mut from, mut sum) = (0.0, 0.0);
        let mut to = distance.min(half);
        while from < half && to > from {
            sum += (to - from) * at(to);
            (from, to) = (to, (2.0 * to).min(half));
        }
        density * sum
    }

    /// Returns a part of f at a ball's centre below which f falls nowhere in the ball: kernels fall
    /// with distance, and no part of the skeleton is further away than `middle` and `extent` tell.
    #[must_use]
    pub fn remains(&self, center: DVec3, radius: f64) -> f64 {
        let nearest = self.place.nearness(center, 0.0).distance * (1.0 - 1e-12);
        let farthest = center.distance(self.middle) + self.extent + radius;
        let least = self.kernel.value(farthest * self.finest);
        let part = least / self.kernel.at_most(nearest * self.width) * (1.0 - 1e-9);
        if part.is_nan() { 0.0 } else { part.min(1.0) }
    }

    /// Returns a distance from the skeleton beyond which `|f|` is at most `share`.
    #[must_use]
    pub fn distance_of(&self, share: f64) -> f64 {
        let enough = |distance: f64| self.magnitude(Nearness::at(distance)) <= share;
        let mut high = self.influence.at_least(f64::MIN_POSITIVE);
        // The field falls at least as fast as 1/d, so a few doublings suffice.
        for _ in 0..64 {
            if enough(high) {
                break;
            }
            high *= 2.0;
        }
        let mut low = 0.0;
        for _ in 0..8 {
            let middle = 0.5 * (low + high);
            *(if enough(middle) { &mut high } else { &mut low }) = middle;
        }
        high
    }

    /// Whether there is a profile; bounds on derivatives then exclude its [kinks](crate::kinks).
    #[inline]
    #[must_use]
    pub fn has_profile(&self) -> bool {
        self.ripple.is_some()
    }

    /// Returns a factor m and a width parameter w such that `|f| ≤ m·h(w·d)` at a distance d from
    /// the skeleton, for the kernel h.
    #[must_use]
    pub fn far(&self) -> [f64; 2] {
        [self.whole, self.width]
    }

    /// Width of the kernel, a length: the least, if it varies along the bone.
    #[must_use]
    pub fn kernel_width(&self) -> f64 {
        1.0 / self.finest
    }

    /// Returns a c such that `ln f + c·t²` is convex along any line of unit speed, for the field f
    /// without the profile: the square of a Gaussian's width parameter; 0 if the field is nowhere
    /// above 0, infinite for other kernels and with a taper.
    #[inline]
    #[must_use]
    pub fn log_bend(&self) -> f64 {
        self.log_bend
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

/// Returns the smaller of two bounds. The second may be NaN, from infinity times 0, and is none
/// then.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b || b.is_nan() { a } else { b }
}
