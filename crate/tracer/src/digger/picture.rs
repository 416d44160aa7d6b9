//! How a picture uses a digger other than its own.
use super::{Digger, Packet};
use crate::packet::{Hit, Workspace};
use crate::picture::Picture;
use crate::ray::Ray;
use crate::shade::Finish;
use crate::soft::{PACKET, Scratch};
use crate::walk::Quest;
use glam::DVec3;

/// How far rays to the lights start above a hit, in units of the scene's size: about as much as
/// the crudest digger's surface differs from itself in another direction.
const LIFT: f64 = 1e-3;

impl Picture {
    /// Replaces hits by those on the soft surface that are nearer, as the digger finds them.
    pub(crate) fn dug_hits(
        &self,
        digger: &dyn Digger,
        rays: &[Ray; PACKET],
        work: &mut Workspace,
        hits: &mut [Option<Hit>; PACKET],
    ) {
        let limits = core::array::from_fn(|i| hits[i].map_or(f64::INFINITY, |h| h.t));
        let packet = Packet {
            rays,
            limits: &limits,
            alive: (1 << PACKET) - 1,
        };
        let found = digger.dig(&self.soft, &packet, Quest::First, &mut work.scratch);
        for ((hit, ray), t) in hits.iter_mut().zip(rays).zip(found) {
            if let Some(t) = t {
                *hit = self.dug_hit(ray, t, &mut work.scratch).or(*hit);
            }
        }
    }

    /// What the soft surface is like where a digger says that it is; `None` where nothing is soft.
    fn dug_hit(&self, ray: &Ray, t: f64, scratch: &mut Scratch) -> Option<Hit> {
        let position = ray.at(t);
        let mut gradient = DVec3::ZERO;
        let mut weights: Vec<(u32, f64)> = Vec::new();
        self.soft.along(ray, |primitive, _, material| {
            let jet = primitive.jet(position.to_array());
            scratch.evaluations += 1;
            gradient += DVec3::from_array(jet.gradient);
            weights.push((material, jet.value.max(0.0)));
        });
        let mut normal = (-gradient).try_normalize()?;
        if normal.dot(ray.direction) > 0.0 {
            normal = -normal;
        }
        let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
        let mut finish = Finish::default();
        for (material, weight) in weights {
            let share = (weight / total) as f32;
            if share > 0.0 {
                finish.mix(&self.finishes[material as usize], share);
            }
        }
        Some(Hit {
            t,
            position,
            normal,
            lift: LIFT,
            finish,
            thing: 1,
        })
    }

    /// Which of some rays (those that are there) enter the soft surface before their limits, as the
    /// digger finds it.
    pub(crate) fn dug_shadows(
        &self,
        digger: &dyn Digger,
        rays: &[Option<Ray>; PACKET],
        limits: &[f64; PACKET],
        work: &mut Workspace,
    ) -> u32 {
        let Some(any) = rays.iter().flatten().next() else {
            return 0;
        };
        let lanes = |found: &dyn Fn(usize) -> bool| {
            (0..PACKET).fold(0, |mask, i| mask | u32::from(found(i)) << i)
        };
        let packet = Packet {
            rays: &rays.map(|ray| ray.unwrap_or(*any)),
            limits,
            alive: lanes(&|i| rays[i].is_some()),
        };
        let found = digger.dig(&self.soft, &packet, Quest::Entry, &mut work.scratch);
        lanes(&|i| found[i].is_some())
    }
}
