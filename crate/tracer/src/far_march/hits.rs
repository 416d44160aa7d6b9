//! First crossings of rays with the surface in a piece of their way, and the surface there.
use super::body::FarBody;
use super::piece::{Known, Piece};
use super::query::{FarQuery, FarWork, ROUNDING};
use crate::blob_march::{
    Bounded, LEVEL, MarchRays, Marched, RayBlobs, extremes, march_before, mask, values,
};
use crate::layout::lanes_in;
use crate::ray::Ray;
use crate::root_isolation::{Along, RootIsolator};
use crate::surface_samples::{COARSEST_OF_BLOBS, FINEST, NEAR_ENOUGH};
use crate::walk::Quest;
use field::{Cut, Real, THRESHOLD};
use wide::f32x8;

/// Largest number of Newton steps to a hit.
const MOST_REFINING: u32 = 12;
/// Largest error of a refined hit, excess over slope, as a part of the tolerance.
const REFINED: f32 = 0.25;

/// The places at which a march begins.
#[derive(Clone, Copy)]
pub struct Start {
    /// Estimate of the crossing, and the end of the first step ([`MarchRays`]).
    pub guess: f32x8,
    pub first: f32x8,
    /// Whether the rays start with this piece.
    pub is_start: bool,
}

impl FarQuery<'_> {
    /// Returns half the tolerance of pictures at a parameter.
    pub fn tolerance(&self, t: f64) -> f64 {
        (0.1 * self.pixel * t).clamp(FINEST, COARSEST_OF_BLOBS)
    }
}

impl FarBody {
    /// Follows rays through a piece of their way, among the blobs in `work`. Returns those that
    /// cross the surface there, a bit each; `None` if they must be followed in another way.
    pub(super) fn follow(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        known: &Known,
        alive: u32,
        begin: Start,
        work: &mut FarWork,
    ) -> Option<u32> {
        let half = f32x8::splat(piece.half as f32);
        let ends = f32x8::from_lanes(|i| (query.limits[i] - piece.t).at_most(1e30));
        let to = half.fast_min(ends);
        let blobs = RayBlobs {
            blobs: &work.blobs,
            intervals: &work.intervals,
            plain: false,
        };
        let start = -half;
        let behind = Bounded::new(&known.backdrop);
        let (value, slope) = values::<false, _>(blobs, behind, start, alive, &mut work.evaluations);
        let inside = f32x8::splat(LEVEL).simd_le(value).to_bitmask() & alive;
        if inside != 0 && begin.is_start {
            return None;
        }
        let rays = MarchRays {
            from: start,
            to,
            guess: begin.guess,
            first: begin.first,
            alive: alive & !inside,
            // At the nearest place where a ray may meet something.
            tolerance: query.tolerance(piece.t - piece.half) as f32,
            noise: match query.quest {
                Quest::Entry => 0.0,
                _ => (known.error + ROUNDING) as f32,
            },
            start: Some([value, slope]),
        };
        let mut marched = march_before(blobs, &known.backdrop, &rays, &mut work.tops)?;
        work.evaluations += marched.evaluations;
        let doubtful = marched.doubtful & alive;
        if doubtful != 0 && query.quest == Quest::First {
            self.isolate(query, piece, &mut marched, work);
        }
        // From one cell to the next the field may jump by its error.
        let at_start = mask(inside);
        marched.t = at_start.select(start, marched.t);
        for end in &mut marched.between {
            *end = at_start.select(start, *end);
        }
        marched.met |= inside;
        if marched.met != 0 && query.quest != Quest::Entry {
            self.sample(query, piece, known, &marched, work)?;
        }
        Some(marched.met)
    }

    /// Returns a ray of a packet, with parameters relative to a piece's middle.
    pub(super) fn along<'a>(
        &self,
        query: &FarQuery<'a>,
        piece: &Piece<'_>,
        lane: usize,
    ) -> Along<'a> {
        let ray = query.rays[lane];
        Along {
            sight: query.sight,
            ray: Ray {
                origin: ray.at(piece.t),
                direction: ray.direction,
            },
            resolution: query.resolution,
        }
    }

    /// Iterates over the numbers of the body's primitives.
    pub(super) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.first as u32..(self.first + self.count) as u32
    }

    /// Repeats the search on the doubtful intervals of rays, in double precision and with all
    /// primitives.
    #[cold]
    #[inline(never)]
    fn isolate(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        marched: &mut Marched,
        work: &mut FarWork,
    ) {
        let [first, last] = marched.doubt.map(f32x8::to_array);
        let mut t = marched.t.to_array();
        let mut between = marched.between.map(f32x8::to_array);
        for lane in lanes_in(marched.doubtful) {
            let mut isolator = RootIsolator::default();
            isolator.list.extend(self.numbers());
            let mut found = None;
            let interval = [f64::from(first[lane]), f64::from(last[lane])];
            isolator.crossings(&self.along(query, piece, lane), interval, |t, inside| {
                found = inside.then_some(t);
                !inside
            });
            work.doubts += 1;
            work.evaluations += isolator.evaluations;
            if let Some(found) = found {
                t[lane] = found as f32;
                between.iter_mut().for_each(|end| end[lane] = t[lane]);
                marched.met |= 1 << lane;
            }
        }
        marched.t = f32x8::new(t);
        marched.between = between.map(f32x8::new);
    }

    /// Moves hits onto the surface and samples it there. `None` if the field's error moves one of
    /// them by more than the tolerance.
    pub(super) fn sample(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        known: &Known,
        marched: &Marched,
        work: &mut FarWork,
    ) -> Option<()> {
        let met = marched.met;
        let (nearest, _) = extremes(marched.t, marched.t, met);
        let tolerance = query.tolerance(piece.t + f64::from(nearest));
        let blobs = RayBlobs {
            blobs: &work.blobs,
            intervals: &work.intervals,
            plain: false,
        };
        let behind = Bounded::new(&known.backdrop);
        let [mut low, mut high] = marched.between;
        let mut at = marched.t;
        let near_enough = f32x8::splat(0.5 * NEAR_ENOUGH);
        let finest = f32x8::splat(ROUNDING as f32);
        for _ in 0..MOST_REFINING {
            let (value, slope) = values::<false, _>(blobs, behind, at, met, &mut work.evaluations);
            let excess = value - f32x8::splat(THRESHOLD as f32);
            let over = excess.simd_ge(f32x8::splat(0.0));
            high = over.select(at, high);
            low = over.select(low, at);
            let allowed = (slope.abs() * f32x8::splat(REFINED * tolerance as f32))
                .fast_min(near_enough)
                .fast_max(finest);
            if allowed.simd_lt(excess.abs()).to_bitmask() & met == 0 {
                break;
            }
            let newton = at - excess / slope;
            let good = low.simd_le(newton) & newton.simd_le(high);
            at = good.select(newton, f32x8::splat(0.5) * (low + high));
        }
        let place = piece.places(at);
        let gradient = self.gradient(piece, place, work);
        let steep = gradient.iter().fold(f32x8::splat(0.0), |s, g| s + *g * *g);
        let moved = (steep.sqrt() * f32x8::splat(tolerance as f32))
            .simd_lt(f32x8::splat(known.error as f32));
        if moved.to_bitmask() & met != 0 {
            return None;
        }
        let lanes = mask(met);
        let t = at.to_array();
        for lane in lanes_in(met) {
            work.samples.t[lane] = piece.t + f64::from(t[lane]);
        }
        for (own, new) in work.samples.gradient.iter_mut().zip(gradient) {
            *own = lanes.select(new, *own);
        }
        self.weigh(query, piece, at, met, work)
    }

    /// Returns the field's gradients at places relative to a piece's middle.
    fn gradient(&self, piece: &Piece<'_>, place: [f32x8; 3], work: &mut FarWork) -> [f32x8; 3] {
        let cell = piece.cell;
        let scale = f32x8::splat(1.0 / cell.reach() as f32);
        let jet = cell.expansion.jet(piece.local(cell, place), f32x8::splat);
        let mut gradient = jet.gradient.map(|g| g * scale);
        for (index, number) in cell.near.iter().enumerate() {
            let own = work.places[index].map(f32x8::splat);
            let away = core::array::from_fn(|i| place[i] - own[i]);
            let jet = self.points.each[*number as usize].blob.jet(away);
            for (sum, part) in gradient.iter_mut().zip(jet.gradient) {
                *sum += part;
            }
        }
        work.evaluations += 8 * cell.near.len() as u64;
        gradient
    }

    /// Samples the finishes' shares at hits. `None` if the beam is too wide for a finish's
    /// hierarchy.
    fn weigh(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        at: f32x8,
        met: u32,
        work: &mut FarWork,
    ) -> Option<()> {
        let lanes = mask(met);
        let primitives = self.primitives(query);
        let (first, last) = extremes(at, at, met);
        let [first, last] = [first, last].map(|t| piece.t + f64::from(t));
        let center = piece.axis_at(0.5 * (first + last));
        let radius = 0.5 * (last - first) + piece.width;
        let place = piece.places(at);
        let world = piece.world(place);
        for ((_, field), (_, weight)) in self.finishes.iter().zip(&mut work.samples.weights) {
            let mut own = f32x8::splat(THRESHOLD as f32);
            if let Some(field) = field {
                let cell = field.around(primitives, center, radius)?;
                let local = piece.local(cell, place);
                own = cell.expansion.jet(local, f32x8::splat).value;
                for number in &*cell.near {
                    own += primitives[*number as usize].value(world);
                }
                work.evaluations += 8 * cell.near.len() as u64;
            }
            *weight = lanes.select(own.fast_max(f32x8::splat(0.0)), *weight);
        }
        Some(())
    }
}
