//! Certified climbing: finds the first crossing of rays with a surface of lumps.
//!
//! Of a lump the largest value on any piece of a ray is known in closed form, and so is how far its field bends
//! down (`field::course`). So a ray outside the surface may go on from `from` to `to`
//!
//! - if the largest values on that piece add up to less than T, or
//! - if the field is below T at both ends, and on no place of the chord between them the parabola
//!   `(N/2 + K/h)·x(h−x)` reaches from there up to T, where h is the length, N ≥ −F″ on the piece, and in kinks the slope falls
//!   by no more than K. With `P = h²/2·N + h·K` and D the difference of the values at the ends, the sum is largest at an end if
//!   P ≤ D; else it is larger than there by (P−D)²/4P.
//!
//! If F(to) ≥ T there is a crossing on the piece, and when `N·h² + 2K·h < 2(T − F(from))` it is the only one: a
//! second one before it would need more bending. Then Newton's steps lead to it. All else makes
//! the piece shorter, as far as may serve, but no shorter than the tolerance. Eight rays go in step; each has its own pieces.
use crate::lanes::least;
use field::{Course, Limits, Real};
use wide::f32x8;

/// A lump on the way of a packet's rays.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Its field along the rays.
    pub course: Course<f32x8>,
    /// It is strong where the square of the distance, in kernel widths, is at most this.
    pub strong: f32,
    /// Its index in the list.
    pub index: u32,
}

impl Step {
    /// Its field along the rays; see [`Stairs::plain`].
    #[inline(always)]
    fn course<const PLAIN: bool>(&self) -> Course<f32x8> {
        if PLAIN {
            self.course.gaussian_point()
        } else {
            self.course
        }
    }
}

/// Where rays meet a lump.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// No ray meets it before this …
    pub from: f32,
    /// … nor after this.
    pub to: f32,
    /// Which of the steps it is.
    pub step: u32,
}

/// The lumps on the way of a packet's rays, and the order in which they are met: that is sorted, as steps are large.
#[derive(Clone, Copy, Debug)]
pub struct Stairs<'a> {
    /// Each lump.
    pub steps: &'a [Step],
    /// In order of `from`.
    pub turns: &'a [Turn],
    /// Whether all of them are Gaussian points, for which the way is compiled apart: nearly all scenes have such packets.
    pub plain: bool,
}

impl<'a> Stairs<'a> {
    /// The lumps that a ray may meet between two parameters.
    #[inline(always)]
    pub fn between(self, first: f32, last: f32) -> impl Iterator<Item = &'a Step> {
        self.turns
            .iter()
            .take_while(move |turn| turn.from <= last)
            .filter(move |turn| turn.to >= first)
            .map(move |turn| &self.steps[turn.step as usize])
    }
}

/// Where rays climb.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Where each ray starts.
    pub from: f32x8,
    /// Where it ends.
    pub to: f32x8,
    /// A guess at the crossing; infinite where there is none …
    pub guess: f32x8,
    /// … and where to look first, at or before it: so far that the rest of the way to the guess can be told to hold no
    /// more than one crossing.
    pub first: f32x8,
    /// The rays that go, a bit each.
    pub alive: u32,
    /// Pieces shorter than this are not divided.
    pub tolerance: f32,
    /// Where the field is T it is not known better than this.
    pub noise: f32,
}

/// Where rays came to.
#[derive(Clone, Copy, Debug)]
pub struct Climbed {
    /// Near the crossing, on rays that cross.
    pub t: f32x8,
    /// It lies between these.
    pub between: [f32x8; 2],
    /// Those rays, a bit each.
    pub met: u32,
    /// Rays that went, as it seems, past the surface, but so near to it that rounding may have hidden it …
    pub doubtful: u32,
    /// … and between which parameters that was.
    pub doubt: [f32x8; 2],
    /// Evaluations of lumps, for one ray each.
    pub evaluations: u64,
}

/// T, less what rounding takes from sums: a ray that rounding alone keeps outside meets the surface.
const LEVEL: f32 = 1.0 - 1e-6;

/// A field of this much is deep inside.
const DEEP: f32 = 1.5;

/// From where the field is more than this a step is no longer than …
const NEARLY: f32 = 0.15;
/// … this part of what leads along the tangent to T: Gaussians are convex where they rise, and are at T before.
const TANGENT: f32 = 1.1;

/// Pieces that rounding leaves in doubt are halved until they are no longer than this.
const DOUBTFUL: f32 = 1e-3;

/// A piece of length h would have served, as a chord, if `N·h²` had been 8 times the room left below T; a little less is tried
/// next …
const SERVES: f32 = 6.0;
/// … or, where the field falls from the start, as far as this times what the bend can turn; …
const FALLS: f32 = 1.8;
/// … but no less than this part of the piece, as on a shorter one N will be less.
const LEAST: f32 = 0.1;

/// Evaluations after which a packet is given up; those of the published scenes need some thousand.
const MOST_EVALUATIONS: u64 = 1 << 24;
/// Rounds after which a packet is given up.
const MOST_ROUNDS: u32 = 400;

/// What the lumps add up to at the far end of a piece, and on the piece.
struct Sum {
    value: f32x8,
    slope: f32x8,
    most: f32x8,
    bend: f32x8,
    kink: f32x8,
    /// Of which lumps: what rays meet between these parameters.
    between: [f32; 2],
}

/// Climbs. `None` if a ray starts inside or none of this ends, which is for others to deal with. `tops` is working space.
#[must_use]
pub fn climb(lumps: Stairs<'_>, way: &Way, tops: &mut Vec<f32x8>) -> Option<Climbed> {
    if tops.len() < lumps.turns.len() {
        tops.resize(lumps.turns.len(), f32x8::splat(0.0));
    }
    if lumps.plain {
        climb_among::<true>(lumps, way, tops)
    } else {
        climb_among::<false>(lumps, way, tops)
    }
}

/// See [`climb`] and [`Stairs::plain`].
#[inline(never)]
fn climb_among<const PLAIN: bool>(
    lumps: Stairs<'_>,
    way: &Way,
    tops: &mut [f32x8],
) -> Option<Climbed> {
    let zero = f32x8::splat(0.0);
    let level = f32x8::splat(LEVEL);
    let surely = f32x8::splat(LEVEL - way.noise);
    let tolerance = f32x8::splat(way.tolerance);
    let tiny = f32x8::splat(f32::MIN_POSITIVE);
    let mut evaluations = 0;
    let far = f32x8::splat(f32::INFINITY);
    let (mut doubtful, mut doubt) = (0, [far, -far]);
    // Known: below T up to `low`, with these values there.
    let mut low = way.from;
    let mut going = way.alive & low.simd_lt(way.to).to_bitmask();
    // Where rays come from outside of all lumps' reach there is nothing yet.
    let (mut low_value, mut low_slope) = (zero, zero);
    if low.simd_le(zero).to_bitmask() & going != 0 {
        (low_value, low_slope) = values::<PLAIN>(lumps, low, way.alive, &mut evaluations);
    }
    if level.simd_le(low_value).to_bitmask() & going != 0 {
        return None;
    }
    // And above T at `high`, on the rays that are known to be that somewhere.
    let mut known = 0;
    let mut high = f32x8::splat(f32::INFINITY);
    let (mut high_value, mut high_slope, mut high_bend, mut high_kink) = (zero, zero, zero, zero);
    let mut step = f32x8::splat(f32::INFINITY);
    let mut next = way.first.fast_min(way.to).fast_max(low);
    let mut met = 0;
    for _ in 0..MOST_ROUNDS {
        if evaluations > MOST_EVALUATIONS {
            return None;
        }
        if going == 0 {
            let mut climbed = Climbed {
                t: high,
                between: [low, high],
                met,
                doubtful,
                doubt,
                evaluations,
            };
            if met != 0 {
                polish::<PLAIN>(
                    lumps,
                    &mut climbed,
                    low_value,
                    [high_value, high_slope, high_bend],
                );
            }
            return Some(climbed);
        }
        let at = next;
        let sum = Sum::on::<PLAIN>(lumps, low, at, going, tops, &mut evaluations);
        let length = at - low;
        let short = length.simd_le(tolerance).to_bitmask();
        let above = level.simd_le(sum.value).to_bitmask() & going;
        // Above the chord by no more than a parabola, whose sum with the chord is largest inside only if it is steeper.
        let parabola = length * (f32x8::splat(0.5) * length * sum.bend + sum.kink);
        let steeper = (parabola - (sum.value - low_value).abs()).fast_max(zero);
        let bulge = f32x8::splat(0.25) * steeper * steeper / parabola.fast_max(tiny);
        // A parabola that is no number proves nothing.
        let chord = parabola
            .simd_lt(far)
            .select(low_value.fast_max(sum.value) + bulge, far);
        let below = going & !above;
        // A chord's bound may be no number.
        let under = |level| sum.most.simd_lt(level) | chord.simd_lt(level);
        let calm = below & under(surely).to_bitmask();
        let mut passed = calm;
        if below & !calm != 0 {
            let brief = length.simd_le(f32x8::splat(DOUBTFUL)) & under(level);
            let doubted = below & !calm & (short | brief.to_bitmask());
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
        // Those that go on.
        let mask = mask(passed);
        low = mask.select(at, low);
        low_value = mask.select(sum.value, low_value);
        low_slope = mask.select(sum.slope, low_slope);
        // A length that served may be doubled.
        let doubled = f32x8::splat(2.0) * step.fast_min(length.fast_max(tolerance));
        // Where the field rises towards T a tangent leads a little beyond the crossing.
        let room = f32x8::splat(TANGENT) * (level - sum.value);
        let rises = f32x8::splat(NEARLY).simd_lt(sum.value) & zero.simd_lt(sum.slope);
        let tangent = (room / sum.slope).fast_max(tolerance);
        let doubled = rises.select(doubled.fast_min(tangent), doubled);
        step = self::mask(passed & moved).select(doubled, step);
        let arrived = passed & way.to.simd_le(low).to_bitmask();
        going &= !arrived;
        // Those that must look closer.
        if failed != 0 {
            let room = level - low_value.fast_max(sum.value);
            let served = (f32x8::splat(SERVES) * room.fast_max(zero) / sum.bend).sqrt();
            let down = f32x8::splat(FALLS) * -low_slope / sum.bend;
            let served = served
                .fast_max(down)
                .fast_min(f32x8::splat(0.5) * length)
                .fast_max(f32x8::splat(LEAST) * length);
            let closer = sum.closer(lumps, tops, failed, [low, at], low + served, tolerance) - low;
            step = self::mask(failed).select(closer, step);
        }
        let goal = low.simd_lt(way.guess).select(way.guess, way.to);
        let goal = goal.fast_min(way.to);
        next = goal.fast_min(low + step);
        known |= above;
        if known == 0 {
            continue;
        }
        // Those that know of a crossing.
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
        let settled = only.to_bitmask() & level.simd_le(high_value).to_bitmask() & going;
        met |= settled;
        going &= !settled;
        // Before the crossing, so far that the rest could be told to be its only one; from deep inside by Newton's
        // step for the logarithm, which for Gaussians leads out, but not far.
        let near = high - (f32x8::splat(1.4) / high_bend).sqrt();
        let deep = f32x8::splat(DEEP).simd_lt(high_value);
        let mut back = near;
        if deep.to_bitmask() & going != 0 {
            let out = high - Real::ln(high_value) * high_value / high_slope;
            let out = zero.simd_lt(high_slope).select(out, low);
            back = deep.select(out, near);
        }
        let middle = f32x8::splat(0.5) * (low + high);
        let fits = low.simd_lt(back) & back.simd_lt(high);
        let back = fits.select(back, middle).fast_min(low + step);
        next = self::mask(known).select(back, next);
    }
    None
}

/// A mask from bits, one a lane.
#[inline(always)]
pub fn mask(bits: u32) -> f32x8 {
    let bit = wide::i32x8::new([1, 2, 4, 8, 16, 32, 64, 128]);
    let set = wide::i32x8::splat(bits as i32) & bit;
    wide::bytemuck::cast(set.simd_eq(bit))
}

/// The lowest and highest of the lanes given by bits.
#[inline(always)]
pub fn extremes(a: f32x8, b: f32x8, bits: u32) -> (f32, f32) {
    let mask = mask(bits);
    let low = mask.select(a, f32x8::splat(f32::INFINITY));
    let high = mask.select(b, f32x8::splat(f32::NEG_INFINITY));
    (least(low), -least(-high))
}

/// The field at t, and its slope.
#[inline(always)]
fn values<const PLAIN: bool>(
    lumps: Stairs<'_>,
    t: f32x8,
    bits: u32,
    evaluations: &mut u64,
) -> (f32x8, f32x8) {
    let (first, last) = extremes(t, t, bits);
    let (mut value, mut slope) = (f32x8::splat(0.0), f32x8::splat(0.0));
    for lump in lumps.between(first, last) {
        *evaluations += 8;
        let (v, s) = lump.course::<PLAIN>().at(t);
        value += v;
        slope += s;
    }
    (value, slope)
}

impl Sum {
    /// Adds up what counts between two parameters. What each lump adds to `most` is written to `tops`.
    #[inline(always)]
    fn on<const PLAIN: bool>(
        lumps: Stairs<'_>,
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
        for (lump, top) in lumps.between(first, last).zip(tops) {
            let course = lump.course::<PLAIN>();
            let (value, slope, here) = course.bent(to);
            let Limits { most, bend, kink } = if course.rises_until(to) {
                Limits {
                    most: value,
                    bend: here,
                    kink: zero,
                }
            } else {
                *evaluations += 8;
                course.most(from, to)
            };
            *evaluations += 8;
            sum.value += value;
            sum.slope += slope;
            sum.most += most;
            sum.bend += bend;
            if course.has_kinks() {
                sum.kink += kink;
            }
            *top = most;
        }
        sum
    }

    /// Where to look instead on a piece about which nothing can be told: up to where the largest lump begins to be strong,
    /// or to where it ends, or so far as may serve.
    #[inline(never)]
    fn closer(
        &self,
        lumps: Stairs<'_>,
        tops: &[f32x8],
        lanes: u32,
        [from, to]: [f32x8; 2],
        served: f32x8,
        tolerance: f32x8,
    ) -> f32x8 {
        let [first, last] = self.between;
        let zero = f32x8::splat(0.0);
        let largest = tops_of(lumps, tops, first, last).fold(zero, |l, (_, top)| l.fast_max(*top));
        let (mut near, mut far) = (f32x8::splat(1.0), f32x8::splat(-1.0));
        let mut left = mask(lanes) & zero.simd_lt(largest);
        for (lump, top) in tops_of(lumps, tops, first, last) {
            let here = left & largest.simd_eq(*top);
            if here.any() {
                let [a, b] = lump.course.within(f32x8::splat(lump.strong));
                near = here.select(a, near);
                far = here.select(b, far);
                left &= !here;
            }
        }
        let strong = near.simd_lt(far);
        let ends = strong & (from + tolerance).simd_lt(far) & far.simd_lt(to);
        let begins = strong & (from + tolerance).simd_lt(near) & near.simd_lt(to);
        begins.select(near, ends.select(far, served))
    }
}

/// The lumps of a [`Sum`] with what each added to `most`.
fn tops_of<'a>(
    lumps: Stairs<'a>,
    tops: &'a [f32x8],
    first: f32,
    last: f32,
) -> impl Iterator<Item = (&'a Step, &'a f32x8)> {
    lumps.between(first, last).zip(tops)
}

/// Steps towards the crossings: Newton's, or between the ends where those lead out. At the far end value, slope and
/// bend are known.
#[inline(never)]
fn polish<const PLAIN: bool>(
    lumps: Stairs<'_>,
    climbed: &mut Climbed,
    mut low_value: f32x8,
    [mut high_value, slope, bend]: [f32x8; 3],
) {
    let level = f32x8::splat(1.0);
    let [mut low, mut high] = climbed.between;
    let (mut at, mut value, mut slope) = (high, high_value, slope);
    for step in 0..MOST_STEPS {
        let newton = at - (value - level) / slope;
        let fits = low.simd_le(newton) & newton.simd_le(high);
        let share = (level - low_value) / (high_value - low_value);
        let share = share
            .fast_max(f32x8::splat(0.0))
            .fast_min(f32x8::splat(1.0));
        // Newton's steps could go on for ever within the ends; halving does not.
        let between = if step % 4 == 3 {
            f32x8::splat(0.5)
        } else {
            share
        };
        let next = fits.select(newton, low + (high - low) * between);
        let length = next - at;
        at = next;
        // What this step leaves, and its look at the surface will mend: a field that bends down by no more than `bend` may bend
        // up more, Gaussians by about the square of the slope over the value.
        let up = slope * slope / value.fast_max(level);
        let left = (bend + up) * length * length;
        let near = fits & left.simd_lt(f32x8::splat(CLOSE));
        if !near.to_bitmask() & climbed.met == 0 {
            break;
        }
        (value, slope) = values::<PLAIN>(lumps, at, climbed.met, &mut climbed.evaluations);
        let over = level.simd_le(value);
        high = over.select(at, high);
        high_value = over.select(value, high_value);
        low = over.select(low, at);
        low_value = over.select(low_value, value);
    }
    climbed.t = at;
    climbed.between = [low, high];
}

/// Newton's steps at most.
const MOST_STEPS: u32 = 24;
/// Where a step ends the field is within about this of T.
const CLOSE: f32 = 2e-2;

#[cfg(test)]
mod tests {
    use super::*;
    use field::{Kernel, Primitive, Shaping, Skeleton};
    use glam::DVec3;

    /// Random numbers between 0 and 1.
    fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(99);
            (state >> 33) as f64 / f64::from(1u32 << 31)
        }
    }

    /// Points and segments around the origin.
    fn lumps(next: &mut impl FnMut() -> f64, count: usize) -> Vec<Primitive> {
        let mut place = || DVec3::new(next(), next(), next()) * 1.6 - 0.8;
        let places: Vec<_> = (0..count).map(|_| (place(), place())).collect();
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
                    radius: 0.03 + 0.3 * next() * next(),
                    blobbiness: -1.0 - 4.0 * next(),
                    blob_scale: field::BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                Primitive::new(skeleton, &shaping, None)
            })
            .collect()
    }

    /// All rays of a packet, through all of it, without a guess.
    fn way(noise: f32) -> Way {
        Way {
            from: f32x8::splat(0.0),
            to: f32x8::splat(3.9),
            guess: f32x8::splat(f32::INFINITY),
            first: f32x8::splat(f32::INFINITY),
            alive: 255,
            tolerance: 5e-5,
            noise,
        }
    }

    fn plain(steps: &[Step]) -> bool {
        steps.iter().all(|step| step.course.is_gaussian_point())
    }

    /// All from the start on.
    fn turns(steps: &[Step]) -> Vec<Turn> {
        let turn = |step| Turn {
            from: 0.0,
            to: 10.0,
            step,
        };
        (0..steps.len() as u32).map(turn).collect()
    }

    /// What rays meet.
    fn steps(primitives: &[Primitive], rays: &[(DVec3, DVec3); 8]) -> Vec<Step> {
        let lane = |f: &dyn Fn(usize) -> f64| f32x8::from_lanes(f);
        let direction: [f32x8; 3] = [0, 1, 2].map(|k| lane(&|i| rays[i].1[k]));
        primitives
            .iter()
            .enumerate()
            .map(|(index, p)| {
                let lump = p.lump::<f32>().expect("a lump");
                let middle = [0, 1, 2].map(|k| lane(&|i| p.lump_middle()[k] - rays[i].0[k]));
                let course = lump.course(middle, direction);
                let square = lump.reach(1e-6);
                let strong = lump.core(square, 1e-6) + 2.0;
                Step {
                    course,
                    strong: strong as f32,
                    index: index as u32,
                }
            })
            .collect()
    }

    /// The first crossing of a ray, by very many samples in double precision, with how near the field comes to T before.
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

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn the_first_crossing_is_found_and_no_other() {
        // Kept, as it is between packets.
        let mut tops = Vec::new();
        let mut next = random(11);
        let (mut hits, mut misses) = (0, 0);
        for case in 0..40 {
            let primitives = lumps(&mut next, 1 + case % 9);
            let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| {
                let origin = DVec3::new(next() - 0.5, next() - 0.5, -4.0) * 0.5;
                let aim = DVec3::new(next() - 0.5, next() - 0.5, 0.0);
                (origin, (aim - origin).normalize())
            });
            let steps = steps(&primitives, &rays);
            let way = way(0.0);
            let turns = turns(&steps);
            let lumps = Stairs {
                steps: &steps,
                turns: &turns,
                plain: plain(&steps),
            };
            let Some(climbed) = climb(lumps, &way, &mut tops) else {
                // Only where a ray starts inside.
                let starts = rays.iter().any(|&(origin, direction)| {
                    scan(&primitives, origin, direction).0 == Some(0.0)
                });
                assert!(starts, "case {case} was given up");
                continue;
            };
            for (i, &(origin, direction)) in rays.iter().enumerate() {
                let (want, nearest) = scan(&primitives, origin, direction);
                let got = (climbed.met >> i & 1 != 0).then(|| f64::from(climbed.t.to_array()[i]));
                match (want, got) {
                    (None, None) => misses += 1,
                    (Some(want), Some(got)) if (want - got).abs() < 1e-3 => hits += 1,
                    // What the samples step over, or single precision cannot tell.
                    _ => assert!(
                        nearest < 1e-3,
                        "case {case}, ray {i}: {want:?} {got:?} {nearest}"
                    ),
                }
            }
        }
        assert!(hits > 60 && misses > 60, "{hits} {misses}");
    }

    /// Where the field comes nearer to T than it is known a ray that passes is in doubt, and nowhere else.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn rays_that_noise_may_have_kept_outside_are_in_doubt() {
        // Kept, as it is between packets.
        let mut tops = Vec::new();
        const NOISE: f64 = 0.05;
        let mut next = random(23);
        let (mut doubted, mut sure) = (0, 0);
        for case in 0..160 {
            let primitives = lumps(&mut next, 1 + case % 5);
            // Past the first lump, close to its surface.
            let target = primitives[0].lump_middle();
            let alone = |x: f64| primitives[0].value((target + DVec3::X * x).to_array());
            let radius = (0..200)
                .map(|i| f64::from(i) * 5e-3)
                .find(|x| alone(*x) < 1.0);
            let radius = radius.unwrap_or(0.0);
            let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| {
                let origin = DVec3::new(next() - 0.5, next() - 0.5, -4.0) * 0.5;
                let aside = DVec3::new(next() - 0.5, next() - 0.5, 0.0).normalize_or_zero();
                let aim = target + aside * (radius * (0.95 + 0.2 * next()));
                (origin, (aim - origin).normalize())
            });
            let steps = steps(&primitives, &rays);
            let way = way(NOISE as f32);
            let turns = turns(&steps);
            let lumps = Stairs {
                steps: &steps,
                turns: &turns,
                plain: plain(&steps),
            };
            let Some(climbed) = climb(lumps, &way, &mut tops) else {
                continue;
            };
            for (i, &(origin, direction)) in rays.iter().enumerate() {
                let bit = |mask: u32| mask >> i & 1 != 0;
                if bit(climbed.met) {
                    continue;
                }
                let field = |t: f64| {
                    let point = (origin + direction * t).to_array();
                    primitives.iter().map(|p| p.value(point)).sum::<f64>()
                };
                let place = |i: i32| f64::from(i) * 1e-3;
                let near = |t: &f64| field(*t) > 1.0 - 0.9 * NOISE;
                let close: Vec<f64> = (0..3900).map(place).filter(near).collect();
                let [from, to] = climbed.doubt.map(|t| f64::from(t.to_array()[i]));
                if bit(climbed.doubtful) {
                    doubted += 1;
                    let most = (0..3900).map(place).map(field).fold(0.0, f64::max);
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
        assert!(doubted > 30 && sure > 100, "{doubted} {sure}");
    }

    /// What is compiled for Gaussian points alone comes to the same bits.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn gaussian_points_alone_are_as_among_others() {
        // Kept, as it is between packets.
        let mut tops = Vec::new();
        let mut next = random(31);
        let mut hits = 0;
        for case in 0..60 {
            let mut primitives = lumps(&mut next, 4 + case % 20);
            let gaussian = |p: &Primitive| {
                matches!(p.skeleton, Skeleton::Point { .. }) && p.kernel == Kernel::Gauss
            };
            primitives.retain(gaussian);
            let rays: [(DVec3, DVec3); 8] = core::array::from_fn(|_| {
                let origin = DVec3::new(next() - 0.5, next() - 0.5, -4.0) * 0.5;
                let aim = DVec3::new(next() - 0.5, next() - 0.5, 0.0);
                (origin, (aim - origin).normalize())
            });
            let steps = steps(&primitives, &rays);
            let turns = turns(&steps);
            assert!(plain(&steps) && !steps.is_empty());
            let [alone, among] = [true, false].map(|plain| {
                let lumps = Stairs {
                    steps: &steps,
                    turns: &turns,
                    plain,
                };
                let climbed = climb(lumps, &way(1e-3), &mut tops)?;
                hits += climbed.met.count_ones();
                let places = [climbed.t, climbed.between[0], climbed.between[1]];
                let bits = places.map(|t| t.to_array().map(f32::to_bits));
                Some((bits, climbed.met, climbed.doubtful, climbed.evaluations))
            });
            assert_eq!(alone, among, "case {case}");
        }
        assert!(hits > 50, "{hits}");
    }

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn a_ray_that_starts_inside_is_left_to_others() {
        let mut next = random(5);
        let primitive = &lumps(&mut next, 1)[0];
        let lump = primitive.lump::<f32>().expect("a lump");
        let zero = f32x8::splat(0.0);
        let course = lump.course([zero; 3], [zero, zero, f32x8::splat(1.0)]);
        let steps = [Step {
            course,
            strong: -1.0,
            index: 0,
        }];
        let way = Way {
            from: zero,
            to: f32x8::splat(1.0),
            guess: zero,
            first: zero,
            alive: 255,
            tolerance: 5e-5,
            noise: 0.0,
        };
        let turns = turns(&steps);
        let lumps = Stairs {
            steps: &steps,
            turns: &turns,
            plain: plain(&steps),
        };
        assert!(climb(lumps, &way, &mut Vec::new()).is_none());
    }
}
