//! Single rays, traced as those of pictures: for callers that ask what a picture would show, and
//! for checking it.
//!
//! In pictures the packets of a square share lists, or the slabs of one beam. Here each packet has
//! its own, with the same result within the same tolerance.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::layout::{PACKET, lanes_in};
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::soft::Soft;
use crate::walk::{Bundle, Quest};
use crate::world::{Owner, World};
use glam::DVec3;
use std::collections::BTreeMap;

/// Distance of two crossings, in units of the scene's size, up to which they are at one place.
const SAME: f64 = 1e-10;

/// A crossing in units of the scene's size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cast {
    pub t: f64,
    /// The outward normal, of any length.
    pub normal: DVec3,
    pub owner: Owner,
}

impl World {
    /// Returns the first crossing, at t > 0, of each of some rays of the world. Neighbouring rays
    /// of the list make packets: the nearer together they are, the faster it goes.
    pub fn cast(&self, rays: &[(DVec3, DVec3)]) -> Vec<Option<Cast>> {
        let mut scratch = Scratch::default();
        let mut crossings = Vec::new();
        let mut found = vec![None; rays.len()];
        let mut done = 0;
        while done < rays.len() {
            let count = self.packet_length(&rays[done..]);
            let range = done..done + count;
            done += count;
            let unit: Vec<Option<Ray>> = rays[range.clone()].iter().map(|r| self.ray(r)).collect();
            let found = &mut found[range];
            let Some(any) = unit.iter().flatten().next() else {
                continue;
            };
            for (ray, found) in unit.iter().zip(&mut *found) {
                *found = ray.and_then(|ray| {
                    let (number, c) =
                        self.solids
                            .first(&ray, f64::INFINITY, self.one_sided, &mut crossings)?;
                    Some(Cast {
                        t: c.t,
                        normal: c.normal,
                        owner: Owner::Solid(number),
                    })
                });
            }
            let lane = |i: usize| unit.get(i).copied().flatten();
            let rays = core::array::from_fn(|i| lane(i).unwrap_or(*any));
            let alive = (0..PACKET).fold(0, |m, i| m | u32::from(lane(i).is_some()) << i);
            for body in 0..self.soft.bodies.len() as u32 {
                let limits = core::array::from_fn(|i| {
                    let cast = found.get(i).copied().flatten();
                    cast.map_or(f64::INFINITY, |cast: Cast| cast.t)
                });
                let soft = self.soft.first(body, &rays, &limits, alive, &mut scratch);
                for ((found, t), ray) in found.iter_mut().zip(soft).zip(&rays) {
                    if let Some(t) = t {
                        *found = Some(Cast {
                            t,
                            normal: -self.soft.gradient(body, ray, t),
                            owner: Owner::Soft(body),
                        });
                    }
                }
            }
            for (number, body) in self.others.iter().enumerate() {
                for (ray, found) in unit.iter().zip(&mut *found) {
                    let Some(ray) = ray else { continue };
                    let limit = found.map_or(f64::INFINITY, |cast: Cast| cast.t);
                    if let (Some(t), _) = body.first(ray, limit, Quest::First) {
                        *found = Some(cast(ray, t, body.gradient(ray, t), Owner::Other(number)));
                    }
                }
            }
        }
        found
    }

    /// Returns all crossings of a ray at t > 0, in order, found exactly: no primitive is cut off,
    /// no interpolant shared.
    pub fn crossings(&self, ray: &Ray) -> Vec<Cast> {
        let mut found = Vec::new();
        for (number, crossing) in self.solids.all(ray) {
            found.push(Cast {
                t: crossing.t,
                normal: crossing.normal,
                owner: Owner::Solid(number),
            });
        }
        for body in 0..self.soft.bodies.len() as u32 {
            for (t, gradient) in self.soft.crossings(body, ray) {
                found.push(cast(ray, t, gradient, Owner::Soft(body)));
            }
        }
        for (number, body) in self.others.iter().enumerate() {
            for (t, gradient) in body.all(ray) {
                found.push(cast(ray, t, gradient, Owner::Other(number)));
            }
        }
        found.retain(|cast| cast.t > 0.0);
        found.sort_by(|a, b| a.t.total_cmp(&b.t));
        // Where two bodies touch a ray leaves the one before it enters the other.
        for i in 1..found.len() {
            let [a, b] = [found[i - 1], found[i]];
            let [a_enters, b_enters] = [a, b].map(|cast| cast.normal.dot(ray.direction) < 0.0);
            if b.t - a.t <= SAME * (1.0 + b.t) && a_enters && !b_enters {
                found.swap(i - 1, i);
            }
        }
        found
    }

    /// Returns the number of rays at the start of a list that make a packet: as in pictures, a beam
    /// around them is narrow.
    fn packet_length(&self, rays: &[(DVec3, DVec3)]) -> usize {
        let Some(first) = rays.first().and_then(|r| self.ray(r)) else {
            return 1;
        };
        rays.iter()
            .take(PACKET)
            .take_while(|r| self.ray(r).is_some_and(|ray| first.runs_with(&ray)))
            .count()
            .max(1)
    }

    /// Converts a ray of the world to the unit scene; `None` if it is not finite or has no
    /// direction.
    pub fn ray(&self, (origin, direction): &(DVec3, DVec3)) -> Option<Ray> {
        let ray = Ray {
            origin: self.unit.map(*origin),
            direction: direction.try_normalize()?,
        };
        ray.origin.is_finite().then_some(ray)
    }

    /// Returns the numbers of the scene's body and of the scene's element that a crossing belongs
    /// to. On a convolution surface it is the element that adds most to the field there.
    pub fn owner(&self, cast: &Cast, ray: &Ray) -> (Option<u32>, Option<u32>) {
        match cast.owner {
            Owner::Solid(number) => (None, Some(self.solids.element(number))),
            Owner::Other(number) => {
                let body = &self.others[number];
                let mut shares = Vec::new();
                body.shares(ray.at(cast.t), &mut shares);
                let shares = shares.into_iter();
                let element = strongest(shares.map(|(element, _, share)| (element, share)));
                (Some(body.number()), element.filter(|e| *e != u32::MAX))
            }
            Owner::Soft(body) => {
                let point = ray.at(cast.t).to_array();
                let mut parts = Vec::new();
                self.soft.along(body, ray, |primitive, _, number| {
                    let element = self.soft.element[number as usize];
                    parts.push((element, primitive.value::<f64>(point)));
                });
                let number = self.soft.bodies[body as usize].number;
                (Some(number), strongest(parts.into_iter()))
            }
        }
    }
}

impl Soft {
    /// Returns where the rays of some lanes, a bit each, first cross the surface of a body before
    /// their limits: the quick way for blobs, else the far field's, else slabs of Hermite spans.
    fn first(
        &self,
        body: u32,
        rays: &[Ray; PACKET],
        limits: &[f64; PACKET],
        alive: u32,
        scratch: &mut Scratch,
    ) -> [Option<f64>; PACKET] {
        let quick = &mut scratch.quick;
        if let Some((looked, base)) =
            self.quick_alone(body, rays, limits, alive, Quest::First, quick)
        {
            let t = scratch.quick.samples.t;
            return core::array::from_fn(|i| (looked.met >> i & 1 != 0).then_some(base + t[i]));
        }
        let far = &mut scratch.far;
        if let Some(met) = self.far_first(body, rays, limits, alive, Quest::First, far) {
            let t = scratch.far.samples.t;
            return core::array::from_fn(|i| (met >> i & 1 != 0).then_some(t[i]));
        }
        let lanes = lanes_in(alive);
        let furthest = lanes.clone().map(|i| limits[i]).fold(0.0, f64::max);
        let present: Vec<Ray> = lanes.map(|i| rays[i]).collect();
        let slabs = Beam::around(&present).and_then(|beam| {
            self.slabs(
                body,
                beam,
                |base| Beams::one(beam.from(base)),
                furthest,
                &mut scratch.spaces,
            )
        });
        let mut crossings = [None; PACKET];
        let Some((mut slabs, base)) = slabs else {
            return crossings;
        };
        // Lanes not in use repeat the first ray.
        let based: [Ray; PACKET] = core::array::from_fn(|i| {
            let is_alive = alive >> i & 1 != 0;
            let ray = if is_alive { &rays[i] } else { &present[0] };
            Ray {
                origin: ray.at(base),
                direction: ray.direction,
            }
        });
        let bundle = Bundle {
            rays: &based,
            limits: &limits.map(|limit| limit - base),
            alive,
            number: 0,
        };
        let found = self.walk(body, &mut slabs, bundle, Quest::First, scratch);
        if !found.is_empty() {
            // Refined on the surface, as in pictures.
            self.sample_hits(&slabs, &based, base, &found, scratch);
            for hit in &found {
                crossings[hit.lane] = Some(base + scratch.samples.t[hit.lane]);
            }
        }
        crossings
    }
}

/// Makes a crossing of a ray with the surface of a function whose gradient there is known.
fn cast(ray: &Ray, t: f64, gradient: DVec3, owner: Owner) -> Cast {
    Cast {
        t,
        normal: (-gradient).try_normalize().unwrap_or(-ray.direction),
        owner,
    }
}

/// Returns the element that adds most to a field; the pieces of a limb are one element.
fn strongest(parts: impl Iterator<Item = (u32, f64)>) -> Option<u32> {
    let mut sums = BTreeMap::new();
    for (element, share) in parts {
        *sums.entry(element).or_insert(0.0) += share;
    }
    let most = sums.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    most.map(|(element, _)| element)
}
