//! Light and shadow on what packets of rays hit.
//!
//! The hits of several packets are looked at together, so that their rays to a light can share what is known of the
//! way: the rays from one patch of the surface have one list of lumps, or the slabs of one beam.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::packet::{Seen, Workspace};
use crate::picture::{Picture, Stats};
use crate::quick::{Asked, Rays};
use crate::ray::Ray;
use crate::sample::Sample;
use crate::shade::{clamped, towards};
use crate::soft::PACKET;
use crate::walk::{Bundle, Quest};
use glam::{DVec3, Vec3};
use scene::LightKind;

/// A ray from a hit to a light.
pub(crate) struct Shadow {
    /// The hit: its packet and its lane.
    hit: (usize, usize),
    ray: Ray,
    /// How far it is to the light.
    limit: f64,
    /// How far from the eye the hit is.
    depth: f64,
    state: State,
    /// What finding out cost.
    cost: f32,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Unknown,
    /// Being looked at.
    Asked,
    Lit,
    Dark,
}

/// Hits further apart than this times the width of what is seen together are on different patches.
const PATCH: f64 = 3.0;

impl Picture {
    /// What the rays of some packets see. Their hits may share beams to the lights: they must be the same packets
    /// whatever the tiles. `across` is how wide they are together, per unit of distance, or less, if only nearer hits are to share. The samples are left in the
    /// working space.
    pub(crate) fn shine(
        &self,
        seen: &[Seen],
        across: f64,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        let mut samples = core::mem::take(&mut work.samples);
        samples.clear();
        samples.extend(seen.iter().map(|seen| {
            core::array::from_fn(|i| {
                let hit = seen.hits[i].as_ref();
                Sample {
                    colour: hit.map_or(self.background, |hit| hit.finish.glow()),
                    key: hit.map_or(0, |hit| hit.thing << 8),
                    depth: hit.map_or(f32::INFINITY, |hit| hit.t as f32),
                    cost: seen.costs[i],
                }
            })
        }));
        let mut shadows = core::mem::take(&mut work.shadows);
        for (which, light) in self.lights.iter().enumerate() {
            // From a distant light it is the same everywhere.
            let same = towards(light, DVec3::ZERO);
            let distant = matches!(light.kind, LightKind::Distant { .. });
            shadows.clear();
            for (k, seen) in seen.iter().enumerate() {
                for (i, hit) in seen.hits.iter().enumerate() {
                    let Some(hit) = hit else { continue };
                    let (direction, limit) = if distant {
                        same
                    } else {
                        towards(light, hit.position)
                    };
                    if hit.normal.dot(direction) > 0.0 {
                        shadows.push(Shadow {
                            hit: (k, i),
                            ray: Ray {
                                origin: hit.position + hit.normal * hit.lift,
                                direction,
                            },
                            limit,
                            depth: hit.t,
                            state: State::Unknown,
                            cost: 0.0,
                        });
                    }
                }
            }
            if light.shadow && !shadows.is_empty() {
                stats.shadow_rays += shadows.len() as u64;
                self.look_for_shadows(&mut shadows, across, work, stats);
            }
            for shadow in &shadows {
                let (k, i) = shadow.hit;
                let sample = &mut samples[k][i];
                sample.cost += shadow.cost;
                let (Some(hit), true) = (&seen[k].hits[i], shadow.state != State::Dark) else {
                    continue;
                };
                sample.colour += hit.finish.lit(
                    Vec3::from(light.colour),
                    hit.normal.as_vec3(),
                    shadow.ray.direction.as_vec3(),
                    seen[k].rays[i].direction.as_vec3(),
                );
                sample.key ^= 1 << (which % 8);
            }
        }
        work.shadows = shadows;
        for sample in samples.iter_mut().flatten() {
            sample.colour = clamped(sample.colour);
        }
        work.samples = samples;
    }

    /// Finds out which rays to a light have something between them and the light.
    fn look_for_shadows(
        &self,
        shadows: &mut [Shadow],
        across: f64,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        for shadow in &mut *shadows {
            shadow.cost = 1.0;
            let (ray, limit) = (&shadow.ray, shadow.limit);
            if self.solids.first(ray, limit, &mut work.crossings).is_some() {
                shadow.state = State::Dark;
            }
        }
        if self.soft.is_empty() {
            return;
        }
        // Hits on different parts of the surface would make a beam that is wide from its start:
        // each patch of neighbouring hits gets its own.
        while let Some(leader) = shadows.iter().position(|s| s.state == State::Unknown) {
            let (first, depth) = (shadows[leader].ray.origin, shadows[leader].depth);
            let patch = PATCH * across * depth;
            for shadow in &mut shadows[leader..] {
                if shadow.state == State::Unknown && shadow.ray.origin.distance(first) <= patch {
                    shadow.state = State::Asked;
                }
            }
            // The leader is in its own patch even where its position is not a number.
            shadows[leader].state = State::Asked;
            let mut members: Vec<&mut Shadow> = shadows[leader..]
                .iter_mut()
                .filter(|shadow| shadow.state == State::Asked)
                .collect();
            self.look_from_a_patch(&mut members, work, stats);
            for shadow in members {
                if shadow.state == State::Asked {
                    shadow.state = State::Lit;
                }
            }
        }
    }

    /// Darkens those rays of a patch that enter the soft surface before their ends.
    fn look_from_a_patch(
        &self,
        patch: &mut [&mut Shadow],
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        if let Some(digger) = &self.digger {
            for packet in patch.chunks_mut(PACKET) {
                let rays = core::array::from_fn(|i| packet.get(i).map(|shadow| shadow.ray));
                let limits = core::array::from_fn(|i| packet.get(i).map_or(0.0, |s| s.limit));
                work.begin();
                let dark = self.dug_shadows(&**digger, &rays, &limits, work);
                darken(packet, dark, work, stats);
            }
            return;
        }
        let starts: &[Ray] = &patch.iter().map(|shadow| shadow.ray).collect::<Vec<_>>();
        let Some(beam) = Beam::around(starts) else {
            return;
        };
        let furthest = patch.iter().map(|shadow| shadow.limit).fold(0.0, f64::max);
        let mut near = core::mem::take(&mut work.around);
        let quick = self.soft.list_lumps(&beam, furthest, &mut near)
            && !self.soft.meets_any(&near.others, &beam, furthest);
        let mut slabs = None;
        for (number, packet) in patch.chunks_mut(PACKET).enumerate() {
            work.begin();
            let alive = (1u32 << packet.len()) - 1;
            // Lanes not in use repeat the first ray.
            let lane = |i: usize| if i < packet.len() { i } else { 0 };
            let rays: [Ray; PACKET] = core::array::from_fn(|i| packet[lane(i)].ray);
            let limits: [f64; PACKET] = core::array::from_fn(|i| packet[lane(i)].limit);
            let scratch = &mut work.scratch;
            if quick {
                let lanes = Rays::new(&rays, &near);
                let quick = &mut scratch.quick;
                let asked = Asked {
                    limits: &limits,
                    alive,
                    quest: Quest::Entry,
                };
                let looked = self.soft.quick(&near, &lanes, &|| rays, asked, quick);
                if let Some(looked) = looked {
                    scratch.evaluations += looked.evaluations;
                    darken(packet, looked.met, work, stats);
                    continue;
                }
            }
            let slabs = slabs.get_or_insert_with(|| {
                let levels = starts.len().div_ceil(PACKET).next_power_of_two().ilog2();
                let divided = |base: f64| {
                    Beams::divided(levels, move |number| {
                        let path = number + 1;
                        let count = PACKET << (levels - path.ilog2());
                        let first = count * (path - (1 << path.ilog2()));
                        let part = first..starts.len().min(first + count);
                        let part = starts.get(part).and_then(Beam::around);
                        part.unwrap_or(beam).from(base)
                    })
                };
                self.soft
                    .slabs(beam, divided, furthest, &mut scratch.spaces)
            });
            let Some((slabs, base)) = slabs else {
                darken(packet, 0, work, stats);
                continue;
            };
            let bundle = Bundle {
                rays: &rays.map(|ray| Ray {
                    origin: ray.at(*base),
                    direction: ray.direction,
                }),
                limits: &limits.map(|limit| limit - *base),
                alive,
                number,
            };
            let found = self.soft.walk(slabs, bundle, Quest::Entry, scratch);
            let met = found.iter().fold(0, |met, hit| met | 1 << hit.lane);
            darken(packet, met, work, stats);
        }
        if let Some(Some((slabs, _))) = slabs {
            stats.field_evaluations += slabs.evaluations();
            work.scratch.spaces.push(slabs.into_space());
        }
        work.around = near;
    }
}

/// Notes which rays of a packet are dark, and what finding out cost.
fn darken(packet: &mut [&mut Shadow], dark: u32, work: &Workspace, stats: &mut Stats) {
    stats.field_evaluations += work.scratch.evaluations;
    let costs = work.costs(packet.len());
    for (i, (shadow, cost)) in packet.iter_mut().zip(costs).enumerate() {
        shadow.cost = cost;
        shadow.state = if dark >> i & 1 == 0 {
            State::Lit
        } else {
            State::Dark
        };
    }
}
