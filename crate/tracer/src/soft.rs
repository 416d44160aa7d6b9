//! The soft surface, made ready: which primitives a beam can meet, where its rays hit, and what
//! the surface is like there.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::hierarchy::Hierarchy;
use crate::lanes::Lanes;
use crate::nearby::{Near, Nearby};
use crate::quick::{LEFT_OUT, Quick};
use crate::ray::Ray;
use crate::roots::bracketed;
use crate::slabs::{Precision, Slabs};
use crate::walk::{Bundle, Found, Memories, Quest, Walk};
use field::{Bound, Primitive, Real, THRESHOLD};
use glam::DVec3;
use scene::Scene;
use wide::f32x8;

/// Rays of one packet.
pub const PACKET: usize = 8;

/// The soft surface of a scene.
pub struct Soft {
    primitives: Vec<Primitive>,
    /// Material of each primitive.
    material: Vec<u32>,
    bounds: Vec<Bound>,
    tree: Hierarchy,
    /// Primitives without a bounding ball.
    everywhere: Vec<u32>,
    /// What is left out of a lump's field.
    left_out: f64,
    /// How exactly pictures follow the surface.
    pub precision: Precision,
    /// The width of a pixel at distance 1.
    pub pixel: f64,
}

/// Rays from infinitely wide primitives are followed this far (in units of the scene's size).
const FAR: f64 = 1e4;

/// Scratch space that is worth keeping between packets.
#[derive(Default)]
pub struct Scratch {
    memory: Memories<f32x8>,
    active: Vec<u32>,
    stamps: Vec<u32>,
    stamp: u32,
    pub(crate) quick: Quick,
    /// Evaluations of one primitive's field at one point, so far.
    pub evaluations: u64,
    /// Those of them that were made for one ray alone.
    pub alone: [u64; PACKET],
}

/// What the surface is like at the hits of a packet.
#[derive(Default)]
pub struct Flesh {
    /// Ray parameter of each hit, polished.
    pub t: [f64; PACKET],
    /// Gradient of the field.
    pub gradient: [DVec3; PACKET],
    /// Materials met, and each one's share of the (positive) field in every lane.
    pub weights: Vec<(u32, [f32; PACKET])>,
}

impl Flesh {
    /// From lanes side by side.
    pub fn new(t: f32x8, gradient: [f32x8; 3], weights: Vec<(u32, f32x8)>) -> Self {
        let gradient = gradient.map(f32x8::to_array);
        Self {
            t: t.to_array().map(f64::from),
            gradient: core::array::from_fn(|i| {
                DVec3::from_array([0, 1, 2].map(|k| f64::from(gradient[k][i])))
            }),
            weights: weights
                .into_iter()
                .map(|(m, w)| (m, w.to_array()))
                .collect(),
        }
    }
}

impl Soft {
    /// Collects a scene's soft elements.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let surface = scene.soft_surface();
        let material = surface
            .element
            .iter()
            .map(|&e| scene.elements[e].material as u32)
            .collect();
        let primitives = surface.field.primitives;
        let bounds: Vec<Bound> = primitives.iter().map(Bound::new).collect();
        let left_out = LEFT_OUT * THRESHOLD / primitives.len().max(1) as f64;
        let mut balls = Vec::new();
        let mut everywhere = Vec::new();
        for (i, p) in primitives.iter().enumerate() {
            match p.bounding_sphere() {
                Some(ball) => {
                    let (center, radius) = match p.lump::<f32>() {
                        Some(lump) => (p.lump_middle(), lump.radius(lump.reach(left_out))),
                        None => ball,
                    };
                    balls.push((i as u32, center, radius));
                }
                None => everywhere.push(i as u32),
            }
        }
        Self {
            primitives,
            material,
            bounds,
            tree: Hierarchy::new(balls),
            everywhere,
            left_out,
            precision: Precision::PICTURE,
            pixel: 1.0,
        }
    }

    /// Whether there is no soft surface at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.primitives.is_empty()
    }

    /// Calls `f` with each primitive that a ray may meet within its depth of influence, the
    /// primitive's bounds and its material, in no order.
    pub fn along<'a>(&'a self, ray: &Ray, mut f: impl FnMut(&'a Primitive, &'a Bound, u32)) {
        let mut give = |i: u32| {
            let i = i as usize;
            f(&self.primitives[i], &self.bounds[i], self.material[i]);
        };
        self.everywhere.iter().for_each(|&i| give(i));
        self.tree.search(&Beam::of_ray(*ray), |i, _, _| give(i));
    }

    /// The slabs of a beam, up to a parameter; with them the parameter at which the first starts
    /// to count. `None` if no primitive reaches the beam, or all together never reach T.
    ///
    /// `beams` divides the beam, given the parameter at which to start.
    pub fn slabs<'a>(
        &'a self,
        beam: Beam,
        beams: impl FnOnce(f64) -> Beams<'a>,
        limit: f64,
    ) -> Option<(Slabs<'a>, f64)> {
        if !(beam.axis.origin.is_finite() && beam.axis.direction.is_finite()) {
            return None;
        }
        let mut list = self.everywhere.clone();
        let mut range = if list.is_empty() {
            [f64::INFINITY, 0.0]
        } else {
            [0.0, FAR]
        };
        self.tree.search(&beam, |i, center, radius| {
            let [near, far] = beam.reach(center, radius);
            if near < limit {
                list.push(i);
                range = [range[0].min(near), range[1].max(far)];
            }
        });
        let [from, to] = [range[0], range[1].min(limit)];
        if list.is_empty() || from.is_nan() || to.is_nan() || from >= to {
            return None;
        }
        list.sort_unstable();
        // Parameters are counted from where the first primitive starts to count, so that single
        // precision does not lose digits to a distant eye.
        let range = [0.0, to - from];
        let slabs = Slabs::new(&self.bounds, list, beams(from), range, self.precision);
        (slabs.slab(slabs.root()).above >= THRESHOLD).then_some((slabs, from))
    }

    /// Lists the lumps near a beam, up to a parameter. False if the beam meets anything else.
    pub fn list_lumps(&self, beam: &Beam, limit: f64, list: &mut Nearby) -> bool {
        let finite = beam.axis.origin.is_finite() && beam.axis.direction.is_finite();
        if !self.everywhere.is_empty() || !finite {
            return false;
        }
        let mut found = Vec::new();
        let mut plain = true;
        self.tree.search(beam, |i, center, radius| {
            let near = beam.reach(center, radius)[0];
            if near < limit && plain {
                match self.primitives[i as usize].lump() {
                    Some(lump) => found.push((near, i, radius, lump)),
                    None => plain = false,
                }
            }
        });
        if !plain {
            return false;
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let base = found.first().map_or(0.0, |lump| lump.0);
        list.begin(beam.axis.at(base), base);
        for (_, i, radius, lump) in found {
            let square = lump.reach(self.left_out);
            let middle = self.primitives[i as usize].lump_middle() - list.middle;
            let near = Near {
                lump,
                middle: middle.as_vec3().to_array(),
                square: square as f32,
                // A little inside, so that rounding does not put it outside.
                core: lump.core(square, self.left_out) as f32 - 1e-4,
                material: self.material[i as usize],
            };
            list.push(near, radius);
        }
        true
    }

    /// Walks a bundle through the slabs of its beam.
    pub fn walk(
        &self,
        slabs: &mut Slabs<'_>,
        bundle: Bundle<'_>,
        quest: Quest,
        scratch: &mut Scratch,
    ) -> Vec<Found> {
        slabs.tidy();
        let (found, evaluations) = Walk::<f32x8>::new(
            &self.primitives,
            &self.bounds,
            slabs,
            bundle,
            quest,
            &mut scratch.memory,
        )
        .run();
        scratch.evaluations += evaluations;
        found
    }

    /// Moves the hits of a packet onto the exact surface, and says what it is like there. Lanes
    /// without a hit carry no meaning.
    pub fn flesh(
        &self,
        slabs: &Slabs<'_>,
        rays: &[Ray],
        found: &[Found],
        scratch: &mut Scratch,
    ) -> Flesh {
        // All primitives that count for any of the hits.
        scratch.stamps.resize(self.primitives.len(), 0);
        scratch.stamp = scratch.stamp.wrapping_add(1);
        if scratch.stamp == 0 {
            scratch.stamps.fill(0);
            scratch.stamp = 1;
        }
        scratch.active.clear();
        let mut t = [0.0; PACKET];
        let mut reach = [0.0; PACKET];
        let mut known = [u32::MAX; PACKET];
        for hit in found {
            t[hit.lane] = hit.t;
            let slab = slabs.slab(hit.slab);
            reach[hit.lane] = slab.to - slab.from;
            if known.contains(&hit.slab) {
                continue;
            }
            known[hit.lane] = hit.slab;
            slabs.each(hit.slab, |local| {
                let p = slabs.primitive(local);
                let stamp = &mut scratch.stamps[p as usize];
                if *stamp != scratch.stamp {
                    *stamp = scratch.stamp;
                    scratch.active.push(p);
                }
            });
        }
        scratch.active.sort_unstable();

        let ray = |i: usize| &rays[i.min(rays.len() - 1)];
        let origin: [f32x8; 3] = core::array::from_fn(|k| f32x8::from_lanes(|i| ray(i).origin[k]));
        let direction: [f32x8; 3] =
            core::array::from_fn(|k| f32x8::from_lanes(|i| ray(i).direction[k]));
        let start = f32x8::from_lanes(|i| t[i]);
        let furthest = f32x8::from_lanes(|i| reach[i]);
        let mut at = start;
        let mut weights: Vec<(u32, f32x8)> = Vec::new();
        let mut gradient = [f32x8::splat(0.0); 3];
        let lanes = |settled: bool| {
            let some = found.iter().filter(|hit| hit.settled == settled);
            some.fold(0, |m, hit| m | 1u32 << hit.lane)
        };
        // What is settled stays where it is.
        let met = lanes(false);
        let stays = lanes(true);
        let free = f32x8::from_lanes(|i| f64::from(1 - (stays >> i & 1)));
        for _ in 0..MOST_POLISHING {
            let point = core::array::from_fn(|k| origin[k] + direction[k] * at);
            let mut value = f32x8::splat(0.0);
            gradient = [f32x8::splat(0.0); 3];
            weights.clear();
            for &p in &scratch.active {
                let jet = self.primitives[p as usize].jet(point);
                value += jet.value;
                for (sum, part) in gradient.iter_mut().zip(jet.gradient) {
                    *sum += part;
                }
                let positive = Real::max(jet.value, f32x8::splat(0.0));
                let material = self.material[p as usize];
                match weights.last_mut() {
                    Some((m, w)) if *m == material => *w += positive,
                    _ => weights.push((material, positive)),
                }
            }
            scratch.evaluations += (scratch.active.len() * PACKET) as u64;
            let slope = gradient[0] * direction[0]
                + gradient[1] * direction[1]
                + gradient[2] * direction[2];
            let excess = value - f32x8::splat(THRESHOLD as f32);
            let step = -excess / slope;
            // Newton's step; where the ray only grazes the surface it may lead astray, and then
            // the spans' crossing is kept.
            let low = Real::max(start - furthest, f32x8::splat(0.0));
            let next = at + step;
            let good = next.simd_le(start + furthest)
                & next.simd_ge(low)
                & free.simd_gt(f32x8::splat(0.0));
            at = good.bitselect(next, at);
            let off = f32x8::splat(NEAR_ENOUGH).less(excess.abs());
            if off & met == 0 {
                break;
            }
        }
        let mut flesh = Flesh::new(at, gradient, weights);
        for (i, own) in flesh.t.iter_mut().enumerate() {
            if stays >> i & 1 != 0 {
                *own = t[i];
            }
        }
        flesh
    }

    /// All crossings of a ray, exactly: where the whole field, with nothing cut off, equals T.
    /// Pairs (t, gradient), in order of t > 0.
    #[must_use]
    pub fn crossings(&self, ray: &Ray) -> Vec<(f64, DVec3)> {
        let count = self.primitives.len();
        if count == 0 {
            return Vec::new();
        }
        // Beyond the distance where each primitive is below T/n the sum is below T.
        let beam = Beam::of_ray(*ray);
        let share = THRESHOLD / count as f64;
        let mut range = [f64::INFINITY, 0.0f64];
        for (p, bound) in self.primitives.iter().zip(&self.bounds) {
            let [near, far] = match p.bounding_sphere() {
                Some((center, radius)) => {
                    let skeleton = radius - bound.influence;
                    beam.reach(center, skeleton + bound.distance_of(share))
                }
                None => [0.0, FAR],
            };
            range = [range[0].min(near), range[1].max(far)];
        }
        let [from, to] = range;
        if from.is_nan() || to.is_nan() || from >= to {
            return Vec::new();
        }
        let based = Ray {
            origin: ray.at(from),
            direction: ray.direction,
        };
        let mut slabs = Slabs::new(
            &self.bounds,
            (0..count as u32).collect(),
            Beams::one(Beam::of_ray(based)),
            [0.0, to - from],
            Precision::EXACT,
        );
        let (found, _) = Walk::<f64>::new(
            &self.primitives,
            &self.bounds,
            &mut slabs,
            Bundle {
                rays: &[based],
                limits: &[to - from],
                alive: 1,
                number: 0,
            },
            Quest::All,
            &mut Memories::default(),
        )
        .run();
        // Between neighbouring crossings the exact field has its sign; where it changes from one
        // such place to the next, there is the exact crossing.
        let excess = |t: f64| {
            let (value, gradient) = self.field(based.at(t));
            (value - THRESHOLD, gradient)
        };
        let mut places = vec![0.0];
        places.extend(found.windows(2).map(|w| 0.5 * (w[0].t + w[1].t)));
        if !found.is_empty() {
            places.push(to - from);
        }
        let mut crossings = Vec::new();
        let mut before = excess(0.0).0;
        for w in places.windows(2) {
            let after = excess(w[1]).0;
            if (before < 0.0) != (after < 0.0) {
                let t = bracketed(
                    |t| {
                        let (value, gradient) = excess(t);
                        (value, gradient.dot(ray.direction))
                    },
                    w[0],
                    w[1],
                    1e-14 * (1.0 + w[1]),
                );
                crossings.push((from + t, excess(t).1));
            }
            before = after;
        }
        crossings
    }

    /// The whole field and its gradient.
    fn field(&self, point: DVec3) -> (f64, DVec3) {
        let mut value = 0.0;
        let mut gradient = DVec3::ZERO;
        for p in &self.primitives {
            let jet = p.jet(point.to_array());
            value += jet.value;
            gradient += DVec3::from_array(jet.gradient);
        }
        (value, gradient)
    }
}

/// Evaluations at the hits. Newton's step from a place near the surface leads onto it as exactly as
/// single precision can tell, but normal and colours are those of the place the step started from.
const MOST_POLISHING: usize = 3;
/// Where the field is within this of T, normal and colours are those of the surface: they change
/// by about one part in a thousand on the way there, less than a picture shows.
pub const NEAR_ENOUGH: f32 = 1e-3;
