//! Tracing a packet of rays: hits, shadows, colours.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::flesh::Flesh;
use crate::hard::Crossing;
use crate::lens::{Fan, Lens};
use crate::map;
use crate::nearby::Nearby;
use crate::picture::{Picture, Stats};
use crate::quick::Rays;
use crate::ray::Ray;
use crate::sample::Sample;
use crate::shade::{Finish, towards};
use crate::slabs::Slabs;
use crate::soft::{PACKET, Scratch};
use crate::walk::{Bundle, Quest};
use glam::{DVec3, Vec3};
use scene::LightKind;

/// Where a ray hits, and what it hits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub t: f64,
    pub position: DVec3,
    /// Unit, towards the eye's side.
    pub normal: DVec3,
    /// How far rays to the lights must start above the surface.
    pub lift: f64,
    pub finish: Finish,
    /// 1 for the soft surface, 2 and up for hard elements.
    pub thing: u32,
}

/// What is known of the soft surface near a packet's rays.
pub(crate) enum Near<'n, 's> {
    /// There is none.
    Nothing,
    /// Lumps alone, and what makes rays for them, if they can be made so.
    Lumps(&'n Nearby, Option<&'n Lens>),
    /// The slabs of a beam around the rays, with the parameter at which they start; and the packet's number among
    /// the beam's divisions.
    Slabs(&'n mut (Slabs<'s>, f64), usize),
}

/// Working space of one thread.
#[derive(Default)]
pub struct Workspace {
    pub(crate) scratch: Scratch,
    crossings: Vec<Crossing>,
}

impl Picture {
    /// Traces the rays of one packet.
    pub(crate) fn packet(
        &self,
        rays: &[Ray; PACKET],
        near: Near<'_, '_>,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> [Sample; PACKET] {
        work.scratch.evaluations = 0;
        work.scratch.alone = [0; PACKET];
        let mut hits = if self.solids.is_empty() {
            [None; PACKET]
        } else {
            rays.map(|ray| self.hard_hit(&ray, work))
        };
        if let Some(digger) = &self.digger {
            self.dug_hits(&**digger, rays, work, &mut hits);
        } else {
            match near {
                Near::Nothing => {}
                Near::Slabs((slabs, base), number) => {
                    self.soft_hits(rays, number, slabs, *base, work, &mut hits);
                }
                Near::Lumps(near, _) => self.lump_hits(rays, near, work, &mut hits),
            }
        }
        self.shine(rays, &hits, work, stats)
    }

    /// Traces the rays of one packet in a scene of lumps alone. `None` if this is not the way to do it.
    pub(crate) fn lump_packet(
        &self,
        lens: &Lens,
        fan: &Fan,
        near: &Nearby,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<[Sample; PACKET]> {
        let rays = lens.rays(fan, near);
        let limits = [f64::INFINITY; PACKET];
        let quick = &mut work.scratch.quick;
        let looked = self
            .soft
            .quick(near, &rays, &limits, ALL, Quest::First, quick)?;
        work.scratch.evaluations = looked.evaluations;
        work.scratch.alone = [0; PACKET];
        if looked.met == 0 {
            stats.field_evaluations += looked.evaluations;
            let cost = map::costs([1; PACKET], looked.evaluations, &work.scratch.alone);
            let nothing = self.nothing();
            return Some(cost.map(|cost| Sample { cost, ..nothing }));
        }
        let rays = lens.wide(fan);
        let mut hits = [None; PACKET];
        self.clothe(&rays, &looked.flesh, near.base, looked.met, &mut hits);
        Some(self.shine(&rays, &hits, work, stats))
    }

    /// What rays see that hit something or nothing.
    fn shine(
        &self,
        rays: &[Ray; PACKET],
        hits: &[Option<Hit>; PACKET],
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> [Sample; PACKET] {
        let across = rays[0].direction.distance(rays[PACKET - 1].direction);
        let mut colours = [self.background; PACKET];
        let mut keys = [0u32; PACKET];
        let mut cast = [1u32; PACKET];
        for i in 0..PACKET {
            if let Some(hit) = &hits[i] {
                colours[i] = hit.finish.glow();
                keys[i] = hit.thing << 8;
            }
        }
        for (which, light) in self.lights.iter().enumerate() {
            let mut lit = 0u32;
            // From a distant light it is the same everywhere.
            let mut way = [towards(light, DVec3::ZERO); PACKET];
            let distant = matches!(light.kind, LightKind::Distant { .. });
            for i in 0..PACKET {
                if let Some(hit) = &hits[i] {
                    if !distant {
                        way[i] = towards(light, hit.position);
                    }
                    if hit.normal.dot(way[i].0) > 0.0 {
                        lit |= 1 << i;
                    }
                }
            }
            if light.shadow && lit != 0 {
                stats.shadow_rays += u64::from(lit.count_ones());
                for (i, cast) in cast.iter_mut().enumerate() {
                    *cast += lit >> i & 1;
                }
                lit &= !self.shadowed(hits, &way, lit, across, work);
            }
            for i in 0..PACKET {
                if let (Some(hit), true) = (&hits[i], lit >> i & 1 != 0) {
                    colours[i] += hit.finish.lit(
                        Vec3::from(light.colour),
                        hit.normal.as_vec3(),
                        way[i].0.as_vec3(),
                        rays[i].direction.as_vec3(),
                    );
                    keys[i] ^= 1 << (which % 8);
                }
            }
        }
        stats.field_evaluations += work.scratch.evaluations;
        let cost = map::costs(cast, work.scratch.evaluations, &work.scratch.alone);
        core::array::from_fn(|i| Sample {
            colour: colours[i].max(Vec3::ZERO).min(Vec3::ONE),
            key: keys[i],
            depth: hits[i].map_or(f32::INFINITY, |h| h.t as f32),
            cost: cost[i],
        })
    }

    fn hard_hit(&self, ray: &Ray, work: &mut Workspace) -> Option<Hit> {
        let (number, crossing) = self.solids.first(ray, f64::INFINITY, &mut work.crossings)?;
        let facing = if crossing.normal.dot(ray.direction) > 0.0 {
            -crossing.normal
        } else {
            crossing.normal
        };
        Some(Hit {
            t: crossing.t,
            position: ray.at(crossing.t),
            normal: facing,
            lift: 1e-6 * (1.0 + crossing.t),
            finish: self.finishes[self.solids.material(number)],
            thing: number + 2,
        })
    }

    fn soft_hits(
        &self,
        rays: &[Ray; PACKET],
        number: usize,
        slabs: &mut Slabs<'_>,
        base: f64,
        work: &mut Workspace,
        hits: &mut [Option<Hit>; PACKET],
    ) {
        let based = rays.map(|r| Ray {
            origin: r.at(base),
            direction: r.direction,
        });
        let limits: [f64; PACKET] =
            core::array::from_fn(|i| hits[i].map_or(f64::INFINITY, |h| h.t - base));
        let scratch = &mut work.scratch;
        let bundle = Bundle {
            rays: &based,
            limits: &limits,
            alive: ALL,
            number,
        };
        let found = self.soft.walk(slabs, bundle, Quest::First, scratch);
        if found.is_empty() {
            return;
        }
        let flesh = self.soft.flesh(slabs, &based, base, &found, scratch);
        let met = found.iter().fold(0, |m, hit| m | 1u32 << hit.lane);
        self.clothe(rays, &flesh, base, met, hits);
    }

    /// The hits on a surface of lumps alone.
    fn lump_hits(
        &self,
        rays: &[Ray; PACKET],
        near: &Nearby,
        work: &mut Workspace,
        hits: &mut [Option<Hit>; PACKET],
    ) {
        let limits = core::array::from_fn(|i| hits[i].map_or(f64::INFINITY, |h| h.t));
        let scratch = &mut work.scratch;
        let lanes = Rays::new(rays, near);
        let Some(looked) =
            self.soft
                .quick(near, &lanes, &limits, ALL, Quest::First, &mut scratch.quick)
        else {
            let beam = Beam::around(rays);
            let slabs = beam.and_then(|beam| {
                let whole = |base: f64| Beams::one(beam.from(base));
                self.soft
                    .slabs(beam, whole, f64::INFINITY, &mut scratch.spaces)
            });
            if let Some((mut slabs, base)) = slabs {
                self.soft_hits(rays, 0, &mut slabs, base, work, hits);
                work.scratch.spaces.push(slabs.into_space());
            }
            return;
        };
        scratch.evaluations += looked.evaluations;
        self.clothe(rays, &looked.flesh, near.base, looked.met, hits);
    }

    /// Makes hits of what is known of the surface where rays meet it.
    fn clothe(
        &self,
        rays: &[Ray; PACKET],
        flesh: &Flesh,
        base: f64,
        met: u32,
        hits: &mut [Option<Hit>; PACKET],
    ) {
        for lane in (0..PACKET).filter(|lane| met >> lane & 1 != 0) {
            let ray = &rays[lane];
            let gradient = flesh.gradient[lane];
            let steepness = gradient.length();
            let Some(mut normal) = (-gradient).try_normalize() else {
                continue;
            };
            if normal.dot(ray.direction) > 0.0 {
                normal = -normal;
            }
            let t = base + flesh.t[lane];
            let finish = match &flesh.weights[..] {
                [(only, _)] => self.finishes[*only as usize],
                several => {
                    let mut finish = Finish::default();
                    let total: f32 = several.iter().map(|(_, w)| w[lane]).sum();
                    for (material, weight) in several {
                        let share = weight[lane] / total;
                        if share > 0.0 {
                            finish.mix(&self.finishes[*material as usize], share);
                        }
                    }
                    finish
                }
            };
            hits[lane] = Some(Hit {
                t,
                position: ray.at(t),
                normal,
                lift: (4.0 * self.soft.precision.last / steepness).min(5e-3) + 1e-6,
                finish,
                thing: 1,
            });
        }
    }

    /// Which of the lit hits have something between them and the light. `across` is the packet's
    /// width per unit of distance.
    fn shadowed(
        &self,
        hits: &[Option<Hit>; PACKET],
        way: &[(DVec3, f64); PACKET],
        lit: u32,
        across: f64,
        work: &mut Workspace,
    ) -> u32 {
        let mut rays = [None; PACKET];
        let mut limits = [0.0; PACKET];
        let mut dark = 0;
        for i in 0..PACKET {
            if let (Some(hit), true) = (&hits[i], lit >> i & 1 != 0) {
                let ray = Ray {
                    origin: hit.position + hit.normal * hit.lift,
                    direction: way[i].0,
                };
                limits[i] = way[i].1;
                if self
                    .solids
                    .first(&ray, limits[i], &mut work.crossings)
                    .is_some()
                {
                    dark |= 1 << i;
                } else {
                    rays[i] = Some(ray);
                }
            }
        }
        // Hits on different parts of the surface would make a beam that is wide from its start:
        // each patch of neighbouring hits gets its own.
        let mut left = rays;
        while let Some(leader) = left.iter().position(Option::is_some) {
            let (Some(first), Some(hit)) = (left[leader], &hits[leader]) else {
                break;
            };
            let patch = PATCH * across * hit.t;
            let mut group = [None; PACKET];
            for (member, ray) in group.iter_mut().zip(&mut left) {
                if ray.is_some_and(|r| r.origin.distance(first.origin) <= patch) {
                    *member = ray.take();
                }
            }
            // The leader is in its own group even where its position is not a number.
            group[leader] = group[leader].or(left[leader].take());
            dark |= self.occluded(&group, &limits, work);
        }
        dark
    }

    /// Which of some rays (those that are there) enter the soft surface before their limits.
    fn occluded(
        &self,
        rays: &[Option<Ray>; PACKET],
        limits: &[f64; PACKET],
        work: &mut Workspace,
    ) -> u32 {
        if let Some(digger) = &self.digger {
            return self.dug_shadows(&**digger, rays, limits, work);
        }
        let alive: Vec<Ray> = rays.iter().flatten().copied().collect();
        let Some(any) = alive.first() else {
            return 0;
        };
        let followed = (0..PACKET).fold(0, |m, i| m | u32::from(rays[i].is_some()) << i);
        let filled = rays.map(|ray| ray.unwrap_or(*any));
        let quick = &mut work.scratch.quick;
        if let Some((looked, _)) =
            self.soft
                .quick_alone(&filled, limits, followed, Quest::Entry, quick)
        {
            work.scratch.evaluations += looked.evaluations;
            return looked.met;
        }
        let Some(beam) = Beam::around(&alive) else {
            return 0;
        };
        let furthest = limits.iter().copied().fold(0.0, f64::max);
        let whole = |base: f64| Beams::one(beam.from(base));
        let Some((mut slabs, base)) =
            self.soft
                .slabs(beam, whole, furthest, &mut work.scratch.spaces)
        else {
            return 0;
        };
        // Lanes not in use repeat the first one.
        let based = filled.map(|ray| Ray {
            origin: ray.at(base),
            direction: ray.direction,
        });
        let limits = limits.map(|l| l - base);
        let bundle = Bundle {
            rays: &based,
            limits: &limits,
            alive: followed,
            number: 0,
        };
        let found = self
            .soft
            .walk(&mut slabs, bundle, Quest::Entry, &mut work.scratch);
        work.scratch.spaces.push(slabs.into_space());
        found.iter().fold(0, |m, hit| m | 1 << hit.lane)
    }
}

/// Hits further apart than this times the packet's width there are on different patches.
const PATCH: f64 = 3.0;

/// All lanes of a packet.
const ALL: u32 = (1 << PACKET) - 1;
