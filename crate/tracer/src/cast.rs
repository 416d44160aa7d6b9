//! Single rays by the way that pictures are traced: for callers that ask what a picture would show, and for
//! checking it.
use crate::digger::{Hermite, Packet};
use crate::layout::PACKET;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::walk::Quest;
use crate::world::World;
use glam::DVec3;

/// Rays whose directions differ by more than this, or whose origins by more than this part of half the scene's
/// size, are not followed together.
const WIDEST: f64 = 0.15;

/// A surface that a ray meets.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Owner {
    /// The convolution surface of a body, by its number among the soft ones.
    Soft(u32),
    /// The surface of a function.
    Function(usize),
    /// A hard element's.
    Solid(u32),
}

/// A crossing in units of the scene's size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cast {
    pub t: f64,
    /// Outward; unit length, unless the gradient vanishes.
    pub normal: DVec3,
    pub owner: Owner,
}

impl World {
    /// The first crossing of each of some rays of the world at t > 0. Neighbouring rays of the list make packets: the nearer
    /// together they are, the faster it goes.
    pub fn cast(&self, rays: &[(DVec3, DVec3)]) -> Vec<Option<Cast>> {
        let digger = self.digger.as_deref().unwrap_or(&Hermite);
        let mut scratch = Scratch::default();
        let mut crossings = Vec::new();
        let mut found = vec![None; rays.len()];
        let mut done = 0;
        while done < rays.len() {
            let count = self.together(&rays[done..]);
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
            for body in 0..self.soft.bodies.len() as u32 {
                let limit = |i: usize| found.get(i).copied().flatten().map(|cast| cast.t);
                let packet = Packet {
                    rays: &core::array::from_fn(|i| lane(i).unwrap_or(*any)),
                    limits: &core::array::from_fn(|i| limit(i).unwrap_or(f64::INFINITY)),
                    alive: (0..PACKET).fold(0, |m, i| m | u32::from(lane(i).is_some()) << i),
                };
                let soft = digger.dig(&self.soft, body, &packet, Quest::First, &mut scratch);
                for ((found, t), ray) in found.iter_mut().zip(soft).zip(packet.rays) {
                    if let Some(t) = t {
                        *found = Some(Cast {
                            t,
                            normal: self.soft_normal(body, ray, t),
                            owner: Owner::Soft(body),
                        });
                    }
                }
            }
            for (number, body) in self.functions.iter().enumerate() {
                for (ray, found) in unit.iter().zip(&mut *found) {
                    let Some(ray) = ray else { continue };
                    let limit = found.map_or(f64::INFINITY, |cast: Cast| cast.t);
                    let (nearer, _) = self.function_crossing(body, ray, limit, Quest::First);
                    if let Some(t) = nearer {
                        let normal = body.normal(ray.at(t));
                        *found = Some(Cast {
                            t,
                            normal: normal.unwrap_or(-ray.direction),
                            owner: Owner::Function(number),
                        });
                    }
                }
            }
        }
        found
    }

    /// All crossings of a ray at t > 0, in order, found exactly: with nothing cut off and nothing shared.
    pub fn crossings(&self, ray: &Ray) -> Vec<Cast> {
        let solid = |(number, crossing): (u32, crate::hard::Crossing)| Cast {
            t: crossing.t,
            normal: crossing.normal,
            owner: Owner::Solid(number),
        };
        let mut found: Vec<Cast> = self.solids.all(ray).into_iter().map(solid).collect();
        for body in 0..self.soft.bodies.len() as u32 {
            let ahead = self.soft.crossings(body, ray).into_iter();
            found.extend(ahead.filter(|(t, _)| *t > 0.0).map(|(t, gradient)| Cast {
                t,
                normal: (-gradient).try_normalize().unwrap_or(-ray.direction),
                owner: Owner::Soft(body),
            }));
        }
        for (number, body) in self.functions.iter().enumerate() {
            self.function_crossings(body, ray, f64::INFINITY, |t, _| {
                let normal = body.normal(ray.at(t));
                found.push(Cast {
                    t,
                    normal: normal.unwrap_or(-ray.direction),
                    owner: Owner::Function(number),
                });
                true
            });
        }
        found.sort_by(|a, b| a.t.total_cmp(&b.t));
        found
    }

    /// The outward normal of a convolution surface where a ray is at t.
    fn soft_normal(&self, body: u32, ray: &Ray, t: f64) -> DVec3 {
        let point = ray.at(t).to_array();
        let mut gradient = DVec3::ZERO;
        self.soft.along(body, ray, |primitive, _, _| {
            gradient += DVec3::from_array(primitive.jet(point).gradient);
        });
        -gradient
    }

    /// How many of the first rays make a packet: as in pictures, a beam around them is narrow.
    fn together(&self, rays: &[(DVec3, DVec3)]) -> usize {
        let Some(first) = rays.first().and_then(|r| self.ray(r)) else {
            return 1;
        };
        let near = |r: &&(DVec3, DVec3)| {
            self.ray(r).is_some_and(|ray| {
                ray.direction.distance(first.direction) <= WIDEST
                    && ray.origin.distance(first.origin) <= WIDEST
            })
        };
        rays.iter().take(PACKET).take_while(near).count().max(1)
    }

    /// A ray of the world in the unit scene; `None` if it is not finite or has no direction.
    pub fn ray(&self, (origin, direction): &(DVec3, DVec3)) -> Option<Ray> {
        let ray = Ray {
            origin: self.unit.map(*origin),
            direction: direction.try_normalize()?,
        };
        ray.origin.is_finite().then_some(ray)
    }

    /// The number of the scene's body and the scene's element that a crossing belongs to. On a convolution surface it is the
    /// element that adds most to the field there.
    pub fn owner(&self, cast: &Cast, ray: &Ray) -> (Option<u32>, Option<u32>) {
        match cast.owner {
            Owner::Solid(number) => (None, Some(self.solids.element(number))),
            Owner::Function(number) => {
                let body = &self.functions[number];
                let point = body.unit.world(ray.at(cast.t));
                let element = scene::surface::strongest(&*body.function, &body.element, point);
                (Some(body.number), element)
            }
            Owner::Soft(body) => {
                let point = ray.at(cast.t).to_array();
                // Pieces of a limb are one element.
                let mut shares = std::collections::BTreeMap::new();
                self.soft.along(body, ray, |primitive, _, number| {
                    let element = self.soft.element[number as usize];
                    *shares.entry(element).or_insert(0.0) += primitive.value::<f64>(point);
                });
                let most = shares.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
                let number = self.soft.bodies[body as usize].number;
                (Some(number), most.map(|(element, _)| element))
            }
        }
    }
}
