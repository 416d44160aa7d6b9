//! What is known of a primitive without evaluating it: how large its field can be, and how far a
//! cubic Hermite span can be from it, at a given distance or more from its skeleton.
//!
//! Both follow from the kernel's own: a field is an integral of kernels, so what bounds the kernel at
//! a distance ([`envelope`](crate::envelope)) bounds the field, times the skeleton's length or area; or,
//! if that is less, integrated over an infinite line or plane.
use crate::envelope::{self, PEANO, Roughness};
use crate::{Kernel, Primitive, Real, Skeleton, bounds, endless, plane};
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
    /// Balls that hold the pieces of a curve.
    balls: Vec<(DVec3, f64)>,
    /// Length and radius of an arc in kernel widths; 0 for others.
    coil: [f64; 2],
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
    /// For compact kernels: the radius of a ball around `middle` that holds the skeleton.
    extent: f64,
    middle: DVec3,
    dimension: u8,
    /// Whether the term can be positive and negative.
    positive: bool,
    negative: bool,
    /// Depth of influence.
    pub influence: f64,
    /// With a profile, an estimate of its wave's derivative over its size; else 0.
    ripple: f64,
    /// With a profile, an estimate of the fourth derivative of its wave over its size; else 0.
    ripple4: f64,
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
}

/// What is known of a primitive at some nearness.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// `|f|` is at most this.
    pub magnitude: f64,
    /// The cubic Hermite interpolant on a span of the given length is at most this far from f. With a
    /// profile, whose waves may have kinks and jumps where no such bound exists, an estimate.
    pub error: f64,
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
}

impl Bound {
    /// The bounds of a primitive.
    #[must_use]
    pub fn new(primitive: &Primitive) -> Self {
        use core::f64::consts::{PI, TAU};
        let mut skeleton = primitive.skeleton.clone();
        let measure = skeleton.measure();
        let dimension = skeleton.dimension();
        let (mut axis, mut length, mut turn, mut sag) = (DVec3::ZERO, 0.0, (0.0, 1.0), 1.0);
        let mut coil = [0.0; 2];
        match &mut skeleton {
            Skeleton::Point { .. } => (),
            Skeleton::Segment { base, apex } => {
                axis = (*apex - *base).normalize_or_zero();
                length = measure;
            }
            Skeleton::Arc {
                u,
                v,
                angle,
                radius,
                ..
            } => {
                coil = [measure, *radius].map(|x| x * primitive.width);
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
            Skeleton::Polygon { rings } => {
                axis = crate::skeleton::area_vector(rings).normalize_or_zero();
            }
            Skeleton::Curve { .. } => (),
            Skeleton::Plane { normal, .. } => {
                *normal = normal.try_normalize().unwrap_or(DVec3::Z);
            }
        }
        let (kernel, finest) = (primitive.kernel, primitive.width);
        let mut width = finest;
        let (low, high) = primitive.profile.map_or((1.0, 1.0), |p| {
            let [a, b] = p.bounds.map(|b| b * p.times);
            (a.min(b), a.max(b))
        });
        let (low, high) = if primitive.height < 0.0 {
            (-high, -low)
        } else {
            (low, high)
        };
        let mut height = primitive.height.abs() * low.abs().max(high.abs());
        let mut whole = height * measure;
        if let Some([mass, density, thinness]) = primitive.taper_bounds() {
            // All of the bone as if it had the smallest width; lines as if the largest density, too.
            whole = height * mass;
            height *= density;
            width *= thinness.sqrt();
            coil = [0.0; 2];
        }
        let endless = match (dimension, &skeleton) {
            // A curve may coil, so that it is nowhere near a straight line.
            (_, Skeleton::Curve { .. }) => f64::INFINITY,
            (_, Skeleton::Arc { .. }) if primitive.tapered.is_some() => f64::INFINITY,
            (0, _) => 1.0,
            (1, _) => 1.0 / width,
            _ => 1.0 / (width * width),
        };
        let (middle, extent) = skeleton
            .bounding_sphere()
            .unwrap_or((DVec3::ZERO, f64::INFINITY));
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
            coil,
            balls: primitive.prepared.double.balls(),
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
            ripple,
            ripple4: (ripple * ripple) * (ripple * ripple),
        }
    }

    /// How near the points of a ball come to the skeleton.
    #[must_use]
    pub fn nearness(&self, center: DVec3, radius: f64) -> Nearness {
        let mut stretch = 1.0;
        let distance = match &self.skeleton {
            Skeleton::Point { center: c } => center.distance(*c),
            Skeleton::Segment { base, .. } => {
                let d = center - *base;
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
                let (sweep, angle) = (*sweep, *angle);
                let d = center - *c;
                let (x, y, z) = (d.dot(*u), d.dot(*v), d.dot(self.axis));
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
                    stretch = (1.0 / shrink).max(1.0);
                    let off = rho - sweep;
                    (off * off + z * z).sqrt()
                } else {
                    stretch = f64::INFINITY;
                    let start = (x - sweep) * (x - sweep) + y * y;
                    let (ex, ey) = (x - sweep * cos, y - sweep * sin);
                    (start.min(ex * ex + ey * ey) + z * z).sqrt()
                }
            }
            Skeleton::Triangle { corners } => self.triangle_distance(*corners, center),
            Skeleton::Polygon { .. } => self.skeleton.distance(center),
            // Within a ball nothing is known of the distance, which a pole asks for.
            // (Of two bends the search may take the wrong one, by half its step.)
            Skeleton::Curve { control } if !self.kernel.falls_fast() => {
                let fastest = control
                    .windows(2)
                    .fold(0.0_f64, |v, w| v.max(3.0 * w[0].distance(w[1])));
                let step = fastest / f64::from(crate::skeleton::SAMPLES);
                (self.skeleton.distance(center) - 0.5 * step).max(0.0)
            }
            Skeleton::Curve { .. } => {
                let far = self.balls.iter().map(|(c, r)| center.distance(*c) - r);
                far.fold(f64::INFINITY, f64::min).max(0.0)
            }
            Skeleton::Plane { point, normal } => (center - *point).dot(*normal).abs(),
        };
        let within = self.kernel.is_compact()
            && (center.distance(self.middle) + radius + self.extent) * self.finest <= 1.0;
        Nearness {
            distance: (distance - radius).max(0.0),
            within,
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

    /// The bounds at some nearness, for spans of some length.
    #[inline(always)] // Pictures spend their time here.
    #[must_use]
    pub fn estimate(&self, near: Nearness, length: &SpanLength) -> Estimate {
        let (kernel, width) = (self.kernel, self.finest);
        let u = near.distance * self.width;
        let magnitude = self.magnitude(near);
        // Derivatives by length instead of by kernel widths.
        let order = envelope::order(kernel);
        let Roughness {
            point,
            line,
            plane,
            outward,
        } = envelope::roughness(kernel, u);
        let over_endless = match self.dimension {
            0 => point,
            1 if self.coil[0] > 0.0 => {
                let [length, radius] = self.coil;
                let at = |u| envelope::roughness(kernel, u).point;
                (near.stretch * line).min(bounds::coiled(length, radius, u, at, |_, _| outward))
            }
            1 => line,
            _ => plane,
        };
        let by_width = [
            width * width,
            width * width * width,
            width * width * (width * width),
        ];
        let rough = (self.endless * over_endless).min(self.whole * point);
        let mut error = rough * by_width[order - 2] * length.0[order - 2];
        if near.within {
            let inside = self.whole * envelope::inside4(kernel);
            error = error.min(inside * by_width[2] * length.0[2]);
        }
        if self.ripple4 > 0.0 {
            error += self.ripple4 * magnitude * length.0[2];
        }
        Estimate { magnitude, error }
    }

    /// `|∇f|` is at most this at some nearness (a Lipschitz constant of the ball): where the profile,
    /// if any, is smooth.
    #[must_use]
    pub fn slope(&self, near: Nearness) -> f64 {
        // A wave of length 1/ω adds its own slope to the field's size.
        self.derivative(near, 1) + self.magnitude(near) * self.ripple
    }

    /// About the largest slope of f over its size, as far as single precision's rounding of coordinates asks for
    /// it: that of a Gaussian three widths out, steeper than which is only what is small; with the profile's.
    #[inline]
    #[must_use]
    pub fn relative_slope(&self) -> f64 {
        8.0 * self.finest + self.ripple
    }

    /// The second derivative of f along any line is at most this at some nearness (a Lipschitz constant of
    /// the slope along a ray within the ball): where the profile, if any, is smooth.
    #[must_use]
    pub fn curvature(&self, near: Nearness) -> f64 {
        let ripple = self.ripple;
        let wave = 2.0 * self.derivative(near, 1) + self.magnitude(near) * ripple;
        self.derivative(near, 2) + wave * ripple
    }

    /// A bound on the first or second derivative along any line, without the profile's.
    fn derivative(&self, near: Nearness, order: usize) -> f64 {
        let kernel = self.kernel;
        let u = near.distance * self.width;
        let bounds_at = |u| match order {
            1 => envelope::steepness(kernel, u),
            _ => envelope::curvature(kernel, u),
        };
        let Roughness {
            point,
            line,
            plane,
            outward,
        } = bounds_at(u);
        let over_endless = match (self.dimension, &self.skeleton) {
            (0, _) => point,
            (1, Skeleton::Arc { .. }) => {
                let [length, radius] = self.coil;
                let at = |u| bounds_at(u).point;
                // Without a length there is no coil, and no line either.
                let coiled = bounds::coiled(length, radius, u, at, |_, _| outward);
                let line = near.stretch * line;
                if line < coiled { line } else { coiled }
            }
            (1, _) => line,
            // Of planes of poles: the slope's own formula, `2πz(G(z²) − G(z²+100))`, from above; it
            // jumps in the plane, and has a slope of less than 1 elsewhere.
            (_, Skeleton::Plane { .. }) if kernel == Kernel::Inverse => match order {
                2 if u == 0.0 => f64::INFINITY,
                _ => core::f64::consts::TAU,
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
        let by_width = if order == 1 { 1.0 } else { self.finest };
        least * by_width * self.finest
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
            1 if self.coil[0] > 0.0 => {
                let [length, radius] = self.coil;
                let outward = |a, b| kernel.along(b) - kernel.along(a);
                let coiled = bounds::coiled(length, radius, u, |u| kernel.value(u), outward);
                if near.stretch.is_finite() {
                    coiled.min(near.stretch * line())
                } else {
                    coiled
                }
            }
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
        let mut distance = self.influence.max(f64::MIN_POSITIVE);
        // Every field falls at least as fast as 1/d², so this doubles a few times only.
        for _ in 0..64 {
            let near = Nearness {
                distance,
                within: false,
                stretch: f64::INFINITY,
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

/// The kernel's value from above, quickly.
#[inline]
fn size(kernel: Kernel, u: f64) -> f64 {
    match kernel {
        // Single precision's exponential is right to 10⁻⁶, and 0 where it is below 10⁻³⁷.
        Kernel::Gauss if u < 9.0 => f64::from(Real::exp(-(u * u) as f32)) * (1.0 + 1e-5),
        _ => kernel.value(u),
    }
}
