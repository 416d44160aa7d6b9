//! Blobs: primitives whose field along a ray has closed-form bounds on every interval of the ray.
//!
//! A *blob* is a point with a compact or the Gaussian kernel, or a Gaussian segment, that adds to
//! the field, does not taper, and has no profile other than a linear one along the segment
//! ([`Ramp`]). For these `q(t) = q₀ + k(t−c)²`, the square of the distance from the point, or from
//! the segment's line, in units of the kernel's width, is a parabola. A segment's field has one
//! more factor, the fraction W of the Gaussian's integral that lies on it, which depends on the
//! position x along it, which is linear in t.
//!
//! On an interval of t the field is at most its value with the least q and the most central x of
//! the interval. Its second derivative is at least `−2k·amplitude·|G′(q)|`, with the least q: for
//! `g″ = amplitude·(2k·G′ + 4k²(t−c)²·G″)`, and all kernels G of q fall and are convex, so G″ ≥ 0
//! and |G′| falls. A segment is a sum of such points, and a Gaussian has |G′| = G. With a ramp r
//! the field is `g·r`, so that −(gr)″ is at most `−g″·r + 2|g′||r′|` between the ramp's kinks; in a
//! kink the slope falls by no more than `g·|r′|`.
use crate::bone::{Bone, Segment};
use crate::kernel::gauss;
use crate::ramp::Ramp;
use crate::real::Scalar;
use crate::term::{Evaluate, Frame, Prepared};
use crate::{Jet, Kernel, Primitive, Real, THRESHOLD};
use core::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};
use glam::DVec3;

/// Half the length, in kernel widths, from which a segment is a blob: at that length the difference
/// of the two error functions keeps enough digits.
const SHORT: f64 = 0.5;
/// Amplitudes and width parameters of blobs are at most this.
const LARGEST_BLOB: f64 = 1e9;
/// Number of Newton steps to a compact blob's surface.
const NEWTON: usize = 5;
/// Half length, in kernel widths, from which the further end of a Gaussian segment contributes
/// nothing: erfc 4 = 1.5·10⁻⁸.
const LONG: f64 = 4.0;

/// Distance inward from a segment's ends, in kernel widths, beyond which the ends hardly count:
/// `e^(−x²)` is at most [`INNER_BELL`] there.
const INNER_DISTANCE: f64 = 3.0;
/// Upper bound on e^(−9), see [`INNER_DISTANCE`].
const INNER_BELL: f64 = 1.3e-4;

/// A blob's field as a function of t on rays `origin + t·direction` with unit directions, one ray
/// per lane.
#[derive(Clone, Copy, Debug)]
pub struct BlobOnRay<R: Real> {
    kernel: Kernel,
    amplitude: R,
    /// Parameter t at which q is smallest.
    center: R,
    /// The smallest q.
    least: R,
    /// Growth of q: `q = least + pace·(t − center)²`.
    pace: R,
    /// `1/√pace`, at most 10⁶.
    width: R,
    /// Position along a segment, `x = place + rate·t`, in kernel widths from its middle; 0 for a
    /// point.
    place: R,
    rate: R,
    segment: Option<SegmentOnRay<R::Scalar>>,
}

/// Upper bounds on a blob's field on an interval of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Limits<R> {
    /// Largest value.
    pub most: R,
    /// Largest value of −f″, outside of kinks.
    pub bend: R,
    /// Largest total drop of the slope in kinks.
    pub kink: R,
}

/// Extent of a segment along its axis, |x| ≤ half in kernel widths, and its ramp.
#[derive(Clone, Copy, Debug)]
struct SegmentOnRay<S> {
    half: S,
    long: bool,
    ramp: Option<Ramp<S>>,
}

/// A blob in local form: a point or a segment whose field along rays has closed-form bounds
/// ([module](self)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob<S> {
    kernel: Kernel,
    /// The kernel's width parameter.
    scale: S,
    amplitude: S,
    segment: Option<SegmentFrame<S>>,
}

/// Local frame of a segment, and half its length in kernel widths.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SegmentFrame<S> {
    half: S,
    axes: [[S; 3]; 3],
    ramp: Option<Ramp<S>>,
}

/// An upper bound on a blob's field by the distance from its bone, one blob per lane: `peak·G(q)`
/// with `√q = scale·distance`; for compact kernels, which are convex in q, the chord `peak·(1−q)`.
#[derive(Clone, Copy, Debug)]
pub struct Ceiling<R> {
    /// Bound on the field everywhere.
    pub peak: R,
    /// The kernel's width parameter.
    pub scale: R,
    /// 1 for compact kernels, 0 for the Gaussian.
    pub compact: R,
}

impl<R: Real> Ceiling<R> {
    /// Returns the bound on the field at this distance ≥ 0 from the bone and beyond.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, distance: R) -> R {
        let zero = R::splat(0.0);
        let away = distance * self.scale;
        let square = away * away;
        let chord = (R::splat(1.0) - square).max(zero);
        self.peak * R::select(zero.lt(self.compact), chord, square.decay_at_most())
    }
}

impl Primitive {
    /// Returns the primitive as a blob about [`Primitive::blob_middle`]; `None` if it is none
    /// ([module](crate::blob)) or its width or amplitude exceed single precision's range.
    #[must_use]
    pub fn blob<S: Scalar + Evaluate>(&self) -> Option<Blob<S>> {
        let term = S::term_of(&self.prepared);
        let ends = self.kernel == Kernel::Gauss || self.kernel.is_compact();
        let plain = ends && self.tapered.is_none();
        let amplitude = self.prepared.double.amplitude;
        // Derivatives of larger ones overflow single precision.
        if !(plain && amplitude > 0.0 && amplitude <= LARGEST_BLOB && self.width <= LARGEST_BLOB) {
            return None;
        }
        let waves = self.prepared.double.waves.as_ref();
        let segment = match &term.form.bone {
            Bone::Point if waves.is_none() => None,
            Bone::Segment(Segment { half })
                if self.kernel == Kernel::Gauss && half.lane(0) >= SHORT =>
            {
                let ramp = match waves {
                    Some(waves) => Some(Ramp::of(waves, half.lane(0))?),
                    None => None,
                };
                if ramp.is_some_and(|ramp| amplitude * ramp.largest() > LARGEST_BLOB) {
                    return None;
                }
                let ramp = ramp.map(|ramp| ramp.cast(S::round));
                Some(SegmentFrame {
                    half: *half,
                    axes: term.frame.axes,
                    ramp,
                })
            }
            _ => return None,
        };
        Some(Blob {
            kernel: self.kernel,
            scale: S::round(self.width),
            amplitude: term.amplitude,
            segment,
        })
    }

    /// Returns the primitive as a blob if it is a point that adds to the field, without a profile,
    /// of a kernel that never ends. Such blobs have no reach, but the same bounds on intervals:
    /// their kernels fall and are convex in q, too.
    #[must_use]
    pub fn endless_point<S: Scalar + Evaluate>(&self) -> Option<Blob<S>> {
        let Prepared { double, .. } = &self.prepared;
        let ends = self.kernel == Kernel::Gauss || self.kernel.is_compact();
        let fits = |x: f64| x > 0.0 && x <= LARGEST_BLOB;
        let is_point = matches!(double.form.bone, Bone::Point);
        let plain = is_point && double.waves.is_none() && !ends && self.tapered.is_none();
        (plain && fits(double.amplitude) && fits(self.width)).then(|| Blob {
            kernel: self.kernel,
            scale: S::round(self.width),
            amplitude: S::term_of(&self.prepared).amplitude,
            segment: None,
        })
    }

    /// Position of the point, or middle of the segment.
    #[must_use]
    pub fn blob_middle(&self) -> DVec3 {
        DVec3::from_array(self.prepared.double.frame.origin)
    }
}

impl Blob<f32> {
    /// Returns a Gaussian point with this width parameter and this field at its centre; `None` if
    /// its derivatives would overflow.
    pub(crate) fn point(scale: f64, amplitude: f64) -> Option<Self> {
        (amplitude > 0.0 && amplitude <= LARGEST_BLOB && scale <= LARGEST_BLOB).then_some(Self {
            kernel: Kernel::Gauss,
            scale: scale as f32,
            amplitude: amplitude as f32,
            segment: None,
        })
    }
}

impl<S: Scalar> Blob<S> {
    /// Returns the squared distance q from the bone, in kernel widths, beyond which the field is at
    /// most `level`.
    #[must_use]
    pub fn reach(&self, level: f64) -> f64 {
        if self.kernel != Kernel::Gauss {
            return 1.0;
        }
        libm::log((self.peak() / level).max(1.0))
    }

    /// Bound on the field everywhere.
    fn peak(&self) -> f64 {
        let amplitude = self.amplitude.lane(0);
        match &self.segment {
            // The integral over an infinite line.
            Some(segment) => {
                let factor = segment
                    .ramp
                    .map_or(1.0, |ramp| ramp.cast(|x| x.lane(0)).largest());
                amplitude * factor * core::f64::consts::PI.sqrt()
            }
            None => amplitude,
        }
    }

    /// Returns a bound on the field by the distance from the bone. It holds beyond the ends of a
    /// segment of half length H, too, at x along it, because
    /// `erf(x+H) − erf(x−H) ≤ erfc(x−H) ≤ exp(−(x−H)²)`.
    #[must_use]
    pub fn ceiling(&self) -> Ceiling<f64> {
        Ceiling {
            peak: self.peak(),
            scale: self.scale.lane(0),
            compact: f64::from(u8::from(self.kernel != Kernel::Gauss)),
        }
    }

    /// Vector from the segment's middle to its end; 0 for a point.
    #[must_use]
    pub fn half(&self) -> DVec3 {
        self.segment.map_or(DVec3::ZERO, |segment| {
            let scale = self.scale.lane(0);
            let along = DVec3::from_array(segment.axes[0].map(|x| x.lane(0)));
            along * (segment.half.lane(0) / (scale * scale))
        })
    }

    /// Radius of a ball about the middle that holds all points with `q ≤ square`.
    #[must_use]
    pub fn radius(&self, square: f64) -> f64 {
        let half = self.segment.map_or(0.0, |segment| segment.half.lane(0));
        (half + square.sqrt()) / self.scale.lane(0)
    }

    /// Returns the q at which the blob alone would have its surface, given its [`Blob::reach`] for
    /// `level`; negative if it has none. A point's field is at least T from there inwards; a
    /// segment's is less near its ends, and everywhere if it is short.
    #[must_use]
    pub fn core(&self, square: f64, level: f64) -> f64 {
        if self.kernel == Kernel::Gauss {
            return square + libm::log(level / THRESHOLD);
        }
        let wanted = THRESHOLD / self.amplitude.lane(0);
        if wanted >= 1.0 {
            return -1.0;
        }
        // Kernels fall and are convex in q, so that Newton's steps from 0 never leave the inside.
        (0..NEWTON).fold(0.0, |q, _| {
            let [value, slope, ..] = self.kernel.derivatives(q);
            (q + (wanted - value) / slope).min(1.0)
        })
    }

    /// Returns the q at which a point of a kernel that never ends has this field alone; negative if
    /// it has not.
    #[must_use]
    pub fn square_of(&self, field: f64) -> f64 {
        let ratio = self.amplitude.lane(0) / field;
        self.kernel.square_of(ratio)
    }

    /// The kernel's width parameter, and the field where q is 0 over the kernel's value there.
    #[must_use]
    pub fn scale_and_amplitude(&self) -> [S; 2] {
        [self.scale, self.amplitude]
    }

    /// Estimates the largest slope of the field where it is at most T: perpendicular to the bone,
    /// at `q = core` ([`Blob::core`]) or further out. A compact kernel's `|G′|√q` is at most
    /// `|G′|`, which falls; a Gaussian's falls from q = ½ on.
    #[must_use]
    pub fn steepness(&self, core: f64) -> f64 {
        let scale = self.scale.lane(0);
        let twice = 2.0 * scale;
        if self.kernel == Kernel::Gauss {
            let ramp = self.segment.and_then(|segment| segment.ramp);
            let ramp = ramp.map_or(0.0, |ramp| scale * ramp.cast(|x| x.lane(0)).steepness());
            return (twice * core.max(0.5).sqrt() + ramp) * THRESHOLD;
        }
        twice * self.amplitude.lane(0) * self.kernel.derivatives(core.max(0.0))[1].abs()
    }

    /// Whether it is a segment.
    #[must_use]
    pub fn is_segment(&self) -> bool {
        self.segment.is_some()
    }

    /// Value and gradient at a position relative to the middle.
    #[inline(always)]
    #[must_use]
    pub fn jet<R: Real<Scalar = S>>(&self, position: [R; 3]) -> Jet<R> {
        let amplitude = R::lift(self.amplitude);
        let Some(segment) = &self.segment else {
            let scale = R::lift(self.scale);
            let jet = self.kernel.jet(&Bone::Point, position.map(|x| x * scale));
            let steep = amplitude * scale;
            return Jet {
                value: amplitude * jet.value,
                gradient: jet.gradient.map(|g| steep * g),
            };
        };
        let frame = Frame {
            origin: [S::splat(0.0); 3],
            axes: segment.axes,
        };
        let bone = Segment { half: segment.half };
        let place = frame.local(position);
        let mut jet = gauss::segment::jet(&bone, place).times(amplitude);
        if let Some(ramp) = &segment.ramp {
            let (factor, rise) = ramp.at(place[0]);
            let rise = rise * jet.value;
            jet = jet.times(factor);
            jet.gradient[0] = jet.gradient[0] + rise;
        }
        Jet {
            value: jet.value,
            gradient: frame.world(jet.gradient),
        }
    }

    /// The field on rays with these unit directions, given the blob's middle relative to their
    /// origins.
    #[inline(always)]
    #[must_use]
    pub fn on_ray<R: Real<Scalar = S>>(&self, middle: [R; 3], direction: [R; 3]) -> BlobOnRay<R> {
        let amplitude = R::lift(self.amplitude);
        let [ox, oy, oz] = middle;
        let [dx, dy, dz] = direction;
        if let Some(segment) = &self.segment {
            // The ray in the segment's frame; t = 0 at its origin.
            let [(x, rate), (y, vy), (z, vz)] = segment.axes.map(|axis| {
                let [ax, ay, az] = axis.map(R::lift);
                (-(ax * ox + ay * oy + az * oz), ax * dx + ay * dy + az * dz)
            });
            let pace = vy * vy + vz * vz;
            // A ray parallel to the segment has no nearest point; without this, rounding would
            // choose one.
            let still = R::splat(1e-12) * (pace + rate * rate);
            let zero = R::splat(0.0);
            let center = R::select(pace.lt(still), zero, -(y * vy + z * vz) / pace);
            let (y, z) = (y + vy * center, z + vz * center);
            return BlobOnRay {
                kernel: self.kernel,
                amplitude: amplitude * R::splat(1.0 / FRAC_2_SQRT_PI),
                center,
                least: y * y + z * z,
                pace,
                width: R::splat(1.0) / pace.max(R::splat(1e-12)).sqrt(),
                place: x,
                rate,
                segment: Some(SegmentOnRay {
                    half: segment.half,
                    long: segment.half.lane(0) >= LONG,
                    ramp: segment.ramp,
                }),
            };
        }
        let scale = R::lift(self.scale);
        let pace = scale * scale;
        // The cross product keeps the digits that a difference of squares would lose.
        let (x, y, z) = (oy * dz - oz * dy, oz * dx - ox * dz, ox * dy - oy * dx);
        BlobOnRay {
            kernel: self.kernel,
            amplitude,
            center: ox * dx + oy * dy + oz * dz,
            least: pace * (x * x + y * y + z * z),
            pace,
            width: R::lift(S::splat(1.0) / self.scale.max(S::splat(1e-6))),
            place: R::splat(0.0),
            rate: R::splat(0.0),
            segment: None,
        }
    }
}

impl<R: Real> BlobOnRay<R> {
    /// Returns value and derivative at t.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, t: R) -> (R, R) {
        let ahead = self.center - t;
        let swift = self.pace * ahead;
        let (value, fall) = self.kernel.falling(self.least + swift * ahead);
        let Some(segment) = &self.segment else {
            let steep = self.amplitude * fall;
            return (self.amplitude * value, steep * (swift + swift));
        };
        let beside = self.amplitude * value;
        let (share, change) = self.share(segment, t);
        let (value, slope) = (beside * share, beside * (change + (swift + swift) * share));
        match &segment.ramp {
            None => (value, slope),
            Some(ramp) => {
                let (factor, rise) = ramp.at(self.place + self.rate * t);
                (value * factor, slope * factor + value * rise * self.rate)
            }
        }
    }

    /// Returns value and derivative at t, and a bound on −f″ at t alone, like that of
    /// [`BlobOnRay::most`].
    #[inline(always)]
    #[must_use]
    pub fn bent(&self, t: R) -> (R, R, R) {
        let ahead = self.center - t;
        if self.segment.is_some() {
            let (value, slope) = self.at(t);
            return (value, slope, R::splat(0.0));
        }
        let swift = self.pace * ahead;
        let (value, fall) = self.kernel.falling(self.least + swift * ahead);
        let steep = self.amplitude * fall;
        let bend = steep * (self.pace + self.pace) * self.share_bent(ahead);
        (self.amplitude * value, steep * (swift + swift), bend)
    }

    /// Factor on the bound on −g″ at this distance or more from the parameter where q is smallest:
    /// for a Gaussian `−g″ = g·2k(1 − 2k(t−c)²)`, which is negative beyond the inflection.
    #[inline(always)]
    fn share_bent(&self, away: R) -> R {
        let one = R::splat(1.0);
        if self.kernel == Kernel::Gauss {
            (one - R::splat(2.0) * self.pace * away * away).max(R::splat(0.0))
        } else {
            one
        }
    }

    /// Returns upper bounds between two parameters.
    #[inline(always)]
    #[must_use]
    pub fn most(&self, from: R, to: R) -> Limits<R> {
        let nearest = self.center.max(from).min(to);
        let away = nearest - self.center;
        let square = self.least + self.pace * away * away;
        let (value, fall) = match &self.segment {
            None => self.kernel.falling_at_most(square),
            // Segments overlap less than points do, so a cheap loose bound fails more often than it
            // saves.
            Some(_) => self.kernel.falling(square),
        };
        let twice = self.pace + self.pace;
        match &self.segment {
            None => Limits {
                most: self.amplitude * value,
                bend: self.amplitude * fall * twice * self.share_bent(away),
                kink: R::splat(0.0),
            },
            Some(segment) => {
                let beside = self.amplitude * value;
                let (share, [bell, tail]) = self.most_share(segment, from, to);
                let most = beside * share;
                let rate = self.rate.abs();
                let furthest = (from - self.center).abs().max((to - self.center).abs());
                // The smaller of two bounds: on each of the segment's points separately, with the
                // full rate of change of its distance; and by the product rule for the factor
                // e^(−q) and the fraction on the segment.
                let points = most * (twice + R::splat(2.0) * rate * rate);
                let two = R::splat(2.0);
                let ends = two * twice * furthest * bell + two * two * rate * tail;
                let ends = R::splat(FRAC_2_SQRT_PI) * beside * rate * ends;
                let bend = points.min(most * twice * self.share_bent(away) + ends);
                let Some(ramp) = &segment.ramp else {
                    let kink = R::splat(0.0);
                    return Limits { most, bend, kink };
                };
                let [a, b] = [from, to].map(|t| self.place + self.rate * t);
                let [factor, steep, kink] = ramp.most(a, b);
                // |g′| by the product rule, in the same two factors.
                let slope =
                    most * twice * furthest + beside * bell * rate * R::splat(FRAC_2_SQRT_PI);
                Limits {
                    most: most * factor,
                    bend: bend * factor + R::splat(2.0) * slope * steep * rate,
                    kink: most * kink * rate,
                }
            }
        }
    }

    /// Whether the blob is a Gaussian point.
    #[inline(always)]
    #[must_use]
    pub fn is_gaussian_point(&self) -> bool {
        self.kernel == Kernel::Gauss && self.segment.is_none()
    }

    /// Copy with kernel and kind fixed, for loops over Gaussian points alone: the compiler drops
    /// all other cases.
    #[inline(always)]
    #[must_use]
    pub fn gaussian_point(self) -> Self {
        debug_assert!(self.is_gaussian_point());
        Self {
            kernel: Kernel::Gauss,
            segment: None,
            ..self
        }
    }

    /// Whether the slope may jump (at a ramp's kinks).
    #[inline(always)]
    #[must_use]
    pub fn has_kinks(&self) -> bool {
        self.segment
            .as_ref()
            .is_some_and(|segment| segment.ramp.is_some())
    }

    /// Whether the field rises up to `to` in all lanes: then [`BlobOnRay::bent`] at `to` bounds it
    /// on any interval that ends there, as tightly as [`BlobOnRay::most`].
    #[inline(always)]
    #[must_use]
    pub fn rises_until(&self, to: R) -> bool {
        self.segment.is_none() && !R::any(self.center.lt(to))
    }

    /// Returns the parameters between which q is at most `square`; where it never is, the first is
    /// greater than the second.
    #[inline(always)]
    #[must_use]
    pub fn within(&self, square: R) -> [R; 2] {
        let zero = R::splat(0.0);
        let room = square - self.least;
        let half = room.max(zero).sqrt() * self.width;
        let miss = room.lt(zero);
        let half = R::select(miss, R::splat(f64::NEG_INFINITY), half);
        let [mut near, mut far] = [self.center - half, self.center + half];
        if let Some(segment) = &self.segment {
            // The rest has |x| > half + √square, unless the ray is perpendicular to the segment.
            let rate = self.rate.abs().max(R::splat(1e-12));
            let middle = -(self.rate.sign_to(self.place)) / rate;
            let reach = (R::lift(segment.half) + square.max(zero).sqrt()) / rate;
            near = near.max(middle - reach);
            far = far.min(middle + reach);
        }
        [near, far]
    }

    /// Returns `erf(x+half) − erf(x−half)` and its derivative by t.
    #[inline(always)]
    fn share(&self, segment: &SegmentOnRay<R::Scalar>, t: R) -> (R, R) {
        let half = R::lift(segment.half);
        let x = self.place + self.rate * t;
        let side = x.abs();
        let near = side - half;
        if !R::any(R::splat(-LONG).lt(near)) {
            // All lanes are far from the ends.
            return (R::splat(2.0), R::splat(0.0));
        }
        let bell = (near * near).decay();
        let mut share = reach(near, bell);
        let mut change = -bell;
        if !segment.long {
            let far = side + half;
            let bell = (far * far).decay();
            share = share - far.erfc(bell);
            change = change + bell;
        }
        let change = x.sign_to(change) * self.rate * R::splat(FRAC_2_SQRT_PI);
        (share, change)
    }

    /// Returns bounds between two parameters on the fraction of [`Self::share`], and on `e^(−y²)`
    /// and `|y|e^(−y²)`, with y the distance along the segment from either end.
    #[inline(always)]
    fn most_share(&self, segment: &SegmentOnRay<R::Scalar>, from: R, to: R) -> (R, [R; 2]) {
        let half = R::lift(segment.half);
        let (a, b) = (self.place + self.rate * from, self.place + self.rate * to);
        // The position nearest to the middle, and that furthest from it.
        let last = a.abs().max(b.abs()) - half;
        if !R::any(R::splat(-INNER_DISTANCE).lt(last)) {
            return (
                R::splat(2.0),
                [R::splat(INNER_BELL), R::splat(INNER_DISTANCE * INNER_BELL)],
            );
        }
        let zero = R::splat(0.0);
        let x = zero.max(a.min(b)).min(a.max(b));
        let near = x.abs() - half;
        let bell = (near * near).decay();
        // Distance of the interval from the nearer end; from the other end it is larger.
        let apart = near.max(-last).max(zero);
        let at_end = (apart * apart).decay();
        // y·e^(−y²) is largest at √½, and falls from there.
        let steepest = apart.max(R::splat(FRAC_1_SQRT_2));
        (reach(near, bell), [at_end, steepest * at_end])
    }
}

/// `erfc a`, for either sign of a, given `bell` = e^(−a²).
#[inline(always)]
fn reach<R: Real>(a: R, bell: R) -> R {
    let beyond = a.abs().erfc(bell);
    R::select(a.lt(R::splat(0.0)), R::splat(2.0) - beyond, beyond)
}
