//! Certified marching among very many points of kernels that never end.
//!
//! Such a field is small nowhere, so no ball bounds what a ray meets. A [`FarField`] divides space into cells, each with a polynomial
//! of what is far and a list of what is near. A packet visits the cells along its beam, front to back: those in which the field is
//! below T are left at once, in the others
//!
//! - the far field is the cell's polynomial along each ray,
//! - near points whose cubic Hermite span over the cell has a small enough error are added to it by that,
//! - the rest are blobs, and [`march_before`] follows the rays among them.
//!
//! So the surface found is that of a field that differs from the true one by a stated bound, which counts like rounding: what it may
//! hide is searched again among all points in double precision.
use crate::beam::Beam;
use crate::blob_march::{
    Backdrop, Bounded, LEVEL, MarchRays, Marched, RayBlob, RayBlobs, RayInterval, march_before,
    mask, values,
};
use crate::layout::PACKET;
use crate::ray::Ray;
use crate::root_isolation::{Along, BoundedTerms, RootIsolator};
use crate::surface_samples::{COARSEST_OF_BLOBS, FINEST, NEAR_ENOUGH, SurfaceSamples};
use crate::walk::Quest;
use field::far_field::{Cell, DEGREE, LOOSE, power};
use field::{Blob, Cut, FarField, Primitive, Real, THRESHOLD};
use glam::DVec3;
use wide::f32x8;

/// Fewest points for which this way pays.
const FEWEST: usize = 64;
/// Near points up to which a cell is not divided.
const FEW_NEAR: usize = 48;
/// Largest error of all spans in a cell together, in T.
const OF_SPANS: f64 = 3e-5 * THRESHOLD;
/// Largest error of a cell's polynomial; beyond it rounding is too large for this way.
const MOST_OF_CELLS: f64 = 2e-4 * THRESHOLD;
/// Bound on the rounding of sums in single precision near T.
const ROUNDING: f64 = 4e-6 * THRESHOLD;
/// Field of a point where it begins to be strong ([`RayBlob::strong`]).
const STRONG: f64 = 0.6 * THRESHOLD;
/// Distance from a point's own surface at which a ray is well outside, in kernel widths.
const LEAD: f64 = 0.3;
/// Half the side of the hierarchy's cube, over the radius of the ball that holds the surface.
const ROOM: f64 = 1.25;
/// Least size of a cell, over the hierarchy's.
const SMALLEST: f64 = 1e-6;
/// Most cells that a packet visits.
const MOST_CELLS: u32 = 4096;
/// Largest number of Newton steps to a hit.
const MOST_REFINING: u32 = 12;
/// Part of the tolerance up to which a hit is refined, as excess over slope.
const REFINED: f32 = 0.25;

/// The points of a body with their hierarchy.
pub(crate) struct FarBody {
    field: FarField,
    points: Vec<FarPoint>,
    /// Number of the body's first primitive.
    first: usize,
    finish: u32,
    /// The kernel's exponent and softening.
    power: i32,
    softening: f32,
    /// Ball that holds the surface.
    center: DVec3,
    radius: f64,
}

/// A point.
struct FarPoint {
    center: DVec3,
    blob: Blob<f32>,
    scale: f32,
    amplitude: f32,
    /// Squared distance of its own surface, in kernel widths, and that from which on it is strong.
    core: f32,
    strong: f32,
    lead: f32,
}

/// Working space of one thread.
#[derive(Default)]
pub struct FarWork {
    blobs: Vec<RayBlob>,
    intervals: Vec<RayInterval>,
    tops: Vec<f32x8>,
    /// Positions relative to the middle of the present piece, point by point of the cell's list.
    places: Vec<[f32; 3]>,
    /// Indices into the cell's list: of points that are blobs, and of those that are spans.
    strong: Vec<u32>,
    weak: Vec<u32>,
    /// Surface samples at the hits of the last packet.
    pub flesh: SurfaceSamples,
    pub evaluations: u64,
    /// Rays searched again in double precision.
    pub doubts: u64,
}

/// A query for the rays of a packet.
#[derive(Clone, Copy)]
pub struct FarQuery<'r> {
    pub rays: &'r [Ray; PACKET],
    /// End of each ray.
    pub limits: &'r [f64; PACKET],
    /// The rays to follow, a bit each.
    pub alive: u32,
    pub quest: Quest,
    /// Width of a pixel at distance 1.
    pub pixel: f64,
}

/// A part of a packet's way, within one cell.
struct Piece<'a> {
    cell: &'a Cell,
    /// Middle of the beam's axis there, and the parameter.
    middle: DVec3,
    t: f64,
    half: f64,
    /// Width of the beam.
    width: f64,
    /// Direction of the beam's axis.
    axis: [f32x8; 3],
    /// Rays relative to the middle.
    origin: [f32x8; 3],
    direction: [f32x8; 3],
}

impl FarBody {
    /// Prepares a body of primitives numbered from `first` on, with the radius of a ball outside which the field is below T. `None`
    /// if it is no body of many points of one endless kernel and one finish.
    pub fn new(
        primitives: &[Primitive],
        finishes: &[u32],
        first: usize,
        (center, radius): (DVec3, f64),
    ) -> Option<Self> {
        let kernel = primitives.first()?.kernel;
        let (power, softening) = power(kernel)?;
        // A field that falls as 1/r is so large where there are many points that its rounding leaves nothing to save.
        if power < 2 {
            return None;
        }
        let finish = finishes[0];
        if primitives.len() < FEWEST || finishes.iter().any(|other| *other != finish) {
            return None;
        }
        let point = |p: &Primitive| {
            let blob: Blob<f32> = p.endless_point()?;
            let [scale, amplitude] = blob.scale_and_amplitude();
            (p.kernel == kernel).then_some(FarPoint {
                center: p.blob_middle(),
                blob,
                scale,
                amplitude,
                core: blob.square_of(THRESHOLD) as f32,
                strong: blob.square_of(STRONG) as f32,
                lead: (LEAD / p.width) as f32,
            })
        };
        let points: Option<Vec<FarPoint>> = primitives.iter().map(point).collect();
        Some(Self {
            points: points?,
            field: FarField::new(primitives, center, ROOM * radius).surface_only(),
            first,
            finish,
            power,
            softening: softening as f32,
            center,
            radius,
        })
    }

    /// Finds the first crossings of rays with the surface; for [`Quest::Entry`] only whether there is one from outside. Returns the
    /// rays that cross, a bit each, with the surface there in `work.flesh`. `None` if this is not the way for these rays; the caller
    /// then takes the general one.
    pub fn first(
        &self,
        sight: BoundedTerms<'_>,
        query: &FarQuery<'_>,
        resolution: f64,
        work: &mut FarWork,
    ) -> Option<u32> {
        let primitives = &sight.primitives[self.first..self.first + self.points.len()];
        let followed = (0..PACKET).filter(|i| query.alive >> i & 1 != 0);
        let followed: Vec<Ray> = followed.map(|i| query.rays[i]).collect();
        let beam = Beam::around(&followed)?;
        let [from, to] = self.range(&beam)?;
        let mut furthest = 0.0;
        for lane in (0..PACKET).filter(|i| query.alive >> i & 1 != 0) {
            furthest = query.limits[lane].at_least(furthest);
        }
        let to = to.at_most(furthest);
        let root = self.field.root(primitives);
        let (mut alive, mut met) = (query.alive, 0);
        let mut t = from;
        // The present cell and those that contain it, the largest first.
        let mut path = vec![root];
        let mut cells = 0;
        while t < to {
            for (lane, limit) in query.limits.iter().enumerate() {
                alive &= !(u32::from(*limit <= t) << lane);
            }
            if alive == 0 {
                break;
            }
            cells += 1;
            if cells > MOST_CELLS {
                return None;
            }
            let place = beam.axis.at(t + 1e-9 * root.half);
            let room = (LOOSE - 1.0) * (1.0 - 1e-6);
            // How wide the beam is where it leaves a cell of this size.
            let width = |half: f64| {
                let last = t + 4.0 * half;
                beam.width(last) + beam.lag(last)
            };
            if width(root.half) > room * root.half {
                return None;
            }
            // Back to the smallest cell that still holds the beam.
            while let [_, .., cell] = &path[..]
                && (!cell.holds(place) || width(cell.half) > room * cell.half)
            {
                path.pop();
            }
            let mut cell = path[path.len() - 1];
            let empty = loop {
                if cell.most < THRESHOLD - ROUNDING {
                    break true;
                }
                let half = 0.5 * cell.half;
                if cell.near.len() <= FEW_NEAR
                    || width(half) > room * half
                    || half < SMALLEST * root.half
                {
                    break false;
                }
                cell = self.field.part(primitives, cell, cell.part_of(place));
                path.push(cell);
            };
            let end = leaves(&beam.axis, t, cell).at_most(to);
            if !empty {
                if cell.error > MOST_OF_CELLS {
                    return None;
                }
                let piece = Piece::new(cell, &beam, query.rays, [t, end]);
                let first = t <= 0.0;
                let found = self.follow(sight, &piece, query, alive, first, resolution, work)?;
                met |= found;
                alive &= !found;
            }
            t = end;
        }
        if met != 0 {
            work.flesh.weights.clear();
            work.flesh
                .weights
                .push((self.finish, f32x8::splat(THRESHOLD as f32)));
        }
        Some(met)
    }

    /// Parameters between which a beam may be where the surface is; `None` if it is too wide for the hierarchy. Empty if it misses it.
    fn range(&self, beam: &Beam) -> Option<[f64; 2]> {
        let away = self.center - beam.axis.origin;
        let along = away.dot(beam.axis.direction);
        let last = (along + self.radius).at_least(0.0);
        let width = beam.width(last) + beam.lag(last);
        if width.is_nan() || width > 0.1 * (ROOM - 1.0) * self.radius {
            return None;
        }
        let radius = self.radius + width;
        let across = (away - beam.axis.direction * along).length_squared();
        let square = radius * radius - across;
        if square <= 0.0 {
            return Some([0.0, 0.0]);
        }
        let half = square.sqrt();
        Some([(along - half).at_least(0.0), along + half])
    }

    /// Follows rays through a piece of their way. Returns those that cross the surface there; `None` if this is not the way.
    #[expect(clippy::too_many_arguments, reason = "each is something else")]
    fn follow(
        &self,
        sight: BoundedTerms<'_>,
        piece: &Piece<'_>,
        query: &FarQuery<'_>,
        alive: u32,
        first: bool,
        resolution: f64,
        work: &mut FarWork,
    ) -> Option<u32> {
        let Some((backdrop, error)) = self.prepare(piece, work) else {
            return Some(0);
        };
        let half = f32x8::splat(piece.half as f32);
        let ends = f32x8::from_lanes(|i| (query.limits[i] - piece.t).at_most(1e30));
        let to = half.fast_min(ends);
        let (guess, near) = self.guess(piece, work);
        let blobs = RayBlobs {
            blobs: &work.blobs,
            intervals: &work.intervals,
            plain: false,
        };
        let start = -half;
        let behind = Bounded::new(&backdrop);
        let (value, slope) = values::<false, _>(blobs, behind, start, alive, &mut work.evaluations);
        let inside = f32x8::splat(LEVEL).simd_le(value).to_bitmask() & alive;
        if inside != 0 && first {
            return None;
        }
        // Half the tolerance of pictures.
        let tolerance = (0.1 * query.pixel * piece.t).clamp(FINEST, COARSEST_OF_BLOBS);
        let rays = MarchRays {
            from: start,
            to,
            guess,
            first: near,
            alive: alive & !inside,
            tolerance: tolerance as f32,
            noise: match query.quest {
                Quest::Entry => 0.0,
                _ => (error + ROUNDING) as f32,
            },
            start: Some([value, slope]),
        };
        let mut marched = march_before(blobs, &backdrop, &rays, &mut work.tops)?;
        work.evaluations += marched.evaluations;
        let doubtful = marched.doubtful & alive;
        if doubtful != 0 && query.quest == Quest::First {
            self.isolate(sight, piece, query, &mut marched, resolution, work);
        }
        // From one cell to the next the field may jump by its error.
        let at_start = mask(inside);
        marched.t = at_start.select(start, marched.t);
        for end in &mut marched.between {
            *end = at_start.select(start, *end);
        }
        marched.met |= inside;
        if marched.met != 0 && query.quest != Quest::Entry {
            self.sample(piece, &backdrop, &marched, tolerance, error, work)?;
        }
        Some(marched.met)
    }

    /// Collects the blobs of a piece, and the backdrop of all that is not among them, with its error. `None` if the field is below T
    /// in the whole piece.
    fn prepare(&self, piece: &Piece<'_>, work: &mut FarWork) -> Option<(Backdrop, f64)> {
        let cell = piece.cell;
        let count = cell.near.len();
        let axis = piece.axis;
        let length = 2.0 * piece.half;
        // Bounds on fourth derivatives: (e)₄·s⁴·b^(−e−4).
        let rising = f64::from((self.power..self.power + 4).product::<i32>());
        let quartic = f32x8::splat((rising * length * length * length * length / 384.0) as f32);
        let share = f32x8::splat((OF_SPANS / count.max(1) as f64) as f32);
        let (half, width) = (
            f32x8::splat(piece.half as f32),
            f32x8::splat((piece.width * (1.0 + 1e-5) + 1e-7) as f32),
        );
        let zero = f32x8::splat(0.0);
        let softening = f32x8::splat(self.softening);
        let mut most = f32x8::splat(0.0);
        work.places.clear();
        work.blobs.clear();
        work.intervals.clear();
        let mut weak = [[zero; 2]; 2];
        let mut pending: Vec<u32> = core::mem::take(&mut work.strong);
        pending.clear();
        let mut weaker = core::mem::take(&mut work.weak);
        weaker.clear();
        let mut error = f32x8::splat(0.0);
        for (block, numbers) in cell.near.chunks(8).enumerate() {
            let mut places = [[0.0f32; 8]; 3];
            let (mut scale, mut amplitude) = ([0.0f32; 8], [0.0f32; 8]);
            for (lane, &number) in numbers.iter().enumerate() {
                let point = &self.points[number as usize];
                let place = (point.center - piece.middle).as_vec3().to_array();
                work.places.push(place);
                for (row, x) in places.iter_mut().zip(place) {
                    row[lane] = x;
                }
                (scale[lane], amplitude[lane]) = (point.scale, point.amplitude);
            }
            let [x, y, z] = places.map(f32x8::new);
            let (scale, amplitude) = (f32x8::new(scale), f32x8::new(amplitude));
            let along = x * axis[0] + y * axis[1] + z * axis[2];
            let along = along.fast_max(-half).fast_min(half);
            let [x, y, z] = [
                x - along * axis[0],
                y - along * axis[1],
                z - along * axis[2],
            ];
            let apart = ((x * x + y * y + z * z).sqrt() - width).fast_max(zero) * scale;
            let inverse = f32x8::splat(1.0) / (softening + apart * apart);
            let size = amplitude * self.decay(inverse);
            most += size;
            let square = scale * scale;
            let off = quartic * size * (square * square) * (inverse * inverse);
            let is_weak = off.simd_le(share).to_bitmask();
            let there = (1u32 << numbers.len()) - 1;
            error += mask(is_weak & there) & off;
            for lane in 0..numbers.len() as u32 {
                let index = 8 * block as u32 + lane;
                if is_weak >> lane & 1 != 0 {
                    weaker.push(index);
                } else {
                    pending.push(index);
                }
            }
        }
        let near_most: f32 = most.to_array().iter().sum();
        let above = f64::from(near_most) * (1.0 + 1e-5) + cell.far_most;
        let lost: f32 = error.to_array().iter().sum();
        let error = cell.error + f64::from(lost) * (1.0 + 1e-4);
        let empty = above < THRESHOLD - ROUNDING;
        if !empty {
            let ends = [-half, half].map(|t| {
                let place: [f32x8; 3] =
                    core::array::from_fn(|i| piece.origin[i] + piece.direction[i] * t);
                place
            });
            for &index in &weaker {
                let point = &self.points[cell.near[index as usize] as usize];
                let place = work.places[index as usize].map(f32x8::splat);
                for (sum, end) in weak.iter_mut().zip(&ends) {
                    let [x, y, z]: [f32x8; 3] = core::array::from_fn(|i| end[i] - place[i]);
                    let square = f32x8::splat(point.scale * point.scale);
                    let inverse =
                        f32x8::splat(1.0) / (softening + square * (x * x + y * y + z * z));
                    let value = f32x8::splat(point.amplitude) * self.decay(inverse);
                    let [dx, dy, dz] = piece.direction;
                    let pace = x * dx + y * dy + z * dz;
                    sum[0] += value;
                    sum[1] -= value * inverse * square * pace;
                }
            }
            work.evaluations += 16 * weaker.len() as u64;
            let direction = piece.direction;
            let from = piece.origin.map(|x| -x);
            for &index in &pending {
                let point = &self.points[cell.near[index as usize] as usize];
                let place = work.places[index as usize];
                let middle = core::array::from_fn(|i| f32x8::splat(place[i]) + from[i]);
                work.intervals.push(RayInterval {
                    from: f32::NEG_INFINITY,
                    to: f32::INFINITY,
                    blob: work.blobs.len() as u32,
                });
                work.blobs.push(RayBlob {
                    on_ray: point.blob.on_ray(middle, direction),
                    strong: point.strong,
                    index,
                });
            }
        }
        (work.strong, work.weak) = (pending, weaker);
        if empty {
            return None;
        }
        let slope = f32x8::splat(self.power as f32);
        let [[a, da], [b, db]] = weak;
        Some((piece.backdrop([a, da * slope, b, db * slope]), error))
    }

    /// The kernel, given `1/(ε² + u²)`.
    #[inline(always)]
    fn decay(&self, inverse: f32x8) -> f32x8 {
        match self.power {
            1 => inverse.sqrt(),
            2 => inverse,
            3 => inverse * inverse.sqrt(),
            _ => inverse * inverse,
        }
    }

    /// Estimates where rays cross: where they enter a point's own surface, and a little before.
    fn guess(&self, piece: &Piece<'_>, work: &FarWork) -> (f32x8, f32x8) {
        let far = f32x8::splat(f32::INFINITY);
        let start = f32x8::splat(-piece.half as f32);
        let (mut guess, mut first) = (far, far);
        for blob in &work.blobs {
            let point = &self.points[piece.cell.near[blob.index as usize] as usize];
            let [core, out] = blob.on_ray.within(f32x8::splat(point.core));
            let inside = start.simd_le(core) & core.simd_le(out) & core.simd_lt(guess);
            first = inside.select(core - f32x8::splat(point.lead), first);
            guess = inside.select(core, guess);
        }
        (guess, first)
    }

    /// Repeats the search on the doubtful intervals of rays, in double precision and with all points.
    #[cold]
    #[inline(never)]
    fn isolate(
        &self,
        sight: BoundedTerms<'_>,
        piece: &Piece<'_>,
        query: &FarQuery<'_>,
        marched: &mut Marched,
        resolution: f64,
        work: &mut FarWork,
    ) {
        let [first, last] = marched.doubt.map(f32x8::to_array);
        let mut t = marched.t.to_array();
        let mut between = marched.between.map(f32x8::to_array);
        for lane in (0..PACKET).filter(|i| marched.doubtful >> i & 1 != 0) {
            let ray = query.rays[lane];
            let along = Along {
                sight,
                ray: Ray {
                    origin: ray.at(piece.t),
                    direction: ray.direction,
                },
                resolution,
            };
            let mut isolator = RootIsolator::default();
            let all = self.first as u32..(self.first + self.points.len()) as u32;
            isolator.list.extend(all);
            let mut found = None;
            let interval = [f64::from(first[lane]), f64::from(last[lane])];
            isolator.crossings(&along, interval, |t, inside| {
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

    /// Moves hits onto the surface and samples it there. `None` if the field's error moves one of them by more than the tolerance.
    fn sample(
        &self,
        piece: &Piece<'_>,
        backdrop: &Backdrop,
        marched: &Marched,
        tolerance: f64,
        error: f64,
        work: &mut FarWork,
    ) -> Option<()> {
        let met = marched.met;
        let blobs = RayBlobs {
            blobs: &work.blobs,
            intervals: &work.intervals,
            plain: false,
        };
        let behind = Bounded::new(backdrop);
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
        let place: [f32x8; 3] = core::array::from_fn(|i| piece.origin[i] + piece.direction[i] * at);
        let local = piece.local(place);
        let scale = f32x8::splat(1.0 / piece.cell.reach() as f32);
        let jet = piece.cell.expansion.jet(local, f32x8::splat);
        let mut gradient = jet.gradient.map(|g| g * scale);
        for (number, own) in piece.cell.near.iter().zip(&work.places) {
            let point = &self.points[*number as usize];
            let jet = point
                .blob
                .jet(core::array::from_fn(|i| place[i] - f32x8::splat(own[i])));
            for (sum, part) in gradient.iter_mut().zip(jet.gradient) {
                *sum += part;
            }
        }
        work.evaluations += 8 * piece.cell.near.len() as u64;
        let steep = gradient.iter().fold(f32x8::splat(0.0), |s, g| s + *g * *g);
        let moved =
            (steep.sqrt() * f32x8::splat(tolerance as f32)).simd_lt(f32x8::splat(error as f32));
        if moved.to_bitmask() & met != 0 {
            return None;
        }
        let lanes = mask(met);
        let t = at.to_array();
        for lane in (0..PACKET).filter(|i| met >> i & 1 != 0) {
            work.flesh.t[lane] = piece.t + f64::from(t[lane]);
        }
        for (own, new) in work.flesh.gradient.iter_mut().zip(gradient) {
            *own = lanes.select(new, *own);
        }
        Some(())
    }
}

impl<'a> Piece<'a> {
    fn new(cell: &'a Cell, beam: &Beam, rays: &[Ray; PACKET], [from, to]: [f64; 2]) -> Self {
        let t = 0.5 * (from + to);
        let middle = beam.axis.at(t);
        let at = rays.map(|ray| ray.at(t) - middle);
        Self {
            cell,
            middle,
            t,
            half: 0.5 * (to - from),
            width: beam.width(to) + beam.lag(to),
            axis: beam.axis.direction.as_vec3().to_array().map(f32x8::splat),
            origin: core::array::from_fn(|k| f32x8::from_lanes(|i| at[i][k])),
            direction: core::array::from_fn(|k| f32x8::from_lanes(|i| rays[i].direction[k])),
        }
    }

    /// Converts a place relative to the middle to the coordinates of the cell's expansion.
    fn local(&self, place: [f32x8; 3]) -> [f32x8; 3] {
        let scale = 1.0 / self.cell.reach();
        let shift = ((self.middle - self.cell.center) * scale)
            .as_vec3()
            .to_array();
        let scale = f32x8::splat(scale as f32);
        core::array::from_fn(|i| f32x8::splat(shift[i]) + place[i] * scale)
    }

    /// The cell's polynomial along the rays, plus the Hermite cubic with values and slopes at the piece's two ends.
    fn backdrop(&self, [a, da, b, db]: [f32x8; 4]) -> Backdrop {
        let scale = f32x8::splat((self.half / self.cell.reach()) as f32);
        let mut coefficients = self.cell.expansion.along(
            self.local(self.origin),
            self.direction.map(|x| x * scale),
            f32x8::splat,
        );
        // On −1 ≤ x ≤ 1, slopes by x.
        let half = f32x8::splat(self.half as f32);
        let (da, db) = (da * half, db * half);
        let quarter = f32x8::splat(0.25);
        let cubic = [
            quarter * (a + a + b + b + da - db),
            quarter * (f32x8::splat(3.0) * (b - a) - da - db),
            quarter * (db - da),
            quarter * (a - b + da + db),
        ];
        for (own, more) in coefficients.iter_mut().zip(cubic) {
            *own += more;
        }
        const { assert!(DEGREE == 5) };
        Backdrop {
            coefficients,
            half: self.half as f32,
        }
    }
}

/// Returns the parameter, beyond t, at which a ray leaves a cell that it is in at t.
fn leaves(axis: &Ray, t: f64, cell: &Cell) -> f64 {
    let mut end = f64::INFINITY;
    for i in 0..3 {
        let pace = axis.direction[i];
        let wall = cell.center[i] + if pace < 0.0 { -cell.half } else { cell.half };
        let there = (wall - axis.origin[i]) / pace;
        // Never for a ray along the wall.
        if there < end {
            end = there;
        }
    }
    // Rounding may leave the start a little outside.
    end.at_least(t + 1e-6 * cell.half)
        .at_most(t + 3.5 * cell.half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soft::Soft;
    use crate::tests::common::{Numbers, clothe, element, empty, soft};
    use field::Kernel;
    use scene::{Element, Shape};

    /// Balls in a cloud, in the scene's own places.
    fn cloud(kernel: Kernel, count: u32, numbers: &mut Numbers) -> Soft {
        let mut scene = empty();
        clothe(&mut scene, vec![soft(-4.0, 1.0)]);
        for _ in 0..count {
            let shape = Shape::Sphere {
                center: numbers.vector(),
                radius: numbers.between(0.02, 0.07),
            };
            scene.elements.push(Element {
                kernel,
                ..element(shape, 0)
            });
        }
        let surfaces = scene.soft_surfaces();
        let mut soft = Soft::new(scene, surfaces);
        soft.pixel = 2e-3;
        soft
    }

    /// Packets of rays take this way, and meet what single rays meet that are traced exactly.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn packets_meet_what_exact_rays_meet() {
        let mut numbers = Numbers(21);
        for kernel in [Kernel::Cauchy, Kernel::Squared, Kernel::Cubed] {
            let soft = cloud(kernel, 200, &mut numbers);
            let mut work = FarWork::default();
            let (mut taken, mut hits, mut differ) = (0, 0, 0);
            for _ in 0..60 {
                let eye = numbers.vector().normalize() * 4.0;
                let aim = numbers.vector() * 0.9;
                let rays: [Ray; PACKET] = core::array::from_fn(|_| Ray {
                    origin: eye,
                    direction: (aim + numbers.vector() * 4e-3 - eye).normalize(),
                });
                let limits = [f64::INFINITY; PACKET];
                let met = soft.far_first(0, &rays, &limits, 255, Quest::First, &mut work);
                let entered = soft.far_first(0, &rays, &limits, 255, Quest::Entry, &mut work);
                let Some(met) = met else { continue };
                taken += 1;
                // Rays start outside. Grazing ones may be told differently, as without noise.
                let entered = entered.expect("the same way");
                differ += (entered ^ met).count_ones();
                for (lane, ray) in rays.iter().enumerate() {
                    let exact = soft.crossings(0, ray).first().copied();
                    assert_eq!(met >> lane & 1 != 0, exact.is_some(), "{kernel:?} {ray:?}");
                    let Some((t, gradient)) = exact else { continue };
                    hits += 1;
                    let flesh = &work.flesh;
                    // The second query has not changed the first one's samples.
                    let off = (flesh.t[lane] - t).abs() * gradient.dot(ray.direction).abs();
                    assert!(off < 2e-4 * gradient.length(), "{kernel:?} {off}");
                    let told = flesh.gradients()[lane];
                    assert!(told.distance(gradient) < 0.02 * gradient.length());
                }
            }
            assert!(taken > 50 && hits > 100, "{kernel:?} {taken} {hits}");
            assert!(differ <= 2, "{kernel:?} {differ}");
        }
    }

    /// A ray that starts inside is left to the general way, and an end before the surface hides it.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn starts_and_ends_of_rays_count() {
        let mut numbers = Numbers(4);
        let soft = cloud(Kernel::Cauchy, 100, &mut numbers);
        let center = soft.primitives[0].blob_middle();
        let mut work = FarWork::default();
        let mut first = |origin: DVec3, limit: f64| {
            let ray = Ray {
                origin,
                direction: DVec3::X,
            };
            soft.far_first(
                0,
                &[ray; PACKET],
                &[limit; PACKET],
                255,
                Quest::First,
                &mut work,
            )
        };
        assert_eq!(first(center, f64::INFINITY), None);
        let outside = DVec3::new(-5.0, center.y, center.z);
        assert_eq!(first(outside, f64::INFINITY), Some(255));
        assert_eq!(first(outside, 1.0), Some(0));
    }
}
