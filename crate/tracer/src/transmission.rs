//! Light that passes transparent surfaces on its way straight to a point, and is coloured by them.
use crate::free::FreeRay;
use crate::ray::Ray;
use crate::rich::Rich;
use crate::stats::Stats;
use crate::workspace::Workspace;
use crate::world::World;
use glam::Vec3;

/// Most surfaces that light passes.
const MOST_PASSED: u32 = 64;

impl World {
    /// Returns the share of light that passes along each of some rays up to its end: the product of
    /// the transparencies of all surfaces there. Light is not bent. Where more than
    /// [`MOST_PASSED`] surfaces are in the way it is 0.
    pub fn transmission(
        &self,
        rich: &Rich,
        rays: &[(Ray, f64)],
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Vec<Vec3> {
        let mut light = vec![Vec3::ONE; rays.len()];
        let mut open: Vec<(usize, Ray, f64)> = rays
            .iter()
            .enumerate()
            .map(|(i, (ray, limit))| (i, *ray, *limit))
            .collect();
        for _ in 0..MOST_PASSED {
            if open.is_empty() {
                return light;
            }
            let free: Vec<FreeRay> = open
                .iter()
                .map(|&(_, ray, _)| FreeRay {
                    ray,
                    front_only: false,
                })
                .collect();
            let hits = self.meet_free(&free, work, stats);
            let mut next = Vec::new();
            for ((i, ray, limit), hit) in open.into_iter().zip(hits) {
                let Some(hit) = hit.filter(|hit| hit.t < limit) else {
                    continue;
                };
                let look = self.look(rich, &hit);
                if !look.skip.shadow {
                    light[i] *= look.surface.transparent;
                }
                if rich.shows(light[i]) {
                    let origin = hit.position - hit.facing(ray.direction) * hit.lift;
                    let direction = ray.direction;
                    next.push((i, Ray { origin, direction }, limit - hit.t));
                } else {
                    light[i] = Vec3::ZERO;
                }
            }
            open = next;
        }
        for (i, ..) in open {
            light[i] = Vec3::ZERO;
        }
        light
    }
}
