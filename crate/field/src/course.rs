//! A lump's field along rays, with its largest value on any piece of them.
//!
//! A *lump* is a primitive whose course along a ray is so simple that bounds on it need no search: a
//! point, of a compact or the Gaussian kernel, or a Gaussian segment; above zero, of one width, and without a profile but for
//! one that rises evenly along the segment ([`Ramp`]). For these
//! `q(t) = q₀ + k(t−c)²`, the square of the distance from the point, or from the segment's line, in
//! units of the kernel's width, is a parabola. Beside it the share W of a segment that is abreast depends on the
//! position x along it, which is linear in t.
//!
//! On an interval of t the field is at most its value with the least q and the most central x of the
//! interval. Its second derivative is at least `−2k·amplitude·|G′(q)|`, with the least q: for
//! `g″ = amplitude·(2k·G′ + 4k²(t−c)²·G″)`, and all kernels G of q fall and are convex, so G″ ≥ 0 and |G′| falls.
//! A segment is a sum of such points, and a Gaussian has |G′| = G. With a ramp r the field is `g·r`, so that −(gr)″ is at
//! most `−g″·r + 2|g′||r′|` between the ramp's kinks; in a kink the slope falls by no more than `g·|r′|`.
use crate::bone::{Bone, Segment};
use crate::ramp::Ramp;
use crate::real::Scalar;
use crate::term::Frame;
use crate::{Jet, Kernel, Primitive, Real, THRESHOLD, gauss, point};
use core::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};
use glam::DVec3;

/// Half the length, in kernel widths, from which on a segment is a lump: from there the two error functions
/// keep enough digits in their difference.
const SHORT: f64 = 0.5;
/// Amplitudes and width parameters of lumps are at most this.
const LARGEST: f64 = 1e9;
/// Newton's steps to a compact lump's surface.
const NEWTON: usize = 5;
/// From this half length on the further end of a Gaussian segment is not felt: erfc 4 = 1.5·10⁻⁸.
const LONG: f64 = 4.0;

/// Rays that far from the ends of a segment, beside it, feel little of them …
const INNER: f64 = 3.0;
/// … as e^(−9) is less than this.
const INNER_BELL: f64 = 1.3e-4;

/// A lump along rays `origin + t·direction` of unit direction, one a lane.
#[derive(Clone, Copy, Debug)]
pub struct Course<R: Real> {
    kernel: Kernel,
    amplitude: R,
    /// q is least here …
    center: R,
    /// … and is this …
    least: R,
    /// … and grows by this times the square of the distance from there.
    pace: R,
    /// `1/√pace`, or where that would be more than 10⁶ so much.
    width: R,
    /// Of a segment: where along it the ray is, `x = place + rate·t`.
    place: R,
    rate: R,
    segment: Option<Abreast<R::Scalar>>,
}

/// What bounds a lump's field on a piece of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Limits<R> {
    /// It is nowhere more than this.
    pub most: R,
    /// Minus its second derivative is nowhere more than this, but in kinks.
    pub bend: R,
    /// In kinks its slope falls by no more than this, together.
    pub kink: R,
}

/// What is along a segment: it is |x| ≤ half.
#[derive(Clone, Copy, Debug)]
struct Abreast<S> {
    half: S,
    long: bool,
    ramp: Option<Ramp<S>>,
}

/// A lump: a primitive whose course along rays is simple.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lump<S> {
    kernel: Kernel,
    /// The kernel's width parameter.
    scale: S,
    amplitude: S,
    segment: Option<Rod<S>>,
}

/// The frame of a segment, and half its length in kernel widths.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rod<S> {
    half: S,
    axes: [[S; 3]; 3],
    ramp: Option<Ramp<S>>,
}

/// A bound on lumps' fields by the distance from their bones, one a lane: `peak·G(q)`, where
/// `√q = scale·distance`; of compact kernels, which are convex in q, the chord 1−q.
#[derive(Clone, Copy, Debug)]
pub struct Ceiling<R> {
    /// The field is nowhere more than this.
    pub peak: R,
    /// The kernel's width parameter.
    pub scale: R,
    /// 1 for compact kernels, 0 for the Gaussian.
    pub compact: R,
}

impl<R: Real> Ceiling<R> {
    /// At this distance ≥ 0 from the bone, and beyond it, fields are at most this.
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
    /// The primitive as a lump, if it is one. Its place is [`Primitive::lump_middle`].
    #[must_use]
    pub fn lump<S: Scalar>(&self) -> Option<Lump<S>> {
        let term = S::prepared(&self.prepared);
        let ends = self.kernel == Kernel::Gauss || self.kernel.is_compact();
        let plain = ends && self.tapered.is_none();
        let amplitude = self.prepared.double.amplitude;
        // Larger ones leave single precision no room for derivatives.
        if !(plain && amplitude > 0.0 && amplitude <= LARGEST && self.width <= LARGEST) {
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
                if ramp.is_some_and(|ramp| amplitude * ramp.largest() > LARGEST) {
                    return None;
                }
                let ramp = ramp.map(|ramp| ramp.cast(S::round));
                Some(Rod {
                    half: *half,
                    axes: term.frame.axes,
                    ramp,
                })
            }
            _ => return None,
        };
        Some(Lump {
            kernel: self.kernel,
            scale: S::round(self.width),
            amplitude: term.amplitude,
            segment,
        })
    }

    /// The point's place, or the segment's middle.
    #[must_use]
    pub fn lump_middle(&self) -> DVec3 {
        DVec3::from_array(self.prepared.double.frame.origin)
    }
}

impl Lump<f32> {
    /// A Gaussian point of such a width parameter, and such a field at its centre, if that leaves room for derivatives.
    pub(crate) fn point(scale: f64, amplitude: f64) -> Option<Self> {
        (amplitude > 0.0 && amplitude <= LARGEST && scale <= LARGEST).then_some(Self {
            kernel: Kernel::Gauss,
            scale: scale as f32,
            amplitude: amplitude as f32,
            segment: None,
        })
    }
}

impl<S: Scalar> Lump<S> {
    /// The square q of a distance from the bone, in units of the kernel's width, beyond which the field is at most
    /// `level`.
    #[must_use]
    pub fn reach(&self, level: f64) -> f64 {
        if self.kernel != Kernel::Gauss {
            return 1.0;
        }
        libm::log((self.peak() / level).max(1.0))
    }

    /// The field is nowhere more than this.
    fn peak(&self) -> f64 {
        let amplitude = self.amplitude.lane(0);
        match &self.segment {
            // The integral over an endless line.
            Some(rod) => {
                let factor = rod
                    .ramp
                    .map_or(1.0, |ramp| ramp.cast(|x| x.lane(0)).largest());
                amplitude * factor * core::f64::consts::PI.sqrt()
            }
            None => amplitude,
        }
    }

    /// What bounds the field by the distance from the bone. Beyond the ends of a segment of half length H, at
    /// x along it, this holds because `erf(x+H) − erf(x−H) ≤ erfc(x−H) ≤ exp(−(x−H)²)`.
    #[must_use]
    pub fn ceiling(&self) -> Ceiling<f64> {
        Ceiling {
            peak: self.peak(),
            scale: self.scale.lane(0),
            compact: f64::from(u8::from(self.kernel != Kernel::Gauss)),
        }
    }

    /// From the middle to the end of the segment; of a point 0.
    #[must_use]
    pub fn half(&self) -> DVec3 {
        self.segment.map_or(DVec3::ZERO, |rod| {
            let scale = self.scale.lane(0);
            let along = DVec3::from_array(rod.axes[0].map(|x| x.lane(0)));
            along * (rod.half.lane(0) / (scale * scale))
        })
    }

    /// The radius of a ball around the middle that holds all places within this square of the distance.
    #[must_use]
    pub fn radius(&self, square: f64) -> f64 {
        let half = self.segment.map_or(0.0, |rod| rod.half.lane(0));
        (half + square.sqrt()) / self.scale.lane(0)
    }

    /// The square of the distance at which the lump alone would have its surface, given its [`Lump::reach`] for
    /// `level`; negative if it has none. A point's field is at least T from there inwards; near the ends of
    /// a segment, and of a short one everywhere, it is less.
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
            let [value, slope, ..] = self.kernel.derivatives(q).0;
            (q + (wanted - value) / slope).min(1.0)
        })
    }

    /// About the largest slope that the field has where it is no more than T: across the bone, at this square of the distance,
    /// where the lump alone would have its surface ([`Lump::core`]), or further out. A compact kernel's `|G′|√q` is no more
    /// than `|G′|`, which falls; a Gaussian's falls from q = ½ on.
    #[must_use]
    pub fn steepness(&self, core: f64) -> f64 {
        let scale = self.scale.lane(0);
        let twice = 2.0 * scale;
        if self.kernel == Kernel::Gauss {
            let ramp = self.segment.and_then(|rod| rod.ramp);
            let ramp = ramp.map_or(0.0, |ramp| scale * ramp.cast(|x| x.lane(0)).steepness());
            return (twice * core.max(0.5).sqrt() + ramp) * THRESHOLD;
        }
        twice * self.amplitude.lane(0) * self.kernel.derivatives(core.max(0.0)).0[1].abs()
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
        let Some(rod) = &self.segment else {
            let scale = R::lift(self.scale);
            let jet = point::jet(self.kernel, position.map(|x| x * scale));
            let steep = amplitude * scale;
            return Jet {
                value: amplitude * jet.value,
                gradient: jet.gradient.map(|g| steep * g),
            };
        };
        let frame = Frame {
            origin: [S::splat(0.0); 3],
            axes: rod.axes,
        };
        let segment = Segment { half: rod.half };
        let place = frame.local(position);
        let mut jet = gauss::segment::jet(&segment, place).times(amplitude);
        if let Some(ramp) = &rod.ramp {
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

    /// The field along rays, given the middle relative to their origins.
    #[inline(always)]
    #[must_use]
    pub fn course<R: Real<Scalar = S>>(&self, middle: [R; 3], direction: [R; 3]) -> Course<R> {
        let amplitude = R::lift(self.amplitude);
        let [ox, oy, oz] = middle;
        let [dx, dy, dz] = direction;
        if let Some(rod) = &self.segment {
            // In the segment's frame; t = 0 at the ray's origin.
            let axis = |i: usize| {
                let [ax, ay, az]: [S; 3] = rod.axes[i];
                let [ax, ay, az] = [ax, ay, az].map(R::lift);
                (-(ax * ox + ay * oy + az * oz), ax * dx + ay * dy + az * dz)
            };
            let [(x, rate), (y, vy), (z, vz)] = [axis(0), axis(1), axis(2)];
            let pace = vy * vy + vz * vz;
            // A ray along the segment is everywhere as far from it; what rounding says of where it is nearest
            // means nothing.
            let still = R::splat(1e-12) * (pace + rate * rate);
            let zero = R::splat(0.0);
            let center = R::select(pace.lt(still), zero, -(y * vy + z * vz) / pace);
            let (y, z) = (y + vy * center, z + vz * center);
            return Course {
                kernel: self.kernel,
                amplitude: amplitude * R::splat(1.0 / FRAC_2_SQRT_PI),
                center,
                least: y * y + z * z,
                pace,
                width: R::splat(1.0) / pace.max(R::splat(1e-12)).sqrt(),
                place: x,
                rate,
                segment: Some(Abreast {
                    half: rod.half,
                    long: rod.half.lane(0) >= LONG,
                    ramp: rod.ramp,
                }),
            };
        }
        let scale = R::lift(self.scale);
        let pace = scale * scale;
        // The cross product keeps the digits that a difference of squares would lose.
        let (x, y, z) = (oy * dz - oz * dy, oz * dx - ox * dz, ox * dy - oy * dx);
        Course {
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

impl<R: Real> Course<R> {
    /// Value and derivative by t.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, t: R) -> (R, R) {
        let ahead = self.center - t;
        let swift = self.pace * ahead;
        let (value, fall) = self.kernel.falling(self.least + swift * ahead);
        let Some(abreast) = &self.segment else {
            let steep = self.amplitude * fall;
            return (self.amplitude * value, steep * (swift + swift));
        };
        let beside = self.amplitude * value;
        let (share, change) = self.share(abreast, t);
        let (value, slope) = (beside * share, beside * (change + (swift + swift) * share));
        match &abreast.ramp {
            None => (value, slope),
            Some(ramp) => {
                let (factor, rise) = ramp.at(self.place + self.rate * t);
                (value * factor, slope * factor + value * rise * self.rate)
            }
        }
    }

    /// The same with a bound on the second derivative at t alone, as that of [`Course::most`].
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

    /// At no less than so far from where q is least −g″ is no more than this part of what it may be there: a
    /// Gaussian's is `g·2k(1 − 2k(t−c)²)`, which is below 0 from the inflection on.
    #[inline(always)]
    fn share_bent(&self, away: R) -> R {
        let one = R::splat(1.0);
        if self.kernel == Kernel::Gauss {
            (one - R::splat(2.0) * self.pace * away * away).max(R::splat(0.0))
        } else {
            one
        }
    }

    /// Upper bounds between two parameters.
    #[inline(always)]
    #[must_use]
    pub fn most(&self, from: R, to: R) -> Limits<R> {
        let nearest = self.center.max(from).min(to);
        let away = nearest - self.center;
        let square = self.least + self.pace * away * away;
        let (value, fall) = match &self.segment {
            None => self.kernel.falling_at_most(square),
            // Few are near each other, so that a loose bound fails more often than it saves.
            Some(_) => self.kernel.falling(square),
        };
        let twice = self.pace + self.pace;
        match &self.segment {
            None => Limits {
                most: self.amplitude * value,
                bend: self.amplitude * fall * twice * self.share_bent(away),
                kink: R::splat(0.0),
            },
            Some(abreast) => {
                let beside = self.amplitude * value;
                let (share, [bell, tail]) = self.most_share(abreast, from, to);
                let most = beside * share;
                let rate = self.rate.abs();
                let furthest = (from - self.center).abs().max((to - self.center).abs());
                // Each of the segment's points bends so much, as their distances change at most at the full rate; or, of
                // what is beside the segment and what abreast, both bend, and their slopes' product counts twice.
                let points = most * (twice + R::splat(2.0) * rate * rate);
                let two = R::splat(2.0);
                let ends = two * twice * furthest * bell + two * two * rate * tail;
                let ends = R::splat(FRAC_2_SQRT_PI) * beside * rate * ends;
                let bend = points.min(most * twice * self.share_bent(away) + ends);
                let Some(ramp) = &abreast.ramp else {
                    let kink = R::splat(0.0);
                    return Limits { most, bend, kink };
                };
                let [a, b] = [from, to].map(|t| self.place + self.rate * t);
                let [factor, steep, kink] = ramp.most(a, b);
                // |g′|, by what is beside the segment and what abreast.
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

    /// Whether this is the course of a Gaussian point.
    #[inline(always)]
    #[must_use]
    pub fn is_gaussian_point(&self) -> bool {
        self.kernel == Kernel::Gauss && self.segment.is_none()
    }

    /// The course of a Gaussian point as what it is, for loops over nothing else: they are compiled without all other cases.
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

    /// Whether its slope may jump.
    #[inline(always)]
    #[must_use]
    pub fn has_kinks(&self) -> bool {
        self.segment
            .as_ref()
            .is_some_and(|abreast| abreast.ramp.is_some())
    }

    /// Whether the largest value between two parameters is that at the further one, in all lanes: then
    /// [`Course::bent`] there bounds what is between them, and no worse than [`Course::most`] would.
    #[inline(always)]
    #[must_use]
    pub fn rises_until(&self, to: R) -> bool {
        self.segment.is_none() && !R::any(self.center.lt(to))
    }

    /// The parameters between which q is at most `square`. Where it never is, the first is greater than
    /// the second.
    #[inline(always)]
    #[must_use]
    pub fn within(&self, square: R) -> [R; 2] {
        let zero = R::splat(0.0);
        let room = square - self.least;
        let half = room.max(zero).sqrt() * self.width;
        let miss = room.lt(zero);
        let half = R::select(miss, R::splat(f64::NEG_INFINITY), half);
        let [mut near, mut far] = [self.center - half, self.center + half];
        if let Some(abreast) = &self.segment {
            // Where |x| ≤ half + √square, unless the ray runs across.
            let rate = self.rate.abs().max(R::splat(1e-12));
            let middle = -(self.rate.sign_to(self.place)) / rate;
            let reach = (R::lift(abreast.half) + square.max(zero).sqrt()) / rate;
            near = near.max(middle - reach);
            far = far.min(middle + reach);
        }
        [near, far]
    }

    /// `erf(x+half) − erf(x−half)` and its derivative by t.
    #[inline(always)]
    fn share(&self, abreast: &Abreast<R::Scalar>, t: R) -> (R, R) {
        let half = R::lift(abreast.half);
        let x = self.place + self.rate * t;
        let side = x.abs();
        let near = side - half;
        if !R::any(R::splat(-LONG).lt(near)) {
            // No ray feels an end.
            return (R::splat(2.0), R::splat(0.0));
        }
        let bell = (near * near).decay();
        let mut share = reach(near, bell);
        let mut change = -bell;
        if !abreast.long {
            let far = side + half;
            let bell = (far * far).decay();
            share = share - far.erfc(bell);
            change = change + bell;
        }
        let change = x.sign_to(change) * self.rate * R::splat(FRAC_2_SQRT_PI);
        (share, change)
    }

    /// Between two parameters: bounds on the share, and on `e^(−y²)` and `|y|e^(−y²)`, where y is how far along the segment
    /// it is from either of its ends.
    #[inline(always)]
    fn most_share(&self, abreast: &Abreast<R::Scalar>, from: R, to: R) -> (R, [R; 2]) {
        let half = R::lift(abreast.half);
        let (a, b) = (self.place + self.rate * from, self.place + self.rate * to);
        // The position nearest to the middle, and that furthest from it.
        let last = a.abs().max(b.abs()) - half;
        if !R::any(R::splat(-INNER).lt(last)) {
            return (
                R::splat(2.0),
                [R::splat(INNER_BELL), R::splat(INNER * INNER_BELL)],
            );
        }
        let zero = R::splat(0.0);
        let x = zero.max(a.min(b)).min(a.max(b));
        let near = x.abs() - half;
        let bell = (near * near).decay();
        // What is nearest to an end of the segment; from the other end it is further.
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
