//! The fast path to the soft surface, for packets near nothing but blobs: points, Gaussian
//! segments, and blob chains.
//!
//! The blobs near a square of pixels are listed once, those near each of its parts when a packet
//! there first needs them, those near a packet for each; then [`march`](crate::blob_march::march)
//! follows the packet's rays.
use crate::beam::Beam;
use crate::blob_march::{MarchRays, Marched, RayBlob, RayBlobs, RayInterval, extremes, march};
use crate::lanes::least;
use crate::layout::{PACKET, lanes_in};
use crate::nearby::{Marks, Nearby, indices_of};
use crate::ray::Ray;
use crate::soft::Soft;
use crate::surface_samples::{COARSEST_OF_BLOBS, FINEST, NEAR_ENOUGH, SurfaceSamples};
use crate::walk::Quest;
use field::{Cut, Real};
use glam::DVec3;
use wide::f32x8;

/// Largest part of the field, in T, that the lists of a square's parts leave out.
pub const LEFT_OUT_OF_PARTS: f32 = 3e-6;
/// Largest part of the field, in T, that a packet's list leaves out of its part's.
const LEFT_OUT_OF_PACKETS: f32 = 5e-6;

/// Fraction of the way from a blob's own surface to the end of its reach, in squared distances, up
/// to which it is strong.
const STRONG: f32 = 0.15;

/// Working space of one thread.
#[derive(Default)]
pub struct Quick {
    blobs: Vec<RayBlob>,
    intervals: Vec<RayInterval>,
    /// Whether all blobs are Gaussian points.
    plain: bool,
    /// Working space of [`march`].
    tops: Vec<f32x8>,
    pub(crate) list: Nearby,
    marks: Marks,
    /// Blobs near a packet, without those of excluded bodies: body and index, in one number that
    /// orders them so.
    members: Vec<u64>,
    /// Surface samples at the hits of the last packet; parameters are counted from its list's base.
    pub samples: SurfaceSamples,
}

/// The parts of a packet's rays within the reach of blobs.
struct Reached {
    /// First parameter of each ray; infinite without blobs.
    from: f32x8,
    /// Last parameter of each ray; minus infinite without blobs.
    to: f32x8,
    /// Estimate of the crossing ([`MarchRays::guess`]).
    guess: f32x8,
    /// End of the first step ([`MarchRays::first`]).
    first: f32x8,
    /// Largest [`NearBlob::steep`](crate::nearby::NearBlob::steep).
    steepest: f32,
    evaluations: u64,
}

impl Quick {
    fn ray_blobs(&self) -> RayBlobs<'_> {
        RayBlobs {
            blobs: &self.blobs,
            intervals: &self.intervals,
            plain: self.plain,
        }
    }

    /// Collects those of some blobs of a list, given in its order, that the rays meet, without
    /// those that all rays meet only inside of others.
    #[inline(always)]
    fn collect(
        &mut self,
        near: &Nearby,
        indices: impl Iterator<Item = usize>,
        rays: &Rays,
        limits: &[f64; PACKET],
        alive: u32,
    ) -> Reached {
        let far = f32x8::splat(f32::INFINITY);
        let (mut from, mut to, mut guess, mut first) = (far, -far, far, far);
        let mut evaluations = 0;
        self.blobs.clear();
        self.intervals.clear();
        self.plain = true;
        let limit = f32x8::from_lanes(|i| (limits[i] - near.base).at_most(1e30));
        // Each ray is certainly inside at `sure`, and all of them at `hidden`.
        let (mut sure, mut hidden) = (far, f32::INFINITY);
        // The same in all lanes: a scalar maximum compiles to a branch in wasm.
        let mut steepest = f32x8::splat(0.0);
        for index in indices {
            let near = near.get(index);
            // Blobs from here on are met only inside of others.
            if near.from > hidden {
                break;
            }
            let middle = core::array::from_fn(|i| f32x8::splat(near.middle[i]) - rays.origin[i]);
            let on_ray = near.blob.on_ray(middle, rays.direction);
            let [enters, leaves] = on_ray.within(f32x8::splat(near.square));
            let enters = enters.fast_max(f32x8::splat(0.0));
            let leaves = leaves.fast_min(limit);
            let meets = enters.simd_le(leaves);
            evaluations += 8;
            if meets.to_bitmask() & alive == 0 {
                continue;
            }
            let step_from = meets.select(enters, far);
            let step_to = meets.select(leaves, -far);
            from = from.fast_min(step_from);
            to = to.fast_max(step_to);
            let strong = near.core + STRONG * (near.square - near.core);
            let [core, out] = on_ray.within(f32x8::splat(near.core));
            let inside = meets & enters.simd_le(core) & core.simd_le(out);
            if inside.any() {
                let core = inside.select(core, far);
                first = core
                    .simd_lt(guess)
                    .select(core - f32x8::splat(near.lead), first);
                guess = guess.fast_min(core);
                // A segment's field may be below T at its core.
                let certain = if near.part {
                    far
                } else if near.blob.is_segment() {
                    let inside = f32x8::splat(1.0).simd_lt(on_ray.at(core).0);
                    inside.select(core, far)
                } else {
                    core
                };
                sure = sure.fast_min(certain);
                hidden = extremes(sure, sure, alive).1;
            }
            let steep = f32x8::splat(near.steep);
            steepest = steepest.simd_lt(steep).select(steep, steepest);
            self.plain &= on_ray.is_gaussian_point();
            self.intervals.push(RayInterval {
                from: least(step_from),
                to: -least(-step_to),
                blob: self.blobs.len() as u32,
            });
            self.blobs.push(RayBlob {
                on_ray,
                strong,
                index: index as u32,
            });
        }
        Reached {
            from,
            to,
            guess,
            first,
            steepest: steepest.to_array()[0],
            evaluations,
        }
    }
}

/// Result of a packet's query for one body.
#[derive(Clone, Copy, Default)]
pub struct Looked {
    /// The body.
    pub body: u32,
    /// Rays that met the surface, a bit each.
    pub met: u32,
    /// Evaluations of blobs, for one ray each.
    pub evaluations: u64,
}

/// Largest number of Newton steps from a packet's hits onto the surface.
const MOST_REFINING: usize = 12;
/// Rounding of the field near T in single precision.
const FIELD_ROUNDING: f32 = 2e-6;
/// Largest error of the field, in T: everything that lists leave out, primitives that are no blobs,
/// the error of blob chains, and rounding.
const LOST: f32 = 2.5e-5;
/// Largest noise that is allowed for; tiny, distant blobs would need more.
const NOISIEST: f32 = 2e-3;
/// Length, in units of the scene, of the parts in which doubtful intervals are isolated.
const DOUBT_PART: f64 = 1.0 / 16.0;
/// Most parts in which a doubtful interval is isolated.
const MOST_DOUBT_PARTS: f64 = 256.0;
/// Rounding of positions, relative to the scene's size plus the distance.
const MISPLACED: f32 = 3e-7;
/// Most blobs near a packet; beyond that it takes the general way, which needs less space for each.
const MOST_NEAR_BLOBS: usize = 1 << 16;

/// Rays of a packet, with parameters counted from a list's base.
pub struct Rays {
    /// Starts of the rays, relative to the list's middle.
    pub origin: [f32x8; 3],
    /// Unit directions.
    pub direction: [f32x8; 3],
    /// A beam around them.
    pub beam: Beam,
}

impl Rays {
    /// Converts rays from double precision.
    #[must_use]
    pub fn new(rays: &[Ray; PACKET], near: &Nearby) -> Self {
        let start = rays.map(|ray| ray.at(near.base) - near.middle);
        let origin = core::array::from_fn(|k| f32x8::from_lanes(|i| start[i][k]));
        let direction = core::array::from_fn(|k| f32x8::from_lanes(|i| rays[i].direction[k]));
        let (offset, radius) = around(origin);
        let (mean, spread) = around(direction);
        // The mean of unit vectors is shorter than one.
        let axis = mean.try_normalize().unwrap_or(rays[0].direction);
        let spread = spread + axis.distance(mean);
        let beam = Beam {
            axis: Ray {
                origin: near.middle + offset,
                direction: axis,
            },
            radius,
            spread,
            ahead: radius,
        };
        Self {
            origin,
            direction,
            beam,
        }
    }
}

/// A query for a packet's rays.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'l> {
    /// End of each ray.
    pub limits: &'l [f64; PACKET],
    /// The rays to follow, a bit each.
    pub alive: u32,
    /// Kind of crossing to find.
    pub quest: Quest,
}

impl<'l> Asked<'l> {
    /// Returns the query for the first crossing of each ray of some lanes.
    pub fn first(limits: &'l [f64; PACKET], alive: u32) -> Self {
        Self {
            limits,
            alive,
            quest: Quest::First,
        }
    }
}

/// Returns the body of a member of [`Quick::members`].
fn body_of(member: &u64) -> u32 {
    (member >> 32) as u32
}

/// Returns the index in the list of a member of [`Quick::members`].
fn index_of(member: &u64) -> usize {
    (member & u64::from(u32::MAX)) as usize
}

/// Returns the mean of eight points and their largest distance from it.
fn around(places: [f32x8; 3]) -> (DVec3, f64) {
    // In the order of the lanes, which is the same everywhere.
    let middle = places.map(|x| x.to_array().iter().sum::<f32>() / PACKET as f32);
    let [x, y, z]: [f32x8; 3] = core::array::from_fn(|i| places[i] - f32x8::splat(middle[i]));
    let widest = -least(-(x * x + y * y + z * z));
    (
        DVec3::from_array(middle.map(f64::from)),
        f64::from(widest).sqrt() * 1.001 + 1e-7,
    )
}

impl Soft {
    /// Finds the first crossings of rays that make a packet of their own with the surface of a
    /// body, up to their limits; for [`Quest::Entry`] only whether there is one. `None` if the
    /// packet is near anything but blobs or the march gives up; the caller then takes the general
    /// way.
    pub fn quick_alone(
        &self,
        body: u32,
        rays: &[Ray; PACKET],
        limits: &[f64; PACKET],
        alive: u32,
        quest: Quest,
        work: &mut Quick,
    ) -> Option<(Looked, f64)> {
        let lanes = lanes_in(alive);
        let followed: Vec<Ray> = lanes.clone().map(|i| rays[i]).collect();
        let furthest = lanes.map(|i| limits[i]).fold(0.0, f64::max);
        let beam = Beam::around(&followed)?;
        let mut list = core::mem::take(&mut work.list);
        let by_blobs =
            !self.is_everywhere(body) && self.list_blobs(&beam, furthest, &mut list) && {
                let own = list.others.iter();
                let own = own.filter(|other| self.body_of(other.primitive) == body);
                !self.meets_any(own, &beam, furthest)
            };
        let looked = if by_blobs {
            let lanes = Rays::new(rays, &list);
            let asked = Asked {
                limits,
                alive,
                quest,
            };
            if self.bodies.len() == 1 {
                self.quick(&list, &lanes, &|| *rays, asked, work)
            } else {
                self.quick_of(&list, body, &lanes, &|| *rays, asked, work)
            }
        } else {
            None
        };
        let base = list.base;
        work.list = list;
        looked.map(|looked| (looked, base))
    }

    /// Finds the first crossing, from outside to inside, of the rays of a packet with the surface
    /// of the only body; for [`Quest::Entry`] only whether there is one. No other primitives may be
    /// near the rays ([`Soft::meets_any`]). `exact` returns the rays in double precision. `None` if
    /// the march gives up ([`march`]).
    pub fn quick(
        &self,
        near: &Nearby,
        rays: &Rays,
        exact: &dyn Fn() -> [Ray; PACKET],
        asked: Asked<'_>,
        work: &mut Quick,
    ) -> Option<Looked> {
        self.quick_of(near, 0, rays, exact, asked, work)
    }

    /// [`Soft::quick`] for one body of several.
    fn quick_of(
        &self,
        near: &Nearby,
        body: u32,
        rays: &Rays,
        exact: &dyn Fn() -> [Ray; PACKET],
        asked: Asked<'_>,
        work: &mut Quick,
    ) -> Option<Looked> {
        if near.len() == 0 || !near.mark(&rays.beam, LEFT_OUT_OF_PACKETS, &mut work.marks) {
            return Some(Looked::default());
        }
        let marks = core::mem::take(&mut work.marks);
        let is_only = self.bodies.len() == 1;
        let own = indices_of(&marks).filter(|&index| is_only || near.get(index).body == body);
        let looked = self.follow(near, body, own, rays, exact, asked, work);
        work.marks = marks;
        looked
    }

    /// [`Soft::quick`] for several bodies except those in `pass_over`, the nearest first as far as
    /// the list tells. Calls `tell` with each result; it returns the rays' new limits and the rays
    /// to follow from then on. Returns the bodies that need the general way.
    #[expect(clippy::too_many_arguments, reason = "they form no group")]
    pub fn quick_each(
        &self,
        near: &Nearby,
        pass_over: &[u32],
        rays: &Rays,
        exact: &dyn Fn() -> [Ray; PACKET],
        asked: Asked<'_>,
        work: &mut Quick,
        mut tell: impl FnMut(Looked, &SurfaceSamples) -> ([f64; PACKET], u32),
    ) -> Vec<u32> {
        let mut left = Vec::new();
        if near.len() == 0 || !near.mark(&rays.beam, LEFT_OUT_OF_PACKETS, &mut work.marks) {
            return left;
        }
        let mut members = core::mem::take(&mut work.members);
        members.clear();
        members.extend(
            indices_of(&work.marks)
                .map(|index| u64::from(near.get(index).body) << 32 | index as u64)
                .filter(|member| !pass_over.contains(&body_of(member))),
        );
        // Lists are in order of the parameter at which a blob may be met.
        members.sort_unstable();
        let mut groups: Vec<&[u64]> = members.chunk_by(|a, b| body_of(a) == body_of(b)).collect();
        field::heap_sort(&mut groups, |a, b| index_of(&a[0]) < index_of(&b[0]));
        let (mut limits, mut alive) = (*asked.limits, asked.alive);
        for group in groups {
            let from = f64::from(near.get(index_of(&group[0])).from) + near.base;
            if !(0..PACKET).any(|lane| alive >> lane & 1 != 0 && limits[lane] > from) {
                continue;
            }
            let asked = Asked {
                limits: &limits,
                alive,
                quest: asked.quest,
            };
            let (body, indices) = (body_of(&group[0]), group.iter().map(index_of));
            match self.follow(near, body, indices, rays, exact, asked, work) {
                Some(looked) => (limits, alive) = tell(looked, &work.samples),
                None => left.push(body),
            }
        }
        work.members = members;
        left
    }

    /// Follows rays among some blobs of a list, all of one body, given in the list's order.
    #[expect(clippy::too_many_arguments, reason = "they form no group")]
    #[inline(always)]
    fn follow(
        &self,
        near: &Nearby,
        body: u32,
        indices: impl Iterator<Item = usize>,
        rays: &Rays,
        exact: &dyn Fn() -> [Ray; PACKET],
        asked: Asked<'_>,
        work: &mut Quick,
    ) -> Option<Looked> {
        let Asked {
            limits,
            alive,
            quest,
        } = asked;
        let reached = work.collect(near, indices, rays, limits, alive);
        let Reached {
            from,
            to,
            guess,
            first,
            steepest,
            evaluations,
        } = reached;
        if work.blobs.is_empty() {
            return Some(Looked::default());
        }
        if work.blobs.len() > MOST_NEAR_BLOBS {
            return None;
        }
        work.intervals
            .sort_unstable_by(|a, b| a.from.total_cmp(&b.from).then(a.blob.cmp(&b.blob)));
        let alive = alive & from.simd_le(to).to_bitmask();
        let furthest = extremes(to, to, alive).1.at_least(0.0);
        // Shadow rays need no such accuracy, and start where the field is nearly T.
        let noise = match quest {
            Quest::Entry => 0.0,
            _ => (LOST + MISPLACED * steepest * (1.0 + furthest)).at_most(NOISIEST),
        };
        let march_rays = MarchRays {
            from,
            to,
            guess,
            first,
            alive,
            tolerance: self.tolerance(near) as f32,
            noise,
            start: None,
        };
        // Not by `ray_blobs()`, which would borrow `tops`, too.
        let blobs = RayBlobs {
            blobs: &work.blobs,
            intervals: &work.intervals,
            plain: work.plain,
        };
        let mut marched = march(blobs, &march_rays, &mut work.tops)?;
        if marched.doubtful != 0 && quest == Quest::First {
            self.isolate_doubts(near, body, &exact(), &mut marched);
        }
        if marched.met == 0 || quest == Quest::Entry {
            return Some(Looked {
                body,
                met: marched.met,
                evaluations: evaluations + marched.evaluations,
            });
        }
        let looked = self.look(near, rays, &marched, evaluations, work);
        Some(Looked { body, ..looked })
    }

    /// Repeats the search on the doubtful intervals of rays, in double precision and with all
    /// primitives.
    #[cold]
    #[inline(never)]
    fn isolate_doubts(
        &self,
        near: &Nearby,
        body: u32,
        rays: &[Ray; PACKET],
        marched: &mut Marched,
    ) {
        let [first, last] = marched.doubt.map(f32x8::to_array);
        let mut t = marched.t.to_array();
        let mut between = marched.between.map(f32x8::to_array);
        for (i, ray) in rays.iter().enumerate() {
            if marched.doubtful >> i & 1 == 0 {
                continue;
            }
            let [start, end] = [first[i], last[i]].map(f64::from);
            let based = Ray {
                origin: ray.at(near.base),
                direction: ray.direction,
            };
            let parts = ((end - start) / DOUBT_PART)
                .ceil()
                .clamp(1.0, MOST_DOUBT_PARTS);
            for part in 0..parts as u32 {
                let ends =
                    [part, part + 1].map(|part| start + (end - start) * f64::from(part) / parts);
                let (found, evaluations) = self.entry(body, based, ends);
                marched.evaluations += evaluations;
                if let Some(found) = found {
                    t[i] = found as f32;
                    // A bracket of length 0 keeps it there.
                    between.iter_mut().for_each(|end| end[i] = t[i]);
                    marched.met |= 1 << i;
                    break;
                }
            }
        }
        marched.t = f32x8::new(t);
        marched.between = between.map(f32x8::new);
    }

    /// Returns half the tolerance of pictures for the blobs of a list, none of which is nearer to
    /// the rays' origins than the list's base.
    fn tolerance(&self, list: &Nearby) -> f64 {
        (0.1 * self.pixel * list.base).clamp(FINEST, COARSEST_OF_BLOBS)
    }

    /// Moves a packet's hits onto the surface and samples it there (gradient, shares of finishes).
    fn look(
        &self,
        near: &Nearby,
        rays: &Rays,
        marched: &Marched,
        evaluations: u64,
        work: &mut Quick,
    ) -> Looked {
        let met = marched.met;
        let tolerance = self.tolerance(near) as f32;
        let mut evaluations = evaluations + marched.evaluations;
        let mut at = marched.t;
        let mut samples = core::mem::take(&mut work.samples);
        let weights = &mut samples.weights;
        let mut gradient = [f32x8::splat(0.0); 3];
        let (first, last) = extremes(at, at, met);
        let [mut low, mut high] = marched.between;
        for _ in 0..MOST_REFINING {
            let mut value = f32x8::splat(0.0);
            gradient = [f32x8::splat(0.0); 3];
            weights.clear();
            let place: [f32x8; 3] =
                core::array::from_fn(|i| rays.origin[i] + rays.direction[i] * at);
            for blob in work.ray_blobs().between(first, last) {
                let near = near.get(blob.index as usize);
                let jet = near.blob.jet(core::array::from_fn(|i| {
                    place[i] - f32x8::splat(near.middle[i])
                }));
                evaluations += 8;
                value += jet.value;
                for (sum, part) in gradient.iter_mut().zip(jet.gradient) {
                    *sum += part;
                }
                match weights.iter_mut().find(|(m, _)| *m == near.finish) {
                    Some((_, weight)) => *weight += jet.value,
                    None => weights.push((near.finish, jet.value)),
                }
            }
            let [x, y, z]: [f32x8; 3] = core::array::from_fn(|i| gradient[i] * rays.direction[i]);
            let excess = value - f32x8::splat(1.0);
            let over = excess.simd_ge(f32x8::splat(0.0));
            high = over.select(at, high);
            low = over.select(low, at);
            let newton = at - excess / (x + y + z);
            // At grazing rays a Newton step may leave the bracket.
            let good = low.simd_le(newton) & newton.simd_le(high);
            at = good.select(newton, f32x8::splat(0.5) * (low + high));
            // The distance from the surface is about the excess over the gradient's length.
            let steep = gradient
                .iter()
                .fold(f32x8::splat(0.0), |s, g| s + *g * *g)
                .sqrt();
            let allowed =
                (steep * f32x8::splat(0.5 * tolerance)).fast_min(f32x8::splat(NEAR_ENOUGH));
            let allowed = allowed.fast_max(f32x8::splat(FIELD_ROUNDING));
            if allowed.simd_lt(excess.abs()).to_bitmask() & met == 0 {
                break;
            }
        }
        field::heap_sort(weights, |a, b| a.0 < b.0);
        samples.gradient = gradient;
        samples.t = at.to_array().map(f64::from);
        work.samples = samples;
        Looked {
            body: 0,
            met,
            evaluations,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::Hierarchy;
    use field::Kernel;
    use scene::{Element, Shape};
    use trials::scenes::{clothe, element, empty, soft};

    /// The beam meets tiny balls on the rays themselves, also in packets as wide as those of
    /// `Picture::cast`.
    #[test]
    fn the_beam_of_a_packet_holds_its_outer_rays() {
        for wide in [1e-4, 2e-3, 0.05, 0.14] {
            let rays: [Ray; PACKET] = core::array::from_fn(|i| Ray {
                origin: DVec3::ZERO,
                direction: DVec3::new(
                    wide * ((i % 4) as f64 / 3.0 - 0.5),
                    wide * ((i / 4) as f64 - 0.5),
                    1.0,
                )
                .normalize(),
            });
            let list = Nearby::default();
            let beam = Rays::new(&rays, &list).beam;
            for t in [0.3, 3.0, 30.0] {
                let balls = (0..PACKET).map(|i| (i as u32, rays[i].direction * t, 1e-6));
                let tree = Hierarchy::new(balls.collect());
                let mut found = 0;
                tree.search(&beam, |_, _, _| found += 1);
                assert_eq!(found, PACKET, "{wide} {t}");
                assert!((beam.axis.direction.length() - 1.0).abs() < 1e-12);
                for ray in &rays {
                    let off = beam.axis.direction.distance(ray.direction);
                    assert!(off <= beam.spread, "{wide}: {off} {}", beam.spread);
                }
            }
        }
    }

    /// Returns a ball of radius ¼ around (0, 0, 2), in the scene's own places.
    fn ball() -> Soft {
        let mut scene = empty();
        clothe(&mut scene, vec![soft(2.0, 1.0)]);
        let center = DVec3::Z * 2.0;
        let radius = 0.25;
        scene.elements = vec![Element {
            kernel: Kernel::Gauss,
            ..element(Shape::sphere(center, radius), 0)
        }];
        let surfaces = scene.soft_surfaces();
        Soft::new(scene, surfaces)
    }

    /// Returns rays along z at growing distances from the ball's middle, of which the first four
    /// meet it, and the parameters where they enter it.
    fn rays_past_the_ball() -> ([Ray; PACKET], [Option<f64>; PACKET]) {
        let aside = [0.0, 0.1, 0.2, 0.249_999, 0.250_001, 0.26, 0.4, 2.0];
        let rays = aside.map(|x| Ray {
            origin: DVec3::new(x, 0.0, 0.0),
            direction: DVec3::Z,
        });
        let enters = aside.map(|x| (x < 0.25).then(|| 2.0 - (0.0625 - x * x).sqrt()));
        (rays, enters)
    }

    #[test]
    fn an_entry_is_found_on_a_stretch() {
        let soft = ball();
        let (rays, enters) = rays_past_the_ball();
        for (ray, enters) in rays.into_iter().zip(enters) {
            let [found, before, behind] =
                [[1.5, 2.5], [0.5, 1.5], [2.3, 9.0]].map(|s| soft.entry(0, ray, s).0);
            assert_eq!(found.is_some(), enters.is_some(), "{ray:?}");
            if let (Some(found), Some(enters)) = (found, enters) {
                assert!((found - enters).abs() < 1e-6, "{found} {enters}");
            }
            assert_eq!([before, behind], [None; 2], "{ray:?}");
        }
        // Inside already.
        assert_eq!(soft.entry(0, rays[0], [2.0, 3.0]).0, Some(2.0));
    }

    #[test]
    fn doubts_are_isolated_where_they_are() {
        let soft = ball();
        let (rays, enters) = rays_past_the_ball();
        let mut near = Nearby::default();
        near.begin(DVec3::Z * 0.5, 0.5);
        let far = f32x8::splat(9.0);
        let marched = |doubtful: u32, doubt: [f32; 2]| {
            let mut marched = Marched {
                t: far,
                between: [far; 2],
                met: 0,
                doubtful,
                // Counted from the list's base.
                doubt: doubt.map(f32x8::splat),
                evaluations: 0,
            };
            soft.isolate_doubts(&near, 0, &rays, &mut marched);
            marched
        };
        // Longer than one part.
        for doubt in [[1.2, 1.6], [0.0, 2.5]] {
            let isolated = marched(0b1111_1011, doubt);
            assert_eq!(isolated.met, 0b1011, "{doubt:?}");
            for (i, enters) in enters.into_iter().enumerate() {
                let t = isolated.t.to_array()[i];
                match enters {
                    // The third is not in doubt.
                    Some(enters) if i != 2 => assert!((f64::from(t) + 0.5 - enters).abs() < 1e-6),
                    _ => assert!((t - 9.0).abs() < 1e-6),
                }
                let ends = isolated.between.map(|end| end.to_array()[i]);
                assert_eq!(ends, [t; 2]);
            }
        }
        // Where there is nothing.
        assert_eq!(marched(0b1111_1111, [0.0, 0.9]).met, 0);
    }
}
