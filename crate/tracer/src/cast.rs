//! Single rays by the way that pictures are traced: for whoever asks what a picture would show, and for
//! checking it.
use crate::digger::{Hermite, Packet};
use crate::picture::{Hit, Picture};
use crate::ray::Ray;
use crate::soft::{PACKET, Scratch};
use crate::walk::Quest;
use glam::DVec3;

/// Rays whose directions differ by more than this, or whose origins by more than this part of half the scene's
/// size, are not followed together.
const WIDEST: f64 = 0.15;

impl Picture {
    /// What each ray (origin, direction) hits first at t > 0, as the scene's digger finds it, with the
    /// arithmetic and the tolerance of pictures. Neighbouring rays of the list make packets: the nearer together they
    /// are, the faster it goes.
    #[must_use]
    pub fn cast(&self, rays: &[(DVec3, DVec3)]) -> Vec<Option<Hit>> {
        let digger = self.digger.as_deref().unwrap_or(&Hermite);
        let mut scratch = Scratch::default();
        let mut crossings = Vec::new();
        let mut hits = vec![None; rays.len()];
        let mut done = 0;
        while done < rays.len() {
            let count = self.together(&rays[done..]);
            let range = done..done + count;
            done += count;
            let (rays, hits) = (&rays[range.clone()], &mut hits[range]);
            let unit: Vec<Option<Ray>> = rays.iter().map(|r| self.unit_ray(r)).collect();
            let Some(any) = unit.iter().flatten().next() else {
                continue;
            };
            let mut found: [Option<(f64, DVec3)>; PACKET] = [None; PACKET];
            for (ray, found) in unit.iter().zip(&mut found) {
                *found = ray.and_then(|ray| {
                    let (_, c) = self.solids.first(&ray, f64::INFINITY, &mut crossings)?;
                    Some((c.t, c.normal))
                });
            }
            let lane = |i: usize| unit.get(i).copied().flatten();
            let packet = Packet {
                rays: &core::array::from_fn(|i| lane(i).unwrap_or(*any)),
                limits: &found.map(|hit| hit.map_or(f64::INFINITY, |(t, _)| t)),
                alive: (0..PACKET).fold(0, |m, i| m | u32::from(lane(i).is_some()) << i),
            };
            let soft = digger.dig(&self.soft, &packet, Quest::First, &mut scratch);
            for ((found, t), ray) in found.iter_mut().zip(soft).zip(packet.rays) {
                if let Some(t) = t {
                    *found = Some((t, -self.gradient(ray, t)));
                }
            }
            for ((ray, found), hit) in unit.iter().zip(found).zip(hits.iter_mut().zip(rays)) {
                let (Some(ray), Some((t, normal))) = (ray, found) else {
                    continue;
                };
                let (hit, (origin, _)) = hit;
                let t = self.unit.length(t);
                *hit = Some(Hit {
                    t,
                    position: *origin + ray.direction * t,
                    normal: normal.try_normalize().unwrap_or(-ray.direction),
                });
            }
        }
        hits
    }

    /// The gradient of the field where a ray is at t.
    fn gradient(&self, ray: &Ray, t: f64) -> DVec3 {
        let point = ray.at(t).to_array();
        let mut gradient = DVec3::ZERO;
        self.soft.along(ray, |primitive, _, _| {
            gradient += DVec3::from_array(primitive.jet(point).gradient);
        });
        gradient
    }

    /// The largest distance that a hit at `t` is meant to have from the true surface, and the greatest
    /// thickness, along the ray, of what may go unseen (for what is not so yet, see the limits of this crate): the smaller of 10⁻⁴ of the scene's size and a
    /// fifth of the width of a pixel there; but never less than 10⁻⁶ of the scene's size.
    #[must_use]
    pub fn tolerance(&self, t: f64) -> f64 {
        // The unit scene is between 2 and 4 large.
        let scene = self.unit.length(2.0);
        let pixel = 2.0 * self.projection.half_width / f64::from(self.size[0]);
        (0.2 * pixel * t).clamp(1e-6 * scene, 1e-4 * scene)
    }

    /// How many of the first rays make a packet: as in pictures, a beam around them is narrow.
    fn together(&self, rays: &[(DVec3, DVec3)]) -> usize {
        let Some(first) = rays.first().and_then(|r| self.unit_ray(r)) else {
            return 1;
        };
        let near = |r: &&(DVec3, DVec3)| {
            self.unit_ray(r).is_some_and(|ray| {
                ray.direction.distance(first.direction) <= WIDEST
                    && ray.origin.distance(first.origin) <= WIDEST
            })
        };
        rays.iter().take(PACKET).take_while(near).count().max(1)
    }

    fn unit_ray(&self, (origin, direction): &(DVec3, DVec3)) -> Option<Ray> {
        let ray = Ray {
            origin: self.unit.map(*origin),
            direction: direction.try_normalize()?,
        };
        ray.origin.is_finite().then_some(ray)
    }
}
