//! Pictures with root finders other than the certified one (`digger`).
use crate::digger::{Digger, Packet};
use crate::layout::PACKET;
use crate::meet::{ALL, Seen};
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::walk::Quest;
use crate::workspace::Workspace;
use crate::world::{SurfacePoint, World};
use glam::DVec3;

/// Offset of shadow rays above a hit, in units of the scene's size: about as much as the crudest digger's hits on one
/// surface differ by direction.
const LIFT: f64 = 1e-3;

impl World {
    /// Replaces the points that rays meet by nearer points on convolution surfaces, as the digger finds them.
    pub fn dug_points(&self, digger: &dyn Digger, seen: &mut Seen, work: &mut Workspace) {
        for body in 0..self.soft.bodies.len() as u32 {
            let packet = Packet {
                rays: &seen.rays,
                limits: &seen.limits(),
                alive: ALL,
            };
            let found = digger.dig(&self.soft, body, &packet, Quest::First, &mut work.scratch);
            for ((hit, ray), t) in seen.hits.iter_mut().zip(&seen.rays).zip(found) {
                if let Some(t) = t {
                    *hit = self.dug_point(body, ray, t, &mut work.scratch).or(*hit);
                }
            }
        }
    }

    /// Returns the surface point of a digger's crossing; `None` where there is no soft primitive.
    fn dug_point(
        &self,
        body: u32,
        ray: &Ray,
        t: f64,
        scratch: &mut Scratch,
    ) -> Option<SurfacePoint> {
        let position = ray.at(t);
        let mut gradient = DVec3::ZERO;
        let mut weights: Vec<(u32, f64)> = Vec::new();
        self.soft.along(body, ray, |primitive, _, number| {
            let jet = primitive.jet(position.to_array());
            scratch.evaluations += 1;
            gradient += DVec3::from_array(jet.gradient);
            weights.push((self.soft.finish[number as usize], jet.value.max(0.0)));
        });
        Some(SurfacePoint {
            t,
            position,
            normal: (-gradient).try_normalize()?,
            lift: LIFT,
            finish: self.mixed(weights.into_iter()),
            surface: self.surface_of_body(self.soft.bodies[body as usize].number),
        })
    }

    /// Returns which of some rays (those that are present) enter a convolution surface before their limits, as the digger finds it.
    pub fn dug_shadows(
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
        let mut alive = lanes(&|i| rays[i].is_some());
        let mut dark = 0;
        for body in 0..self.soft.bodies.len() as u32 {
            let packet = Packet {
                rays: &rays.map(|ray| ray.unwrap_or(*any)),
                limits,
                alive,
            };
            let found = digger.dig(&self.soft, body, &packet, Quest::Entry, &mut work.scratch);
            dark |= lanes(&|i| found[i].is_some());
            alive &= !dark;
        }
        dark
    }
}
