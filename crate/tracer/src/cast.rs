//! Single rays by the way that pictures are traced: for whoever asks what a picture would show, and for
//! checking it.
use crate::beam::Beam;
use crate::picture::{Hit, Picture};
use crate::ray::Ray;
use crate::soft::{PACKET, Scratch};
use crate::walk::{Bundle, Quest};
use glam::DVec3;

/// Rays whose directions differ by more than this, or whose origins by more than this part of half the scene's
/// size, are not followed together.
const WIDEST: f64 = 0.15;

impl Picture {
    /// What each ray (origin, direction) hits first at t > 0, with the arithmetic and the
    /// tolerance of pictures. Neighbouring rays of the list make packets: the nearer together they
    /// are, the faster it goes.
    #[must_use]
    pub fn cast(&self, rays: &[(DVec3, DVec3)]) -> Vec<Option<Hit>> {
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
            let alive: Vec<Ray> = unit.iter().flatten().copied().collect();
            let Some(beam) = Beam::around(&alive) else {
                continue;
            };
            let mut found: [Option<(f64, DVec3)>; PACKET] = [None; PACKET];
            for (ray, found) in unit.iter().zip(&mut found) {
                *found = ray.and_then(|ray| {
                    let (_, c) = self.solids.first(&ray, f64::INFINITY, &mut crossings)?;
                    Some((c.t, c.normal))
                });
            }
            if let Some((mut slabs, base)) = self.soft.slabs(beam, Vec::new, f64::INFINITY) {
                let based: [Ray; PACKET] = core::array::from_fn(|i| {
                    let ray = unit.get(i).copied().flatten().unwrap_or(alive[0]);
                    Ray {
                        origin: ray.at(base),
                        direction: ray.direction,
                    }
                });
                let limits: [f64; PACKET] =
                    core::array::from_fn(|i| found[i].map_or(f64::INFINITY, |(t, _)| t - base));
                let bundle = Bundle {
                    rays: &based,
                    limits: &limits,
                    alive: (0..unit.len()).fold(0, |m, i| m | u32::from(unit[i].is_some()) << i),
                    number: 0,
                };
                let soft = self
                    .soft
                    .walk(&mut slabs, bundle, Quest::First, &mut scratch);
                if !soft.is_empty() {
                    let flesh = self.soft.flesh(&slabs, &based, &soft, &mut scratch);
                    for hit in &soft {
                        let normal = -flesh.gradient[hit.lane];
                        found[hit.lane] = Some((base + flesh.t[hit.lane], normal));
                    }
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

    /// The largest distance that a hit at `t` may have from the true surface, and the greatest
    /// thickness, along the ray, of what may go unseen: the smaller of 10⁻⁴ of the scene's size and a
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
