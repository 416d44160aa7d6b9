//! Shading of scenes that have surroundings (a background of several colours, ground, fog, clouds,
//! a tone) but in which no ray leaves a surface except straight to the lights: packets keep their
//! beams, as in [`shadows`](crate::shadows), and no paths are followed.
//!
//! Colours are those of [`World::illuminate`], in the same order of operations.
use crate::lamps::Received;
use crate::layout::PACKET;
use crate::meet::Seen;
use crate::paths::GROUND;
use crate::rich::Rich;
use crate::sample::Sample;
use crate::shade::{Finish, clamp};
use crate::shadows::{shadow, towards_distant};
use crate::soft::MakeUp;
use crate::stats::Stats;
use crate::workspace::{State, Workspace};
use crate::world::{Owner, SurfacePoint, World};
use glam::{DVec3, Vec3};

/// A surface point, or one of the ground, that light falls on.
struct LitPoint {
    /// Packet and lane of the ray that sees it.
    hit: (usize, usize),
    position: DVec3,
    normal: DVec3,
    lift: f64,
    /// Direction of the ray that sees it.
    view: DVec3,
    finish: Finish,
    /// Distance from the eye.
    depth: f64,
    /// Share of its light that reaches the eye; for the ground, times the ground's colour.
    share: Vec3,
    is_ground: bool,
    received: Received,
}

impl World {
    /// Takes samples with the rays of some packets in a scene whose light needs no paths
    /// ([`Rich::is_direct`]), lit from the middles of lights, and leaves them in the working space.
    /// `across` is as in [`World::shine`].
    pub fn shine_in_air(
        &self,
        rich: &Rich,
        seen: &[Seen],
        across: f64,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        let mut samples = core::mem::take(&mut work.samples);
        let mut points = Vec::new();
        samples.clear();
        for (k, seen) in seen.iter().enumerate() {
            let mut packet = [Sample::BLANK; PACKET];
            for (i, sample) in packet.iter_mut().enumerate().take(seen.used) {
                sample.cost = seen.costs[i];
                points.extend(self.see_in_air(rich, seen, (k, i), sample));
            }
            samples.push(packet);
        }
        let mut shadows = core::mem::take(&mut work.shadows);
        for (which, light) in self.lights.iter().enumerate() {
            let distant = towards_distant(light);
            shadows.clear();
            for (number, point) in points.iter().enumerate() {
                let place = (point.position, point.normal, point.lift);
                shadows.extend(shadow(light, distant, (number, 0), place, point.depth));
            }
            if light.shadow && !shadows.is_empty() {
                stats.shadow_rays += shadows.len() as u64;
                self.look_for_shadows(&mut shadows, across, work, stats);
            }
            for shadow in &shadows {
                let point = &mut points[shadow.hit.0];
                let free = point.finish.shade(
                    Vec3::from(light.colour) * light.share(point.position) as f32,
                    point.normal.as_vec3(),
                    shadow.ray.direction.as_vec3(),
                    point.view.as_vec3(),
                );
                point.received.free += free;
                if shadow.state != State::Dark {
                    point.received.light += free;
                    point.received.lit ^= 1 << (which % 8);
                }
            }
        }
        for point in &points {
            let sample = &mut samples[point.hit.0][point.hit.1];
            sample.colour += if point.is_ground {
                point.share * point.received.of_ground()
            } else {
                point.share * point.received.light
            };
            sample.key ^= point.received.lit;
        }
        for sample in samples.iter_mut().flatten() {
            sample.colour = clamp(rich.tone(sample.colour));
        }
        work.shadows = shadows;
        work.samples = samples;
    }

    /// Adds to a sample the light that its ray sees without any source. Returns the point that
    /// light falls on.
    fn see_in_air(
        &self,
        rich: &Rich,
        seen: &Seen,
        (k, i): (usize, usize),
        sample: &mut Sample,
    ) -> Option<LitPoint> {
        let (ray, hit) = (&seen.rays[i], seen.hits[i].as_ref());
        let mut share = Vec3::ONE;
        let (ground, clear) = self.through_air(rich, ray, true, hit, &mut share, sample);
        if let Some(ground) = ground {
            let depth = ground.t / self.unit.length(1.0);
            (sample.key, sample.depth) = (GROUND, depth as f32);
            let position = self.unit.map(ground.position);
            return Some(LitPoint {
                hit: (k, i),
                position,
                normal: ground.normal,
                lift: self.hard_lift * (1.0 + position.length()),
                view: ray.direction,
                finish: Finish::dull(Vec3::ONE),
                depth,
                share: share * ground.cover * ground.colour,
                is_ground: true,
                received: Received::default(),
            });
        }
        let hit = hit?;
        (sample.key, sample.depth) = (hit.surface << 8, hit.t as f32);
        share *= clear;
        let finish = self.direct_finish(rich, hit);
        sample.colour += share * finish.glow();
        Some(LitPoint {
            hit: (k, i),
            position: hit.position,
            normal: hit.facing(ray.direction),
            lift: hit.lift,
            view: ray.direction,
            finish,
            depth: hit.t,
            share,
            is_ground: false,
            received: Received::default(),
        })
    }

    /// Returns the colours of a surface point of a scene without textures. Where materials blend
    /// they are mixed as paths mix them, so that a scene does not change its colours as soon as one
    /// element of it is a mirror.
    fn direct_finish(&self, rich: &Rich, hit: &SurfacePoint) -> Finish {
        let is_even = match self.owner_of(hit.surface) {
            Owner::Solid(number) => rich.materials.is_even(self.solids.finish(number) as u32),
            Owner::Soft(body) => {
                let MakeUp { is_even, first, .. } = rich.make_up[body as usize];
                is_even && rich.materials.is_even(first)
            }
            Owner::Other(_) => false,
        };
        if is_even {
            return hit.finish;
        }
        Finish::of_surface(&self.look(rich, hit).surface)
    }
}
