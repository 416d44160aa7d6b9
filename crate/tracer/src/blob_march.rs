//! Certified ray marching: finds the first crossing of eight rays with a surface of blobs.
//!
//! For a blob the largest value on any interval of a ray and the largest −f″ there have closed
//! forms (`field::blob`). So a ray outside the surface may step from `from` to `to`
//!
//! - if the largest values on that interval add up to less than T, or
//! - if the field is below T at both ends, and the chord between them plus the parabola
//!   `(N/2 + K/h)·x(h−x)` stays below T, where h is the length, N ≥ −F″ on the interval, and K
//!   bounds the drop of the slope in kinks. With `P = h²/2·N + h·K` and D the difference of the
//!   values at the ends, the sum is largest at an end if P ≤ D; else it exceeds that by (P−D)²/4P.
//!
//! If F(to) ≥ T there is a crossing on the interval, and when `N·h² + 2K·h < 2(T − F(from))` it is
//! the only one: an earlier one would need a larger −F″. Newton's method then refines it. Otherwise
//! the step is shortened, but to no less than the tolerance. The eight rays are computed together,
//! each with its own intervals.
use crate::lanes::least;
use field::far_field::DEGREE;
use field::{BlobOnRay, Limits, Real};
use wide::f32x8;

/// A blob that a packet's rays may meet.
#[derive(Clone, Copy, Debug)]
pub struct RayBlob {
    /// Field along the rays.
    pub on_ray: BlobOnRay<f32x8>,
    /// Squared distance, in kernel widths, up to which the blob is strong: a step that fails is cut
    /// there ([`Sum::cut`]).
    pub strong: f32,
    /// Index in the list of nearby blobs.
    pub index: u32,
}

impl RayBlob {
    /// Field along the rays, specialised if all are Gaussian points ([`RayBlobs::plain`]).
    #[inline(always)]
    fn on_ray<const PLAIN: bool>(&self) -> BlobOnRay<f32x8> {
        if PLAIN {
            self.on_ray.gaussian_point()
        } else {
            self.on_ray
        }
    }
}

/// Range of ray parameters in which any of a packet's rays may meet a blob.
#[derive(Clone, Copy, Debug)]
pub struct RayInterval {
    /// Smallest parameter.
    pub from: f32,
    /// Largest parameter.
    pub to: f32,
    /// Index of the blob in [`RayBlobs::blobs`].
    pub blob: u32,
}

/// The blobs that a packet's rays may meet. Only the small intervals are sorted, not the large
/// blobs.
#[derive(Clone, Copy, Debug)]
pub struct RayBlobs<'a> {
    /// The blobs, in any order.
    pub blobs: &'a [RayBlob],
    /// The blobs' intervals, in order of `from`.
    pub intervals: &'a [RayInterval],
    /// Whether all are Gaussian points, the most common case, for which the march is compiled
    /// separately.
    pub plain: bool,
}

impl<'a> RayBlobs<'a> {
    /// Iterates over the blobs that a ray may meet between two parameters.
    #[inline(always)]
    pub fn between(self, first: f32, last: f32) -> impl Iterator<Item = &'a RayBlob> {
        self.intervals
            .iter()
            .take_while(move |interval| interval.from <= last)
            .filter(move |interval| interval.to >= first)
            .map(move |interval| &self.blobs[interval.blob as usize])
    }
}

/// The rays of a packet and the accuracy asked for.
#[derive(Clone, Copy, Debug)]
pub struct MarchRays {
    /// Start of each ray.
    pub from: f32x8,
    /// End of each ray.
    pub to: f32x8,
    /// Estimate of the crossing; infinite without one.
    pub guess: f32x8,
    /// End of the first step, at or before the estimate and so near to it that the rest can be
    /// proved to hold at most one crossing.
    pub first: f32x8,
    /// The rays to follow, a bit each.
    pub alive: u32,
    /// Length below which steps are not shortened.
    pub tolerance: f32,
    /// Error of the field where it is T.
    pub noise: f32,
    /// Value and slope at the start of each ray, if they are known.
    pub start: Option<[f32x8; 2]>,
}

/// A smooth part of the field beside the blobs: a polynomial along each ray.
#[derive(Clone, Copy, Debug)]
pub struct Backdrop {
    /// Coefficients of the polynomial in t over `half`, which is between −1 and 1 on the rays.
    pub coefficients: [f32x8; DEGREE + 1],
    /// Largest size of a parameter.
    pub half: f32,
}

impl Backdrop {
    /// Returns value and slope at t.
    #[inline(always)]
    pub fn at(&self, t: f32x8) -> (f32x8, f32x8) {
        let scale = f32x8::splat(1.0 / self.half);
        let x = t * scale;
        let zero = f32x8::splat(0.0);
        let (mut value, mut slope) = (zero, zero);
        for c in self.coefficients.iter().rev() {
            slope = slope * x + value;
            value = value * x + *c;
        }
        (value, slope * scale)
    }

    /// Returns upper bounds on the polynomial and on −f″.
    #[inline(always)]
    pub fn limits(&self) -> (f32x8, f32x8) {
        let [a, b, c, d, e, f] = self.coefficients;
        let zero = f32x8::splat(0.0);
        let most = a + b.abs() + c.fast_max(zero) + d.abs() + e.fast_max(zero) + f.abs();
        let turns = d.abs() * 6.0 + (-e).fast_max(zero) * 12.0 + f.abs() * 20.0;
        let bend = (turns - c * 2.0).fast_max(zero);
        let scale = 1.0 / self.half;
        // Rounded upwards.
        let most = most + most.abs() * 1e-6;
        (most, bend * (scale * scale * (1.0 + 1e-5)))
    }
}

/// A part of the field behind the blobs, or none; the march is compiled for each.
pub trait Behind: Copy {
    /// Whether there is anything behind the blobs.
    const ANYTHING: bool;
    /// Returns value and slope at t.
    fn at(&self, t: f32x8) -> (f32x8, f32x8);
    /// Returns upper bounds on the value and on −f″.
    fn limits(&self) -> (f32x8, f32x8);
}

/// Nothing behind the blobs.
impl Behind for () {
    const ANYTHING: bool = false;

    #[inline(always)]
    fn at(&self, _: f32x8) -> (f32x8, f32x8) {
        (f32x8::ZERO, f32x8::ZERO)
    }

    #[inline(always)]
    fn limits(&self) -> (f32x8, f32x8) {
        (f32x8::ZERO, f32x8::ZERO)
    }
}

/// A backdrop with its limits.
#[derive(Clone, Copy, Debug)]
pub struct Bounded<'a> {
    backdrop: &'a Backdrop,
    limits: (f32x8, f32x8),
}

impl<'a> Bounded<'a> {
    /// Computes the limits of a backdrop.
    pub fn new(backdrop: &'a Backdrop) -> Self {
        Self {
            backdrop,
            limits: backdrop.limits(),
        }
    }
}

impl Behind for Bounded<'_> {
    const ANYTHING: bool = true;

    #[inline(always)]
    fn at(&self, t: f32x8) -> (f32x8, f32x8) {
        self.backdrop.at(t)
    }

    #[inline(always)]
    fn limits(&self) -> (f32x8, f32x8) {
        self.limits
    }
}

/// Result of a march.
#[derive(Clone, Copy, Debug)]
pub struct Marched {
    /// Parameter of the crossing, for rays in `met`.
    pub t: f32x8,
    /// Parameters that bracket the crossing.
    pub between: [f32x8; 2],
    /// Rays that cross, a bit each.
    pub met: u32,
    /// Rays that passed so near to the surface that rounding may have hidden a crossing, a bit
    /// each.
    pub doubtful: u32,
    /// Parameters between which the doubtful rays did so.
    pub doubt: [f32x8; 2],
    /// Evaluations of blobs, for one ray each.
    pub evaluations: u64,
}

/// T less the rounding of sums: a ray that only rounding keeps outside meets the surface.
pub const LEVEL: f32 = 1.0 - 1e-6;

/// Field from which a point counts as deep inside.
const DEEP: f32 = 1.5;

/// Field above which, where it rises, [`TANGENT`] limits steps.
const NEARLY: f32 = 0.15;
/// Longest step, over that along the tangent to T: Gaussians are convex where they rise, and reach
/// T before.
const TANGENT: f32 = 1.1;

/// Length down to which intervals that rounding leaves in doubt are shortened.
const DOUBTFUL: f32 = 1e-3;

/// Factor c in the length h of the step after a failed one, N·h² = c·(T − F), where −F″ ≤ N on the
/// failed step. The chord's proof needs at most 8.
const SERVES: f32 = 6.0;
/// Least length of the step after a failed one where the field falls at the start, over the length
/// −F′/N on which the bend can turn the slope.
const FALLS: f32 = 1.8;
/// Least ratio of the step after a failed one to that, since N is smaller on a shorter step.
const LEAST: f32 = 0.1;

/// Evaluations after which a packet is given up; packets of the published scenes need a few
/// thousand.
const MOST_EVALUATIONS: u64 = 1 << 24;
/// Rounds after which a packet is given up.
const MOST_ROUNDS: u32 = 400;

/// Sums over the blobs: value and slope at the end of a step, and bounds on the step.
struct Sum {
    value: f32x8,
    slope: f32x8,
    most: f32x8,
    bend: f32x8,
    kink: f32x8,
    /// Parameters between which blobs were added up.
    between: [f32; 2],
}

/// Marches rays to their first crossings. `None` if a ray starts inside or a limit on the work is
/// reached; the caller then takes the general way. `tops` is working space.
#[must_use]
pub fn march(blobs: RayBlobs<'_>, rays: &MarchRays, tops: &mut Vec<f32x8>) -> Option<Marched> {
    if tops.len() < blobs.intervals.len() {
        tops.resize(blobs.intervals.len(), f32x8::splat(0.0));
    }
    if blobs.plain {
        march_blobs::<true, ()>(blobs, (), rays, tops)
    } else {
        march_blobs::<false, ()>(blobs, (), rays, tops)
    }
}

/// [`march`] before a backdrop; the rays' parameters are within its range.
#[must_use]
pub fn march_before(
    blobs: RayBlobs<'_>,
    backdrop: &Backdrop,
    rays: &MarchRays,
    tops: &mut Vec<f32x8>,
) -> Option<Marched> {
    if tops.len() < blobs.intervals.len() {
        tops.resize(blobs.intervals.len(), f32x8::splat(0.0));
    }
    march_blobs::<false, _>(blobs, Bounded::new(backdrop), rays, tops)
}

/// [`march`] for one value of [`RayBlobs::plain`].
#[inline(never)]
fn march_blobs<const PLAIN: bool, B: Behind>(
    blobs: RayBlobs<'_>,
    behind: B,
    rays: &MarchRays,
    tops: &mut [f32x8],
) -> Option<Marched> {
    let zero = f32x8::splat(0.0);
    let level = f32x8::splat(LEVEL);
    let surely = f32x8::splat(LEVEL - rays.noise);
    let tolerance = f32x8::splat(rays.tolerance);
    let mut evaluations = 0;
    let far = f32x8::splat(f32::INFINITY);
    let (mut doubtful, mut doubt) = (0, [far, -far]);
    // Invariant: below T up to `low`, with these values there.
    let mut low = rays.from;
    let mut going = rays.alive & low.simd_lt(rays.to).to_bitmask();
    // Rays that start out of all blobs' reach start at field 0.
    let (mut low_value, mut low_slope) = (zero, zero);
    if let Some(start) = rays.start {
        [low_value, low_slope] = start;
    } else if low.simd_le(zero).to_bitmask() & going != 0 {
        (low_value, low_slope) =
            values::<PLAIN, B>(blobs, behind, low, rays.alive, &mut evaluations);
    }
    if level.simd_le(low_value).to_bitmask() & going != 0 {
        return None;
    }
    // And at least T at `high`, on the rays in `known`.
    let mut known = 0;
    let mut high = f32x8::splat(f32::INFINITY);
    let (mut high_value, mut high_slope, mut high_bend, mut high_kink) = (zero, zero, zero, zero);
    let mut step = f32x8::splat(f32::INFINITY);
    let mut next = rays.first.fast_min(rays.to).fast_max(low);
    let mut met = 0;
    for _ in 0..MOST_ROUNDS {
        if evaluations > MOST_EVALUATIONS {
            return None;
        }
        if going == 0 {
            let mut marched = Marched {
                t: high,
                between: [low, high],
                met,
                doubtful,
                doubt,
                evaluations,
            };
            if met != 0 {
                polish::<PLAIN, B>(
                    blobs,
                    behind,
                    &mut marched,
                    low_value,
                    [high_value, high_slope, high_bend],
                );
            }
            return Some(marched);
        }
        let at = next;
        let sum = Sum::add_up::<PLAIN, B>(blobs, behind, low, at, going, tops, &mut evaluations);
        let length = at - low;
        let short = length.simd_le(tolerance).to_bitmask();
        let above = level.simd_le(sum.value).to_bitmask() & going;
        let chord = sum.chord(low_value, length);
        let below = going & !above;
        // The chord's bound may be NaN: then neither comparison holds.
        let under = |level| sum.most.simd_lt(level) | chord.simd_lt(level);
        let proved = below & under(surely).to_bitmask();
        let mut passed = proved;
        if below & !proved != 0 {
            let brief = length.simd_le(f32x8::splat(DOUBTFUL)) & under(level);
            let doubted = below & !proved & (short | brief.to_bitmask());
            if doubted != 0 {
                let mask = mask(doubted);
                passed |= doubted;
                doubtful |= doubted;
                doubt[0] = mask.select(doubt[0].fast_min(low), doubt[0]);
                doubt[1] = mask.select(at, doubt[1]);
            }
        }
        let moved = zero.simd_lt(length).to_bitmask();
        let failed = below & !passed;
        // Lanes whose step is proved.
        let mask = mask(passed);
        low = mask.select(at, low);
        low_value = mask.select(sum.value, low_value);
        low_slope = mask.select(sum.slope, low_slope);
        let longer = sum.lengthen(step, length, tolerance);
        step = self::mask(passed & moved).select(longer, step);
        let arrived = passed & rays.to.simd_le(low).to_bitmask();
        going &= !arrived;
        // Lanes that need a shorter step.
        if failed != 0 {
            let shorter = sum.shorten(low_value, low_slope, length);
            let end = sum.cut(blobs, tops, failed, [low, at], low + shorter, tolerance);
            step = self::mask(failed).select(end - low, step);
        }
        let goal = low.simd_lt(rays.guess).select(rays.guess, rays.to);
        let goal = goal.fast_min(rays.to);
        next = goal.fast_min(low + step);
        known |= above;
        if known == 0 {
            continue;
        }
        // Lanes with a bracketed crossing.
        let mask = self::mask(above);
        high = mask.select(at, high);
        high_value = mask.select(sum.value, high_value);
        high_slope = mask.select(sum.slope, high_slope);
        high_bend = mask.select(sum.bend, high_bend);
        high_kink = mask.select(sum.kink, high_kink);
        let width = high - low;
        let bulge = width * (high_bend * width + f32x8::splat(2.0) * high_kink);
        let only =
            bulge.simd_lt(f32x8::splat(2.0) * (level - low_value)) | width.simd_le(tolerance);
        let isolated = only.to_bitmask() & level.simd_le(high_value).to_bitmask() & going;
        met |= isolated;
        going &= !isolated;
        let back = before_crossing(low, high, [high_value, high_slope, high_bend], going);
        let middle = f32x8::splat(0.5) * (low + high);
        let fits = low.simd_lt(back) & back.simd_lt(high);
        let back = fits.select(back, middle).fast_min(low + step);
        next = self::mask(known).select(back, next);
    }
    None
}

/// Converts bits, one a lane, to a mask.
#[inline(always)]
pub fn mask(bits: u32) -> f32x8 {
    let bit = wide::i32x8::new([1, 2, 4, 8, 16, 32, 64, 128]);
    let set = wide::i32x8::splat(bits as i32) & bit;
    wide::bytemuck::cast(set.simd_eq(bit))
}

/// Returns the least of `a` and the largest of `b` over the lanes given by bits.
#[inline(always)]
pub fn extremes(a: f32x8, b: f32x8, bits: u32) -> (f32, f32) {
    let mask = mask(bits);
    let low = mask.select(a, f32x8::splat(f32::INFINITY));
    let high = mask.select(b, f32x8::splat(f32::NEG_INFINITY));
    (least(low), -least(-high))
}

/// Returns the field at t and its slope.
#[inline(always)]
pub fn values<const PLAIN: bool, B: Behind>(
    blobs: RayBlobs<'_>,
    behind: B,
    t: f32x8,
    bits: u32,
    evaluations: &mut u64,
) -> (f32x8, f32x8) {
    let (first, last) = extremes(t, t, bits);
    let (mut value, mut slope) = (f32x8::splat(0.0), f32x8::splat(0.0));
    for blob in blobs.between(first, last) {
        *evaluations += 8;
        let (v, s) = blob.on_ray::<PLAIN>().at(t);
        value += v;
        slope += s;
    }
    if B::ANYTHING {
        let (v, s) = behind.at(t);
        value += v;
        slope += s;
    }
    (value, slope)
}

/// Returns a parameter before the crossing below `high`, so near to it that the rest can be proved
/// to hold no other; from deep inside by a Newton step for the field's logarithm, which for
/// Gaussians leads just outside. Value, slope and bend are those at `high`.
#[inline(always)]
fn before_crossing(low: f32x8, high: f32x8, [value, slope, bend]: [f32x8; 3], going: u32) -> f32x8 {
    let near = high - (f32x8::splat(1.4) / bend).sqrt();
    let deep = f32x8::splat(DEEP).simd_lt(value);
    if deep.to_bitmask() & going == 0 {
        return near;
    }
    let out = high - Real::ln(value) * value / slope;
    let out = f32x8::splat(0.0).simd_lt(slope).select(out, low);
    deep.select(out, near)
}

impl Sum {
    /// Adds up the blobs between two parameters. Each blob's contribution to
    /// `most` is written to `tops`.
    #[inline(always)]
    fn add_up<const PLAIN: bool, B: Behind>(
        blobs: RayBlobs<'_>,
        behind: B,
        from: f32x8,
        to: f32x8,
        bits: u32,
        tops: &mut [f32x8],
        evaluations: &mut u64,
    ) -> Self {
        let (first, last) = extremes(from, to, bits);
        let zero = f32x8::splat(0.0);
        let mut sum = Self {
            value: zero,
            slope: zero,
            most: zero,
            bend: zero,
            kink: zero,
            between: [first, last],
        };
        for (blob, top) in blobs.between(first, last).zip(tops) {
            let on_ray = blob.on_ray::<PLAIN>();
            let (value, slope, here) = on_ray.bent(to);
            let Limits { most, bend, kink } = if on_ray.rises_until(to) {
                Limits {
                    most: value,
                    bend: here,
                    kink: zero,
                }
            } else {
                *evaluations += 8;
                on_ray.most(from, to)
            };
            *evaluations += 8;
            sum.value += value;
            sum.slope += slope;
            sum.most += most;
            sum.bend += bend;
            if on_ray.has_kinks() {
                sum.kink += kink;
            }
            *top = most;
        }
        if B::ANYTHING {
            let (value, slope) = behind.at(to);
            let (most, bend) = behind.limits();
            sum.value += value;
            sum.slope += slope;
            sum.most += most;
            sum.bend += bend;
        }
        sum
    }

    /// Returns an upper bound on the field on a step of some length that starts with `low_value`:
    /// chord plus parabola (see the module). Infinite where it is unknown.
    #[inline(always)]
    fn chord(&self, low_value: f32x8, length: f32x8) -> f32x8 {
        let (zero, far) = (f32x8::splat(0.0), f32x8::splat(f32::INFINITY));
        let tiny = f32x8::splat(f32::MIN_POSITIVE);
        let parabola = length * (f32x8::splat(0.5) * length * self.bend + self.kink);
        // The sum is largest inside only if the parabola is steeper than the chord.
        let steeper = (parabola - (self.value - low_value).abs()).fast_max(zero);
        let bulge = f32x8::splat(0.25) * steeper * steeper / parabola.fast_max(tiny);
        // A NaN proves nothing.
        parabola
            .simd_lt(far)
            .select(low_value.fast_max(self.value) + bulge, far)
    }

    /// Returns the length of the step after one of some length that was proved: twice that, or,
    /// where the field rises towards T, along the tangent to a little beyond the crossing.
    #[inline(always)]
    fn lengthen(&self, step: f32x8, length: f32x8, tolerance: f32x8) -> f32x8 {
        let doubled = f32x8::splat(2.0) * step.fast_min(length.fast_max(tolerance));
        let room = f32x8::splat(TANGENT) * (f32x8::splat(LEVEL) - self.value);
        let rises =
            f32x8::splat(NEARLY).simd_lt(self.value) & f32x8::splat(0.0).simd_lt(self.slope);
        let tangent = (room / self.slope).fast_max(tolerance);
        rises.select(doubled.fast_min(tangent), doubled)
    }

    /// Returns the length of the step after a failed one of some length, by the bend on it
    /// ([`SERVES`], [`FALLS`], [`LEAST`]).
    #[inline(always)]
    fn shorten(&self, low_value: f32x8, low_slope: f32x8, length: f32x8) -> f32x8 {
        let room = f32x8::splat(LEVEL) - low_value.fast_max(self.value);
        let served = (f32x8::splat(SERVES) * room.fast_max(f32x8::splat(0.0)) / self.bend).sqrt();
        let down = f32x8::splat(FALLS) * -low_slope / self.bend;
        served
            .fast_max(down)
            .fast_min(f32x8::splat(0.5) * length)
            .fast_max(f32x8::splat(LEAST) * length)
    }

    /// Returns the end of the step after a failed one: where the largest blob begins to be strong,
    /// or where it ceases to be, or else `end`.
    #[inline(never)]
    fn cut(
        &self,
        blobs: RayBlobs<'_>,
        tops: &[f32x8],
        lanes: u32,
        [from, to]: [f32x8; 2],
        end: f32x8,
        tolerance: f32x8,
    ) -> f32x8 {
        let [first, last] = self.between;
        let zero = f32x8::splat(0.0);
        let largest = tops_of(blobs, tops, first, last).fold(zero, |l, (_, top)| l.fast_max(*top));
        let (mut near, mut far) = (f32x8::splat(1.0), f32x8::splat(-1.0));
        let mut left = mask(lanes) & zero.simd_lt(largest);
        for (blob, top) in tops_of(blobs, tops, first, last) {
            let here = left & largest.simd_eq(*top);
            if here.any() {
                let [a, b] = blob.on_ray.within(f32x8::splat(blob.strong));
                near = here.select(a, near);
                far = here.select(b, far);
                left &= !here;
            }
        }
        let strong = near.simd_lt(far);
        let ends = strong & (from + tolerance).simd_lt(far) & far.simd_lt(to);
        let begins = strong & (from + tolerance).simd_lt(near) & near.simd_lt(to);
        begins.select(near, ends.select(far, end))
    }
}

/// Iterates over the blobs of a [`Sum`] with their contributions to `most`.
fn tops_of<'a>(
    blobs: RayBlobs<'a>,
    tops: &'a [f32x8],
    first: f32,
    last: f32,
) -> impl Iterator<Item = (&'a RayBlob, &'a f32x8)> {
    blobs.between(first, last).zip(tops)
}

/// Refines bracketed crossings by Newton steps, or by the secant and halving where those leave the
/// bracket. Value, slope and bend at the far end are given.
#[inline(never)]
fn polish<const PLAIN: bool, B: Behind>(
    blobs: RayBlobs<'_>,
    behind: B,
    marched: &mut Marched,
    mut low_value: f32x8,
    [mut high_value, slope, bend]: [f32x8; 3],
) {
    let level = f32x8::splat(1.0);
    let [mut low, mut high] = marched.between;
    let (mut at, mut value, mut slope) = (high, high_value, slope);
    for step in 0..MOST_STEPS {
        let newton = at - (value - level) / slope;
        let fits = low.simd_le(newton) & newton.simd_le(high);
        let share = (level - low_value) / (high_value - low_value);
        let share = share
            .fast_max(f32x8::splat(0.0))
            .fast_min(f32x8::splat(1.0));
        // The secant may converge slowly from one side; halving every fourth time does not.
        let between = if step % 4 == 3 {
            f32x8::splat(0.5)
        } else {
            share
        };
        let next = fits.select(newton, low + (high - low) * between);
        let length = next - at;
        at = next;
        // The error of this step, which the shading's evaluation corrects. −F″ is at most `bend`;
        // F″ may be larger, for Gaussians about the slope squared over the value.
        let up = slope * slope / value.fast_max(level);
        let left = (bend + up) * length * length;
        let near = fits & left.simd_lt(f32x8::splat(REFINED));
        if !near.to_bitmask() & marched.met == 0 {
            break;
        }
        (value, slope) =
            values::<PLAIN, B>(blobs, behind, at, marched.met, &mut marched.evaluations);
        let over = level.simd_le(value);
        high = over.select(at, high);
        high_value = over.select(value, high_value);
        low = over.select(low, at);
        low_value = over.select(low_value, value);
    }
    marched.t = at;
    marched.between = [low, high];
}

/// Largest number of refining steps.
const MOST_STEPS: u32 = 24;
/// Largest error of the field at a refined crossing, about.
const REFINED: f32 = 2e-2;

#[cfg(test)]
mod tests {
    use super::*;
    use field::{Kernel, Primitive, Shaping, Skeleton};
    use glam::DVec3;
    use trials::{Random, count};

    /// Returns points and segments around the origin.
    fn blobs(random: &mut Random, many: usize) -> Vec<Primitive> {
        let places: Vec<_> = (0..many)
            .map(|_| (random.vector(0.8), random.vector(0.8)))
            .collect();
        let kernels = [
            Kernel::Gauss,
            Kernel::Gauss,
            Kernel::Quartic,
            Kernel::Metaballs,
        ];
        places
            .into_iter()
            .enumerate()
            .filter_map(|(i, (a, b))| {
                let kernel = kernels[i % kernels.len()];
                let skeleton = if i % 4 == 1 {
                    Skeleton::Segment { base: a, apex: b }
                } else {
                    Skeleton::Point { center: a }
                };
                let shaping = Shaping {
                    kernel,
                    radius: 0.03 + 0.3 * random.unit() * random.unit(),
                    blobbiness: -random.range(-5.0, -1.0),
                    blob_scale: field::BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                Primitive::new(skeleton, &shaping, None)
            })
            .filter(|p| p.blob::<f32>().is_some())
            .collect()
    }

    /// Returns the rays of a packet, from 0 to beyond all blobs and without a guess.
    fn march_rays(noise: f32) -> MarchRays {
        MarchRays {
            from: f32x8::splat(0.0),
            to: f32x8::splat(3.9),
            guess: f32x8::splat(f32::INFINITY),
            first: f32x8::splat(f32::INFINITY),
            alive: 255,
            tolerance: 5e-5,
            noise,
            start: None,
        }
    }

    fn plain(blobs: &[RayBlob]) -> bool {
        blobs.iter().all(|blob| blob.on_ray.is_gaussian_point())
    }

    /// Returns intervals of the whole rays.
    fn intervals(blobs: &[RayBlob]) -> Vec<RayInterval> {
        (0..blobs.len() as u32)
            .map(|blob| RayInterval {
                from: 0.0,
                to: 10.0,
                blob,
            })
            .collect()
    }

    /// Returns the primitives as blobs on the rays.
    fn ray_blobs(primitives: &[Primitive], rays: &[(DVec3, DVec3); 8]) -> Vec<RayBlob> {
        let direction = [0, 1, 2].map(|k| f32x8::from_lanes(|i| rays[i].1[k]));
        primitives
            .iter()
            .enumerate()
            .map(|(index, p)| {
                let blob = p.blob::<f32>().expect("a blob");
                let middle = p.blob_middle();
                let middle = [0, 1, 2].map(|k| f32x8::from_lanes(|i| middle[k] - rays[i].0[k]));
                let on_ray = blob.on_ray(middle, direction);
                let square = blob.reach(1e-6);
                let strong = blob.core(square, 1e-6) + 2.0;
                RayBlob {
                    on_ray,
                    strong: strong as f32,
                    index: index as u32,
                }
            })
            .collect()
    }

    /// Returns the first crossing of a ray, by very many samples in double precision, and the least
    /// difference of T and the field before.
    fn scan(primitives: &[Primitive], origin: DVec3, direction: DVec3) -> (Option<f64>, f64) {
        let mut nearest = f64::INFINITY;
        for i in 0..20_000 {
            let t = f64::from(i) * 2e-4;
            let point = (origin + direction * t).to_array();
            let field: f64 = primitives.iter().map(|p| p.value(point)).sum();
            if field >= 1.0 {
                return (Some(t), nearest);
            }
            nearest = nearest.min(1.0 - field);
        }
        (None, nearest)
    }

    #[test]
    fn the_first_crossing_is_found_and_no_other() {
        // Kept, as it is between packets.
        let mut tops = Vec::new();
        let mut random = Random::new(11);
        let (mut hits, mut misses) = (0, 0);
        for case in 0..count(40) {
            let primitives = blobs(&mut random, 1 + case % 9);
            let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| {
                let origin = random.vector(0.5).with_z(-4.0) * 0.5;
                let aim = random.vector(0.5).with_z(0.0);
                (origin, (aim - origin).normalize())
            });
            let ray_blobs = ray_blobs(&primitives, &rays);
            let way = march_rays(0.0);
            let intervals = intervals(&ray_blobs);
            let blobs = RayBlobs {
                blobs: &ray_blobs,
                intervals: &intervals,
                plain: plain(&ray_blobs),
            };
            let Some(marched) = march(blobs, &way, &mut tops) else {
                // Only where a ray starts inside.
                let starts = rays.iter().any(|&(origin, direction)| {
                    scan(&primitives, origin, direction).0 == Some(0.0)
                });
                assert!(starts, "case {case} was given up");
                continue;
            };
            for (i, &(origin, direction)) in rays.iter().enumerate() {
                let (want, nearest) = scan(&primitives, origin, direction);
                let got = (marched.met >> i & 1 != 0).then(|| f64::from(marched.t.to_array()[i]));
                match (want, got) {
                    (None, None) => misses += 1,
                    (Some(want), Some(got)) if (want - got).abs() < 1e-3 => hits += 1,
                    // Crossings between the samples, or below single precision.
                    _ => assert!(
                        nearest < 1e-3,
                        "case {case}, ray {i}: {want:?} {got:?} {nearest}"
                    ),
                }
            }
        }
        assert!(hits > count(40) && misses > count(40), "{hits} {misses}");
    }

    /// A ray that passes is in doubt where the field comes nearer to T than its error, and nowhere
    /// else.
    #[test]
    fn rays_that_noise_may_have_kept_outside_are_in_doubt() {
        // Kept, as it is between packets.
        let mut tops = Vec::new();
        const NOISE: f64 = 0.05;
        let mut random = Random::new(23);
        let (mut doubted, mut sure) = (0, 0);
        for case in 0..count(160) {
            let primitives = blobs(&mut random, 1 + case % 5);
            // Past the first blob, close to its surface.
            let target = primitives[0].blob_middle();
            let radius = (0..200)
                .map(|i| f64::from(i) * 5e-3)
                .find(|x| primitives[0].value((target + DVec3::X * *x).to_array()) < 1.0);
            let radius = radius.unwrap_or(0.0);
            let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| {
                let origin = random.vector(0.5).with_z(-4.0) * 0.5;
                let aside = random.vector(0.5).with_z(0.0).normalize_or_zero();
                let aim = target + aside * (radius * (0.95 + 0.2 * random.unit()));
                (origin, (aim - origin).normalize())
            });
            let ray_blobs = ray_blobs(&primitives, &rays);
            let way = march_rays(NOISE as f32);
            let intervals = intervals(&ray_blobs);
            let blobs = RayBlobs {
                blobs: &ray_blobs,
                intervals: &intervals,
                plain: plain(&ray_blobs),
            };
            let Some(marched) = march(blobs, &way, &mut tops) else {
                continue;
            };
            for (i, &(origin, direction)) in rays.iter().enumerate() {
                if marched.met >> i & 1 != 0 {
                    continue;
                }
                let (mut most, mut close): (f64, Vec<f64>) = (0.0, Vec::new());
                for i in 0..3900 {
                    let t = f64::from(i) * 1e-3;
                    let point = (origin + direction * t).to_array();
                    let field: f64 = primitives.iter().map(|p| p.value(point)).sum();
                    most = most.max(field);
                    if field > 1.0 - 0.9 * NOISE {
                        close.push(t);
                    }
                }
                let [from, to] = marched.doubt.map(|t| f64::from(t.to_array()[i]));
                if marched.doubtful >> i & 1 != 0 {
                    doubted += 1;
                    assert!(most > 1.0 - 1.5 * NOISE, "case {case}, ray {i}: {most}");
                } else {
                    sure += 1;
                    assert!(close.is_empty(), "case {case}, ray {i}: {close:?}");
                }
                assert!(
                    close.iter().all(|t| (from..=to).contains(t)),
                    "case {case}, ray {i}: {from} {to} {close:?}"
                );
            }
        }
        assert!(doubted > count(30) && sure > count(100), "{doubted} {sure}");
    }

    /// The march compiled for Gaussian points gives the same bits.
    #[test]
    fn gaussian_points_alone_are_as_among_others() {
        // Kept, as it is between packets.
        let mut tops = Vec::new();
        let mut random = Random::new(31);
        let mut hits = 0;
        for case in 0..count(60) {
            let mut primitives = blobs(&mut random, 4 + case % 20);
            primitives.retain(|p| {
                matches!(p.skeleton, Skeleton::Point { .. }) && p.kernel == Kernel::Gauss
            });
            let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| {
                let origin = random.vector(0.5).with_z(-4.0) * 0.5;
                let aim = random.vector(0.5).with_z(0.0);
                (origin, (aim - origin).normalize())
            });
            let ray_blobs = ray_blobs(&primitives, &rays);
            let intervals = intervals(&ray_blobs);
            assert!(plain(&ray_blobs) && !ray_blobs.is_empty());
            let [alone, among] = [true, false].map(|plain| {
                let blobs = RayBlobs {
                    blobs: &ray_blobs,
                    intervals: &intervals,
                    plain,
                };
                let marched = march(blobs, &march_rays(1e-3), &mut tops)?;
                hits += marched.met.count_ones() as usize;
                let places = [marched.t, marched.between[0], marched.between[1]];
                let bits = places.map(|t| t.to_array().map(f32::to_bits));
                Some((bits, marched.met, marched.doubtful, marched.evaluations))
            });
            assert_eq!(alone, among, "case {case}");
        }
        assert!(hits > count(50), "{hits}");
    }

    #[test]
    fn a_ray_that_starts_inside_is_left_to_others() {
        let mut random = Random::new(5);
        let primitive = &blobs(&mut random, 1)[0];
        let blob = primitive.blob::<f32>().expect("a blob");
        let zero = f32x8::splat(0.0);
        let on_ray = blob.on_ray([zero; 3], [zero, zero, f32x8::splat(1.0)]);
        let ray_blobs = [RayBlob {
            on_ray,
            strong: -1.0,
            index: 0,
        }];
        let way = MarchRays {
            from: zero,
            to: f32x8::splat(1.0),
            guess: zero,
            first: zero,
            alive: 255,
            tolerance: 5e-5,
            noise: 0.0,
            start: None,
        };
        let intervals = intervals(&ray_blobs);
        let blobs = RayBlobs {
            blobs: &ray_blobs,
            intervals: &intervals,
            plain: plain(&ray_blobs),
        };
        assert!(march(blobs, &way, &mut Vec::new()).is_none());
    }
}
