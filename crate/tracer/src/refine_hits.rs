//! Surface samples at a packet's hits: the refined parameter, the field's gradient, and the
//! finishes' shares.
//!
//! Spans give approximate crossings; Newton steps refine them. Shared interpolants stand for their
//! primitives if their error moves a hit by less than the tolerance; else the primitives are
//! evaluated. Where the rounding of single precision may move it by more, the last steps are in
//! double precision.
use crate::blob_march::mask;
use crate::lanes::{Lanes, spread};
use crate::layout::{PACKET, lanes_in};
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::slabs::{Slabs, Spent};
use crate::soft::Soft;
use crate::surface_samples::{FINEST, NEAR_ENOUGH, SurfaceSamples};
use crate::walk::{Bundle, Found, Quest, Walk};
use field::{Jet, Real, THRESHOLD};
use glam::DVec3;
use wide::f32x8;

/// Half the largest tolerance of pictures ([`Picture::tolerance`](crate::Picture::tolerance)).
const COARSEST_OF_SPANS: f64 = 1e-4;

/// The hits of a packet, before refinement.
struct Hits<'a> {
    slabs: &'a Slabs<'a>,
    origin: [f32x8; 3],
    direction: [f32x8; 3],
    /// Crossings of the spans.
    start: f32x8,
    /// Crossings of the spans in double precision.
    exact: [f64; PACKET],
    /// Largest distance of those crossings from the surface.
    furthest: f32x8,
    /// Slabs of the hits, each with its lanes.
    places: &'a [(u32, u32)],
    /// Lanes that hit, a bit each.
    met: u32,
    /// Lanes whose crossing is exact already, a bit each.
    isolated: u32,
}

impl Hits<'_> {
    /// Returns a part of the error of the slab in which each hit is.
    fn error(&self, part: fn(&Spent) -> f64) -> [f64; PACKET] {
        let mut off = [0.0; PACKET];
        for &(slab, lanes) in self.places {
            let own = part(&self.slabs.slab(slab).spent);
            lanes_in(lanes).for_each(|i| off[i] = own);
        }
        off
    }
}

impl Soft {
    /// Returns the crossings of a bundle with a body's surface, by traversing the slabs of its
    /// beam.
    pub fn walk(
        &self,
        body: u32,
        slabs: &mut Slabs<'_>,
        bundle: Bundle<'_>,
        quest: Quest,
        scratch: &mut Scratch,
    ) -> Vec<Found> {
        slabs.tidy();
        let sight = self.sight(&self.bodies[body as usize]);
        let (found, evaluations) =
            Walk::<f32x8>::new(sight, slabs, bundle, quest, &mut scratch.memory).run();
        scratch.evaluations += evaluations;
        found
    }

    /// Moves the hits of a packet onto the surface and samples it there; the result is
    /// `scratch.samples`. Lanes without a hit are meaningless. Ray parameters are counted from
    /// `base`.
    pub fn sample_hits(
        &self,
        slabs: &Slabs<'_>,
        rays: &[Ray],
        base: f64,
        found: &[Found],
        scratch: &mut Scratch,
    ) {
        let mut t = [0.0; PACKET];
        let mut reach = [0.0; PACKET];
        let mut places: [(u32, u32); PACKET] = [(0, 0); PACKET];
        let (mut different, mut met, mut isolated) = (0, 0, 0);
        for hit in found {
            let bit = 1 << hit.lane;
            met |= bit;
            isolated |= if hit.isolated { bit } else { 0 };
            t[hit.lane] = hit.t;
            let slab = slabs.slab(hit.slab);
            reach[hit.lane] = slab.to - slab.from;
            let known = &mut places[..different];
            match known.iter_mut().find(|place| place.0 == hit.slab) {
                Some(place) => place.1 |= bit,
                None => {
                    places[different] = (hit.slab, bit);
                    different += 1;
                }
            }
        }
        let [origin, direction] = spread(rays);
        let hits = Hits {
            slabs,
            origin,
            direction,
            start: f32x8::from_lanes(|i| t[i]),
            exact: t,
            furthest: f32x8::from_lanes(|i| reach[i]),
            places: &places[..different],
            met,
            isolated,
        };
        self.refine_hits(&hits, true, scratch);
        let error = hits.error(|spent| spent.shared);
        let shared = self.off(&hits, &scratch.samples, base, &error) == 0;
        if !shared {
            self.refine_hits(&hits, false, scratch);
        }
        let error = hits.error(|spent| spent.noise);
        let mut blurred = self.off(&hits, &scratch.samples, base, &error);
        if blurred != 0 {
            // The slab's bound is larger than the noise at one point of it.
            let noise = self.noise(&hits, shared, scratch);
            blurred &= self.off(&hits, &scratch.samples, base, &noise);
        }
        for &(slab, lanes) in hits.places {
            let lanes = lanes & blurred;
            if lanes == 0 {
                continue;
            }
            let mut list = Vec::new();
            hits.slabs.each(slab, true, |p| list.push(p));
            if list.len() > MOST_EXACT {
                continue;
            }
            for lane in lanes_in(lanes) {
                let t = &mut scratch.samples.t[lane];
                *t = self.refine_exactly(&hits, &rays[lane.min(rays.len() - 1)], lane, *t, &list);
                scratch.evaluations += (list.len() * MOST_POLISHING) as u64;
            }
        }
    }

    /// Returns the hits that an error of the field may move by more than half the tolerance, a bit
    /// each.
    fn off(
        &self,
        hits: &Hits<'_>,
        samples: &SurfaceSamples,
        base: f64,
        error: &[f64; PACKET],
    ) -> u32 {
        let gradients = samples.gradients();
        (0..PACKET).fold(0, |all, i| {
            let tolerance = 0.1 * self.pixel * (base + samples.t[i]);
            let most = tolerance.clamp(FINEST, COARSEST_OF_SPANS) * gradients[i].length();
            // NaN counts as off.
            let near = error[i] <= most;
            all | u32::from(!near) << i & hits.met & !hits.isolated
        })
    }

    /// Bounds the rounding error of the field at each hit, with shared interpolants or with all
    /// primitives.
    #[cold]
    #[inline(never)]
    fn noise(&self, hits: &Hits<'_>, shared: bool, scratch: &mut Scratch) -> [f64; PACKET] {
        let rounding = self.precision.rounding as f32;
        let at = f32x8::from_lanes(|i| scratch.samples.t[i]);
        let point: [f32x8; 3] = core::array::from_fn(|k| hits.origin[k] + hits.direction[k] * at);
        let furthest = point
            .iter()
            .fold(f32x8::splat(1.0), |most, x| most.fast_max(x.abs()));
        let misplaced = f32x8::splat(rounding) * (furthest + at);
        let mut noise = f32x8::splat(0.0);
        let mut add = |value: f32x8, [x, y, z]: [f32x8; 3], cancels: f64, lanes: u32| {
            let steep = (x * x + y * y + z * z).sqrt();
            let value = f32x8::splat(4.0) * value.abs() + f32x8::splat(2.0 * cancels as f32);
            noise += (f32x8::splat(rounding) * value + misplaced * steep) & mask(lanes);
        };
        for &(p, lanes) in &scratch.active.list {
            let jet: Jet<f32x8> = self.primitives[p as usize].jet(point);
            let cancels = self.bounds()[p as usize].cancels();
            add(jet.value, jet.gradient, cancels, lanes);
        }
        for &(slab, lanes) in hits.places.iter().filter(|_| shared) {
            hits.slabs.each_block(slab, |block| {
                let (value, gradient) = block.total.jet(block.cell.local(point));
                add(value, block.cell.world(gradient), 0.0, lanes);
            });
        }
        scratch.evaluations += (scratch.active.list.len() * PACKET) as u64;
        noise.to_array().map(f64::from)
    }

    /// Refines a hit on the surface of some primitives by Newton steps in double precision. Returns
    /// `start` if no step improves it.
    #[cold]
    fn refine_exactly(
        &self,
        hits: &Hits<'_>,
        ray: &Ray,
        lane: usize,
        start: f64,
        list: &[u32],
    ) -> f64 {
        let furthest = f64::from(hits.furthest.to_array()[lane]);
        let (mut best, mut nearest) = (start, f64::INFINITY);
        let mut t = start;
        for _ in 0..MOST_POLISHING {
            let point = ray.at(t).to_array();
            let (mut excess, mut slope) = (-THRESHOLD, 0.0);
            for &p in list {
                let jet = self.primitives[p as usize].jet(point);
                excess += jet.value;
                slope += DVec3::from_array(jet.gradient).dot(ray.direction);
            }
            if excess.abs() >= nearest {
                break;
            }
            (best, nearest) = (t, excess.abs());
            t -= excess / slope;
            if (t - hits.exact[lane]).abs() > furthest || t < 0.0 || t.is_nan() {
                break;
            }
        }
        best
    }

    /// Refines and samples the hits, with shared interpolants or with all primitives.
    fn refine_hits(&self, hits: &Hits<'_>, shared: bool, scratch: &mut Scratch) {
        let Scratch {
            active, samples, ..
        } = scratch;
        active.collect(hits.slabs, hits.places, !shared, self.primitives.len());
        let &Hits {
            origin,
            direction,
            start,
            furthest,
            ..
        } = hits;
        let mut at = start;
        let weights = &mut samples.weights;
        let mut gradient = [f32x8::splat(0.0); 3];
        // Hits that are exact already stay.
        let free = mask(!hits.isolated);
        for _ in 0..MOST_POLISHING {
            let point = core::array::from_fn(|k| origin[k] + direction[k] * at);
            let mut value = f32x8::splat(0.0);
            gradient = [f32x8::splat(0.0); 3];
            weights.clear();
            let mut add = |jet: Jet<f32x8>, lanes: u32, finish: u32| {
                let mask = mask(lanes);
                let own = jet.value & mask;
                value += own;
                for (sum, slope) in gradient.iter_mut().zip(jet.gradient) {
                    *sum += slope & mask;
                }
                let positive = Real::max(own, f32x8::splat(0.0));
                match weights.last_mut() {
                    Some((m, w)) if *m == finish => *w += positive,
                    _ => weights.push((finish, positive)),
                }
            };
            for &(p, lanes) in &active.list {
                let jet = self.primitives[p as usize].jet(point);
                add(jet, lanes, self.finish[p as usize]);
            }
            for &(slab, lanes) in hits.places.iter().filter(|_| shared) {
                hits.slabs.each_block(slab, |block| {
                    let local = block.cell.local(point);
                    for (finish, shared) in &block.of_each {
                        let (value, gradient) = shared.jet(local);
                        let gradient = block.cell.world(gradient);
                        add(Jet { value, gradient }, lanes, *finish);
                    }
                });
            }
            scratch.evaluations += (active.list.len() * PACKET) as u64;
            let slope = gradient[0] * direction[0]
                + gradient[1] * direction[1]
                + gradient[2] * direction[2];
            let excess = value - f32x8::splat(THRESHOLD as f32);
            let step = -excess / slope;
            // A Newton step, unless it leaves the bracket, as at grazing rays.
            let low = Real::max(start - furthest, f32x8::splat(0.0));
            let next = at + step;
            let good = next.simd_le(start + furthest) & next.simd_ge(low) & free;
            at = good.select(next, at);
            let off = f32x8::splat(NEAR_ENOUGH).less(excess.abs());
            if off & hits.met & !hits.isolated == 0 {
                break;
            }
        }
        samples.gradient = gradient;
        samples.t = at.to_array().map(f64::from);
        for (i, own) in samples.t.iter_mut().enumerate() {
            if hits.isolated >> i & 1 != 0 {
                *own = hits.exact[i];
            }
        }
    }
}

/// Most evaluations at a hit. A Newton step from near the surface is exact to single precision, but
/// normal and colours are those of its start.
const MOST_POLISHING: usize = 3;
/// Most primitives with which hits are refined in double precision.
const MOST_EXACT: usize = 1 << 16;
