//! First hits of rays that run in any direction, as secondary ones do: those that run together are
//! followed as a packet.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::layout::{PACKET, lanes_in};
use crate::meet::{ALL, Seen};
use crate::quick::Rays;
use crate::ray::Ray;
use crate::stats::Stats;
use crate::workspace::Workspace;
use crate::world::{SurfacePoint, World};

/// A ray to follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeRay {
    pub ray: Ray,
    /// Whether it meets front faces of hard elements only.
    pub front_only: bool,
}

impl World {
    /// Returns the point that each of some rays meets first.
    pub fn meet_free(
        &self,
        rays: &[FreeRay],
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Vec<Option<SurfacePoint>> {
        let mut found = vec![None; rays.len()];
        let mut open: Vec<usize> = (0..rays.len()).collect();
        let mut seen = Seen::default();
        while let Some(&first) = open.first() {
            let leader = &rays[first].ray;
            let mut lanes = [first; PACKET];
            let mut count = 0;
            open.retain(|&i| {
                let joins = i == first || count < PACKET && leader.runs_with(&rays[i].ray);
                if joins {
                    lanes[count] = i;
                    count += 1;
                }
                !joins
            });
            // Lanes not in use repeat the first ray.
            let alive = ALL >> (PACKET - count);
            seen.rays = lanes.map(|i| rays[i].ray);
            seen.hits = [None; PACKET];
            work.begin();
            for lane in 0..count {
                let free = &rays[lanes[lane]];
                seen.hits[lane] = self.hard_point(&free.ray, free.front_only, &mut work.crossings);
            }
            if !self.soft.is_empty() {
                self.meet_soft_free(alive, &mut seen, work);
            }
            if !self.others.is_empty() {
                self.meet_others(&mut seen, alive, &mut work.scratch);
            }
            stats.field_evaluations += work.scratch.evaluations;
            for lane in 0..count {
                found[lanes[lane]] = seen.hits[lane];
            }
        }
        found
    }

    /// Replaces what the rays of some lanes meet by points on convolution surfaces that are nearer.
    fn meet_soft_free(&self, alive: u32, seen: &mut Seen, work: &mut Workspace) {
        let lanes = lanes_in(alive);
        let rays: Vec<Ray> = lanes.clone().map(|i| seen.rays[i]).collect();
        let beam = match rays[..] {
            [ray] => Beam::of_ray(ray),
            _ => match Beam::around(&rays) {
                Some(beam) => beam,
                None => return,
            },
        };
        let limits = seen.limits();
        let furthest = lanes.map(|i| limits[i]).fold(0.0, f64::max);
        let mut near = core::mem::take(&mut work.around);
        let mut general = core::mem::take(&mut work.general);
        let near_blobs = self.general_from_a_patch(&beam, furthest, &mut near, &mut general);
        let mut bodies: Vec<u32> = general.iter().map(|&(_, body)| body).collect();
        if near_blobs {
            let lanes = Rays::new(&seen.rays, &near);
            let wide = seen.rays;
            bodies.extend(self.meet_blobs_by(&near, &general, &lanes, &|| wide, alive, seen, work));
        }
        let scratch = &mut work.scratch;
        for body in bodies {
            if self.meet_far(body, alive, seen, scratch) {
                continue;
            }
            let slabs = self.soft.slabs(
                body,
                beam,
                |base| Beams::one(beam.from(base)),
                furthest,
                &mut scratch.spaces,
            );
            if let Some((mut slabs, base)) = slabs {
                self.meet_slabs(body, &mut slabs, base, (0, alive), seen, scratch);
                scratch.evaluations += slabs.evaluations();
                scratch.spaces.push(slabs.into_space());
            }
        }
        work.around = near;
        work.general = general;
    }
}
