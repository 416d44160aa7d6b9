//! Light and shadow on the hits of packets of rays.
//!
//! The hits of several packets are looked at together, so that their rays to a light can share
//! data: the rays from one patch of the surface have one list of blobs, or the slabs of one beam.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::layout::PACKET;
use crate::meet::Seen;
use crate::nearby::Nearby;
use crate::quick::{Asked, Rays};
use crate::ray::Ray;
use crate::sample::Sample;
use crate::scratch::Scratch;
use crate::shade::{clamp, towards};
use crate::slabs::{Slabs, Space};
use crate::stats::Stats;
use crate::walk::{Bundle, Quest};
use crate::workspace::{Shadow, State, Workspace};
use crate::world::World;
use glam::{DVec3, Vec3};
use scene::{Light, LightKind};

/// Largest distance of a hit from a patch's first one, over the width of the rays that are seen
/// together.
const PATCH: f64 = 3.0;

/// Returns direction and distance of a light that are the same everywhere.
pub(crate) fn towards_distant(light: &Light) -> Option<(DVec3, f64)> {
    matches!(light.kind, LightKind::Distant { .. }).then(|| towards(light, DVec3::ZERO))
}

/// Returns the ray from a place to a light, if it leaves the surface there and the light shines
/// that way. `distant` is from [`towards_distant`]; the place has a normal, and a height above the
/// surface at which rays start.
#[inline]
pub(crate) fn shadow(
    light: &Light,
    distant: Option<(DVec3, f64)>,
    hit: (usize, usize),
    (position, normal, lift): (DVec3, DVec3, f64),
    depth: f64,
) -> Option<Shadow> {
    let (direction, limit) = distant.unwrap_or_else(|| towards(light, position));
    let is_lit = normal.dot(direction) > 0.0 && light.share(position) > 0.0;
    is_lit.then(|| Shadow {
        hit,
        ray: Ray {
            origin: position + normal * lift,
            direction,
        },
        limit,
        depth,
        state: State::Unknown,
        cost: 0.0,
    })
}

impl World {
    /// Takes samples with the rays of some packets, and leaves them in the working space. Their
    /// hits may share beams to the lights: they must be the same packets whatever the tiles.
    /// `across` is their width together, per unit of distance, or less, if only nearer hits are to
    /// share.
    pub fn shine(&self, seen: &[Seen], across: f64, work: &mut Workspace, stats: &mut Stats) {
        let mut samples = core::mem::take(&mut work.samples);
        samples.clear();
        samples.extend(seen.iter().map(|seen| {
            core::array::from_fn(|i| {
                let hit = seen.hits[i].as_ref();
                Sample {
                    colour: hit.map_or(self.background, |hit| hit.finish.glow()),
                    key: hit.map_or(0, |hit| hit.surface << 8),
                    depth: hit.map_or(f32::INFINITY, |hit| hit.t as f32),
                    cost: seen.costs[i],
                }
            })
        }));
        let mut shadows = core::mem::take(&mut work.shadows);
        for (which, light) in self.lights.iter().enumerate() {
            let distant = towards_distant(light);
            shadows.clear();
            for (k, seen) in seen.iter().enumerate() {
                for (i, hit) in seen.hits.iter().enumerate() {
                    let Some(hit) = hit else { continue };
                    let normal = hit.facing(seen.rays[i].direction);
                    let place = (hit.position, normal, hit.lift);
                    shadows.extend(shadow(light, distant, (k, i), place, hit.t));
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
                let view = seen[k].rays[i].direction;
                sample.colour += hit.finish.shade(
                    Vec3::from(light.colour) * light.share(hit.position) as f32,
                    hit.facing(view).as_vec3(),
                    shadow.ray.direction.as_vec3(),
                    view.as_vec3(),
                );
                sample.key ^= 1 << (which % 8);
            }
        }
        work.shadows = shadows;
        for sample in samples.iter_mut().flatten() {
            sample.colour = clamp(sample.colour);
        }
        work.samples = samples;
    }

    /// Decides which rays to a light meet a surface before it.
    pub fn look_for_shadows(
        &self,
        shadows: &mut [Shadow],
        across: f64,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        self.look_for_others(shadows, work, stats);
        if self.soft.is_empty() {
            return;
        }
        // Hits on different parts of the surface would make a beam that is wide from its start:
        // each patch of neighbouring hits gets its own.
        while let Some(leader) = shadows.iter().position(|s| s.state == State::Unknown) {
            let (first, depth) = (shadows[leader].ray.origin, shadows[leader].depth);
            let patch = PATCH * across * depth;
            self.look_at_members(
                &mut shadows[leader..],
                |shadow| shadow.ray.origin.distance(first) <= patch,
                work,
                stats,
            );
        }
    }

    /// Decides which rays, in any directions, meet a surface before their ends: those that run
    /// together share a beam.
    pub fn look_for_shadows_apart(
        &self,
        shadows: &mut [Shadow],
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        self.look_for_others(shadows, work, stats);
        if self.soft.is_empty() {
            return;
        }
        while let Some(leader) = shadows.iter().position(|s| s.state == State::Unknown) {
            let first = shadows[leader].ray;
            self.look_at_members(
                &mut shadows[leader..],
                |shadow| first.runs_with(&shadow.ray),
                work,
                stats,
            );
        }
    }

    /// Darkens the rays that meet a hard element, or enter a body that is met ray by ray, before
    /// their ends.
    fn look_for_others(&self, shadows: &mut [Shadow], work: &mut Workspace, stats: &mut Stats) {
        for shadow in shadows {
            shadow.cost = 1.0;
            let (ray, limit) = (&shadow.ray, shadow.limit);
            let solid = self.solids.first(ray, limit, false, &mut work.crossings);
            if solid.is_some() || self.other_darkens(shadow, stats) {
                shadow.state = State::Dark;
            }
        }
    }

    /// Decides the first of some rays, and with it those of the others that belong to its patch.
    fn look_at_members(
        &self,
        shadows: &mut [Shadow],
        belongs: impl Fn(&Shadow) -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        for shadow in &mut *shadows {
            if shadow.state == State::Unknown && belongs(shadow) {
                shadow.state = State::Asked;
            }
        }
        // The first one is in its own patch even where its position is not a number.
        shadows[0].state = State::Asked;
        let mut members: Vec<&mut Shadow> = shadows
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

    /// Whether a ray to a light enters a body that is met ray by ray before its end.
    fn other_darkens(&self, shadow: &mut Shadow, stats: &mut Stats) -> bool {
        self.others.iter().any(|body| {
            let (found, cost) = body.first(&shadow.ray, shadow.limit, Quest::Entry);
            stats.field_evaluations += cost;
            shadow.cost += cost as f32;
            found.is_some()
        })
    }

    /// Darkens those rays of a patch that enter a convolution surface before their ends.
    fn look_from_a_patch(
        &self,
        patch: &mut [&mut Shadow],
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        let starts: &[Ray] = &patch.iter().map(|shadow| shadow.ray).collect::<Vec<_>>();
        let Some(beam) = Beam::around(starts) else {
            return;
        };
        let furthest = patch.iter().map(|shadow| shadow.limit).fold(0.0, f64::max);
        let mut near = core::mem::take(&mut work.around);
        let mut general = core::mem::take(&mut work.general);
        let near_blobs = self.general_from_a_patch(&beam, furthest, &mut near, &mut general);
        let mut slabs: Vec<(u32, Option<(Slabs<'_>, f64)>)> = Vec::new();
        for (number, packet) in patch.chunks_mut(PACKET).enumerate() {
            work.begin();
            let mut alive = (1u32 << packet.len()) - 1;
            // Lanes not in use repeat the first ray.
            let lanes: [usize; PACKET] =
                core::array::from_fn(|i| if i < packet.len() { i } else { 0 });
            let rays = lanes.map(|i| packet[i].ray);
            let limits = lanes.map(|i| packet[i].limit);
            let scratch = &mut work.scratch;
            let mut bodies: Vec<u32> = general.iter().map(|&(_, body)| body).collect();
            let mut dark = 0;
            if near_blobs {
                let asked = Asked {
                    limits: &limits,
                    alive,
                    quest: Quest::Entry,
                };
                let left;
                (dark, left) = self.enter_blobs(&near, &bodies, &rays, asked, scratch);
                bodies.extend(left);
                alive &= !dark;
            }
            for body in bodies {
                if alive == 0 {
                    break;
                }
                let (soft, far) = (&self.soft, &mut scratch.far);
                let entered = soft.far_first(body, &rays, &limits, alive, Quest::Entry, far);
                scratch.evaluations += core::mem::take(&mut far.evaluations);
                if let Some(met) = entered {
                    dark |= met;
                    alive &= !met;
                    continue;
                }
                let at = match slabs.iter().position(|(own, _)| *own == body) {
                    Some(at) => at,
                    None => {
                        let spaces = &mut scratch.spaces;
                        let made = self.slabs_from_a_patch(body, starts, beam, furthest, spaces);
                        slabs.push((body, made));
                        slabs.len() - 1
                    }
                };
                let Some((slabs, base)) = &mut slabs[at].1 else {
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
                let found = self.soft.walk(body, slabs, bundle, Quest::Entry, scratch);
                let met = found.iter().fold(0, |met, hit| met | 1 << hit.lane);
                dark |= met;
                alive &= !met;
            }
            darken(packet, dark, work, stats);
        }
        for (slabs, _) in slabs.into_iter().filter_map(|(_, slabs)| slabs) {
            stats.field_evaluations += slabs.evaluations();
            work.scratch.spaces.push(slabs.into_space());
        }
        work.around = near;
        work.general = general;
    }

    /// Lists the blobs near the rays of a patch, and the bodies that take the general way. Returns
    /// whether there may be other bodies, which are all blobs.
    pub fn general_from_a_patch(
        &self,
        beam: &Beam,
        furthest: f64,
        near: &mut Nearby,
        general: &mut Vec<(f64, u32)>,
    ) -> bool {
        general.clear();
        let one = self.soft.bodies.len() == 1;
        if !self.soft.list_blobs(beam, furthest, near) {
            if one {
                general.push((0.0, 0));
            } else {
                self.soft.bodies_along(beam, furthest, general);
            }
            return false;
        }
        let bodies = 0..self.soft.bodies.len() as u32;
        let mut met: Vec<u32> = bodies.filter(|&b| self.soft.is_everywhere(b)).collect();
        self.soft.bodies_met(&near.others, beam, furthest, &mut met);
        general.extend(met.into_iter().map(|body| (0.0, body)));
        !one || general.is_empty()
    }

    /// Returns the slabs of a body along the rays of a patch.
    fn slabs_from_a_patch<'a>(
        &'a self,
        body: u32,
        starts: &'a [Ray],
        beam: Beam,
        furthest: f64,
        spaces: &mut Vec<Space>,
    ) -> Option<(Slabs<'a>, f64)> {
        let levels = starts.len().div_ceil(PACKET).next_power_of_two().ilog2();
        self.soft.slabs(
            body,
            beam,
            |base| {
                Beams::tree(levels, move |number| {
                    let path = number + 1;
                    let count = PACKET << (levels - path.ilog2());
                    let first = count * (path - (1 << path.ilog2()));
                    let part = first..starts.len().min(first + count);
                    let part = starts.get(part).and_then(Beam::around);
                    part.unwrap_or(beam).from(base)
                })
            },
            furthest,
            spaces,
        )
    }

    /// Returns the rays of a packet that enter the surface of a body near which they meet nothing
    /// but blobs, a bit each, and the bodies whose march gave up.
    fn enter_blobs(
        &self,
        near: &Nearby,
        general: &[u32],
        rays: &[Ray; PACKET],
        asked: Asked<'_>,
        scratch: &mut Scratch,
    ) -> (u32, Vec<u32>) {
        let Scratch {
            quick, evaluations, ..
        } = scratch;
        let lanes = Rays::new(rays, near);
        if self.soft.bodies.len() == 1 {
            return match self.soft.quick(near, &lanes, &|| *rays, asked, quick) {
                Some(looked) => {
                    *evaluations += looked.evaluations;
                    (looked.met, Vec::new())
                }
                None => (0, vec![0]),
            };
        }
        let (limits, mut dark) = (*asked.limits, 0);
        let left = self.soft.quick_each(
            near,
            general,
            &lanes,
            &|| *rays,
            asked,
            quick,
            |looked, _| {
                *evaluations += looked.evaluations;
                dark |= looked.met;
                (limits, asked.alive & !dark)
            },
        );
        (dark, left)
    }
}

/// Sets the states of the rays of a packet, given the dark ones, a bit each, and their costs.
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
