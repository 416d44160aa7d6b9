//! What is known of a primitive without evaluating it: how large its field can be, and how far a
//! cubic Hermite span can be from it, at a given distance or more from its skeleton.
//!
//! Both follow from the kernel's own: a field is an integral of kernels, so what bounds the kernel at
//! a distance ([`envelope`](crate::envelope)) bounds the field, times the skeleton's length or area; or,
//! if that is less, integrated over an infinite line or plane.
mod place;

use crate::bounds::Coil;
use crate::envelope::{self, PEANO, Roughness};
use crate::ripple::Ripple;
use crate::{Cut, Kernel, Primitive, Real, endless, plane};
use glam::DVec3;
use place::Place;

/// Bounds of one primitive.
#[derive(Clone, Debug)]
pub struct Bound {
    place: Place,
    /// Of an arc or a curve, in kernel widths: how much of it can be near one place.
    coil: Option<Box<Coil>>,
    kernel: Kernel,
    /// The kernel's width parameter: the smallest, of a tapered bone, since kernels and envelopes fall
    /// with the width times the distance.
    width: f64,
    /// The largest width parameter, by which derivatives grow.
    finest: f64,
    /// |height| times the skeleton's measure (1 for points, infinite for planes): the field's size
    /// is that times the kernel if all of the skeleton is at one distance.
    whole: f64,
    /// |height| times the width to the power of minus the dimension: the same for integrals over
    /// an infinite line or plane in units of the width. Infinite where that says nothing.
    endless: f64,
    /// The square of the skeleton's length, or its area, in kernel widths: 0 for points.
    size: f64,
    /// For compact kernels: the radius of a ball around `middle` that holds the skeleton.
    extent: f64,
    middle: DVec3,
    dimension: u8,
    /// Whether the term can be positive and negative.
    positive: bool,
    negative: bool,
    /// Depth of influence.
    pub influence: f64,
    /// What is known of the profile, if any.
    ripple: Option<Box<Ripple>>,
    /// Its derivative over its size is nowhere more than this.
    unrest: f64,
}

/// How near a ball is to a skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// No point of the ball is nearer than this.
    pub distance: f64,
    /// Whether no point of the skeleton is further from any point of the ball than a compact
    /// kernel reaches.
    within: bool,
    /// Integrals over an arc are at most this times those over its tangent line at `distance`;
    /// infinite where that says nothing.
    stretch: f64,
    /// No point of the ball is nearer than this to an arc's axis.
    hub: f64,
}

impl Nearness {
    /// That of a place of which only its distance from the skeleton is known.
    #[must_use]
    pub fn at(distance: f64) -> Self {
        Self {
            distance,
            within: false,
            stretch: f64::INFINITY,
            hub: 0.0,
        }
    }
}

/// What is known of a primitive at some nearness.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// `|f|` is at most this.
    pub magnitude: f64,
    /// The cubic Hermite interpolant on a span of the given length is at most this far from f. With a
    /// profile: where that is smooth ([`kinks`](crate::kinks) tell where it is not); elsewhere an estimate.
    pub error: f64,
    /// The fourth derivative of f along any line is at most this, where something is known of it; else infinite.
    pub fourth: f64,
}

/// The length h of a span, as its error wants it: `cₘhᵐ` for the orders 2 to 4.
#[derive(Clone, Copy, Debug)]
pub struct SpanLength([f64; 3]);

impl SpanLength {
    /// Of a span on a ray whose direction has unit length.
    #[must_use]
    pub fn new(h: f64) -> Self {
        Self([
            PEANO[0] * h * h,
            PEANO[1] * h * h * h,
            PEANO[2] * (h * h) * (h * h),
        ])
    }

    /// What a bound on the fourth derivative is to be multiplied with.
    #[must_use]
    pub fn fourth(&self) -> f64 {
        self.0[2]
    }
}

/// Arcs that are stretched by no more than this are not asked how much of them can be near: what that would say is seldom
/// less, and costs arcs of tangents.
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
            // All of the bone as if it had the smallest width; lines as if the largest density, too.
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
        let unrest = ripple.as_ref().map_or(0.0, |r| r.derivatives(0.0)[0]);
        let size = match dimension {
            0 => 0.0,
            1 => (measure * finest) * (measure * finest),
            _ => measure * finest * finest,
        };
        Self {
            place: Place::of(primitive, width),
            size,
            coil: Coil::of(skeleton, measure, width).map(Box::new),
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
            ripple: ripple.map(Box::new),
            unrest,
        }
    }

    /// How near the points of a ball come to the skeleton.
    #[must_use]
    pub fn nearness(&self, center: DVec3, radius: f64) -> Nearness {
        let place::Near {
            distance,
            stretch,
            hub,
        } = self.place.nearness(center, radius);
        let within = self.kernel.is_compact()
            && (center.distance(self.middle) + radius + self.extent) * self.finest <= 1.0;
        Nearness {
            distance: (distance - radius).at_least(0.0),
            within,
            stretch,
            hub,
        }
    }

    /// A span along a direction, or one that differs from it by no more than `spread`, is as near to the field as one
    /// so many times as long may be: at most 1. Along an infinite plane the field does not change.
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

    /// The bounds at some nearness, for spans of some length.
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
        let rough = if kernel == Kernel::Cauchy && self.size <= 1.0 + u * u {
            // Further away than it is long, or than its area is wide: that of an endless line or plane would be hardly less.
            let (point, rough) = envelope::cauchy_point(u);
            magnitude = self.whole * point;
            self.whole * rough
        } else if self.dimension == 0 {
            magnitude = self.whole * size(kernel, u);
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
                1 => match &self.coil {
                    Some(coil) if near.stretch > NEARLY_STRAIGHT => {
                        let at = |u| envelope::rough_point(kernel, u);
                        (near.stretch * line).at_most(coil.bound(u, at, |_, _| outward))
                    }
                    Some(_) => near.stretch * line,
                    None => line,
                },
                _ => plane,
            };
            (self.endless * over_endless).at_most(self.whole * point)
        };
        let rough = rough * by_width[order - 2];
        if let Some(ripple) = &self.ripple {
            return self.rippled(ripple, near, magnitude, rough, length);
        }
        let mut error = rough * length.0[order - 2];
        // Beyond a compact kernel's reach nothing is rough.
        let mut fourth = if order == 4 || rough == 0.0 {
            rough
        } else {
            f64::INFINITY
        };
        if near.within {
            let inside = self.whole * envelope::inside(kernel)[1] * by_width[2];
            error = error.at_most(inside * length.0[2]);
            fourth = fourth.at_most(inside);
        }
        Estimate {
            magnitude,
            error,
            fourth,
        }
    }

    /// The bounds with a profile: the error by whichever derivative of the product says most. `rough` is the field's own
    /// derivative of its kernel's order.
    #[inline(never)]
    fn rippled(
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
            for (own, inside) in field[3..].iter_mut().zip(envelope::inside(self.kernel)) {
                scale *= self.finest;
                *own = own.at_most(scale * inside);
            }
        }
        let bounds = Ripple::of_product(&field, &ripple.derivatives(near.hub));
        let errors = bounds.iter().zip(&length.0).map(|(d, h)| d * h);
        Estimate {
            magnitude,
            // What is no number is left out.
            error: errors.fold(f64::INFINITY, f64::at_most),
            fourth: f64::INFINITY,
        }
    }

    /// `|∇f|` is at most this at some nearness (a Lipschitz constant of the ball): where the profile,
    /// if any, is smooth.
    #[must_use]
    pub fn slope(&self, near: Nearness) -> f64 {
        let [first, ..] = self.factor(near);
        self.derivative(near, 1) + self.magnitude(near) * first
    }

    /// About the largest slope of f over its size at some nearness, as far as single precision's rounding of coordinates
    /// asks for it: that of a Gaussian three widths out, steeper than which is only what is small; of what falls as
    /// a power of the distance no more than that over the distance; with the profile's.
    #[inline]
    #[must_use]
    pub fn relative_slope(&self, near: Nearness) -> f64 {
        let steepest = 8.0 * self.finest + self.unrest;
        steepest.at_most(self.power() / near.distance)
    }

    /// What formulas of faces add up to the field may be as large as this, however small the field is: they sum over
    /// edges, and beside a face those sums cancel. Rounding is relative to it.
    #[inline]
    #[must_use]
    pub fn cancels(&self) -> f64 {
        if self.dimension == 2 && self.whole.is_finite() && !self.kernel.has_pole() {
            let plane = self.endless * plane::jet(self.kernel, [0.0; 3]).value;
            plane.at_most(self.whole)
        } else {
            0.0
        }
    }

    /// Where the field falls as a power of the distance, or slower, that power; else infinite.
    #[inline]
    #[must_use]
    pub fn power(&self) -> f64 {
        match self.kernel {
            Kernel::Cauchy | Kernel::Inverse | Kernel::Squared | Kernel::Cubed
                if self.ripple.is_none() =>
            {
                4.0
            }
            _ => f64::INFINITY,
        }
    }

    /// The second derivative of f along any line is at most this at some nearness (a Lipschitz constant of
    /// the slope along a ray within the ball): where the profile, if any, is smooth.
    #[must_use]
    pub fn curvature(&self, near: Nearness) -> f64 {
        let [first, second, ..] = self.factor(near);
        let wave = 2.0 * self.derivative(near, 1) * first + self.magnitude(near) * second;
        self.derivative(near, 2) + wave
    }

    /// Bounds on the derivatives of the profile's factor over its size.
    fn factor(&self, near: Nearness) -> [f64; 4] {
        let of = |ripple: &Ripple| ripple.derivatives(near.hub);
        self.ripple.as_deref().map_or([0.0; 4], of)
    }

    /// A bound on the first, second or third derivative along any line, without the profile's.
    fn derivative(&self, near: Nearness, order: usize) -> f64 {
        let kernel = self.kernel;
        let u = near.distance * self.width;
        let bounds_at = |u| envelope::derivative(kernel, order, u);
        let Roughness {
            point,
            line,
            plane,
            outward,
        } = bounds_at(u);
        let over_endless = match (self.dimension, &self.place) {
            (0, _) => point,
            (1, _) => match &self.coil {
                Some(coil) => {
                    let at = |u| bounds_at(u).point;
                    (near.stretch * line).at_most(coil.bound(u, at, |_, _| outward))
                }
                None => line,
            },
            // Of planes of poles: the slope's own formula, `2πz(G(z²) − G(z²+100))`, from above; it
            // jumps in the plane, and has a slope of less than 1 elsewhere.
            (_, Place::Plane { .. }) if kernel == Kernel::Inverse => match order {
                1 => core::f64::consts::TAU,
                2 if u > 0.0 => core::f64::consts::TAU,
                _ => f64::INFINITY,
            },
            _ => plane,
        };
        let whole = self.whole * point;
        let endless = self.endless * over_endless;
        let least = if whole < endless || endless.is_nan() {
            whole
        } else {
            endless
        };
        (0..order).fold(least, |bound, _| bound * self.finest)
    }

    /// `|f|` is at most this at some nearness.
    #[inline]
    #[must_use]
    pub fn magnitude(&self, near: Nearness) -> f64 {
        let u = near.distance * self.width;
        let kernel = self.kernel;
        let point = size(kernel, u);
        let line = || match kernel {
            // No endless line of the inverse kernel has a finite field.
            Kernel::Inverse => f64::INFINITY,
            Kernel::Gauss => core::f64::consts::PI.sqrt() * point,
            _ => endless::line(kernel, u),
        };
        let endless = match self.dimension {
            0 => point,
            1 if let Some(coil) = &self.coil
                && near.stretch > NEARLY_STRAIGHT =>
            {
                let outward = |a, b| kernel.between(a, b);
                let coiled = coil.bound(u, |u| kernel.value(u), outward);
                if near.stretch.is_finite() {
                    coiled.at_most(near.stretch * line())
                } else {
                    coiled
                }
            }
            1 if self.coil.is_some() => near.stretch * line(),
            1 => line(),
            // Finite planes of these may be larger than those that stand for infinite ones.
            _ if self.whole.is_finite() && !kernel.falls_fast() => f64::INFINITY,
            _ => plane::jet(kernel, [0.0, 0.0, u]).value,
        };
        // Infinity times 0 says nothing either way.
        let least = |a: f64, b: f64| if a < b || b.is_nan() { a } else { b };
        least(self.whole * point, self.endless * endless)
    }

    /// A distance from the skeleton beyond which `|f|` is at most `share`.
    #[must_use]
    pub fn distance_of(&self, share: f64) -> f64 {
        let enough = |distance: f64| self.magnitude(Nearness::at(distance)) <= share;
        let mut high = self.influence.at_least(f64::MIN_POSITIVE);
        // The field falls at least as fast as 1/d, so this doubles some times only.
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

    /// Whether there is a profile, whose [kinks](crate::kinks) no bound on a derivative tells of.
    #[inline]
    #[must_use]
    pub fn has_profile(&self) -> bool {
        self.ripple.is_some()
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

/// The kernel's value from above, quickly.
#[inline]
fn size(kernel: Kernel, u: f64) -> f64 {
    match kernel {
        // Single precision's is right to 10⁻⁶, and not yet 0.
        Kernel::Gauss if u < 9.0 => f64::from(Real::decay((u * u) as f32)) * (1.0 + 1e-5),
        // e⁻⁸¹; there is nothing to know more exactly.
        Kernel::Gauss => 7e-36,
        Kernel::Cauchy => envelope::cauchy_point(u).0,
        _ => kernel.value(u),
    }
}
