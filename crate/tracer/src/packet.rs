//! What the rays of a packet hit.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::flesh::Flesh;
use crate::hard::Crossing;
use crate::lens::{Fan, Lens};
use crate::map;
use crate::nearby::Nearby;
use crate::picture::{Picture, Stats};
use crate::quick::{Asked, Rays};
use crate::ray::Ray;
use crate::sample::Sample;
use crate::shade::Finish;
use crate::shadows::Shadow;
use crate::slabs::Slabs;
use crate::soft::{PACKET, Scratch};
use crate::walk::{Bundle, Quest};
use field::Cut;
use glam::DVec3;

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

/// Rays of a packet, and what they hit.
pub(crate) struct Seen {
    pub rays: [Ray; PACKET],
    pub hits: [Option<Hit>; PACKET],
    /// What finding them cost.
    pub costs: [f32; PACKET],
}

impl Default for Seen {
    fn default() -> Self {
        let ray = Ray {
            origin: DVec3::ZERO,
            direction: DVec3::X,
        };
        Self {
            rays: [ray; PACKET],
            hits: [None; PACKET],
            costs: [0.0; PACKET],
        }
    }
}

impl Seen {
    /// Whether any of the rays hit something.
    pub fn something(&self) -> bool {
        self.hits.iter().any(Option::is_some)
    }
}

/// Working space of one thread.
#[derive(Default)]
pub struct Workspace {
    pub(crate) scratch: Scratch,
    pub(crate) crossings: Vec<Crossing>,
    /// Rays to a light.
    pub(crate) shadows: Vec<Shadow>,
    /// What is near those of a patch.
    pub(crate) around: Nearby,
    pub(crate) samples: Vec<[Sample; PACKET]>,
}

impl Workspace {
    /// Counts from nothing again what is made for a packet.
    pub(crate) fn begin(&mut self) {
        self.scratch.evaluations = 0;
        self.scratch.alone = [0; PACKET];
    }

    /// What that cost each of the packet's first rays.
    pub(crate) fn costs(&self, rays: usize) -> [f32; PACKET] {
        map::costs(rays, self.scratch.evaluations, &self.scratch.alone)
    }
}

impl Picture {
    /// Traces the rays of one packet, given in `seen`, and says there what they hit.
    pub(crate) fn packet(
        &self,
        near: Near<'_, '_>,
        seen: &mut Seen,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        work.begin();
        let Seen { rays, hits, .. } = seen;
        for (hit, ray) in hits.iter_mut().zip(&*rays) {
            *hit = None;
            if !self.solids.is_empty() {
                *hit = self.hard_hit(ray, work);
            }
        }
        if let Some(digger) = &self.digger {
            self.dug_hits(&**digger, rays, work, hits);
        } else {
            match near {
                Near::Nothing => {}
                Near::Slabs((slabs, base), number) => {
                    self.soft_hits(rays, number, slabs, *base, work, hits);
                }
                Near::Lumps(near, _) => self.lump_hits(rays, near, work, hits),
            }
        }
        stats.field_evaluations += work.scratch.evaluations;
        seen.costs = work.costs(PACKET);
    }

    /// Traces the rays of one packet that comes near nothing but lumps, and says in `seen` what they hit; their rays, too,
    /// if they hit anything. `None` if this is not the way to do it.
    pub(crate) fn lump_packet(
        &self,
        lens: &Lens,
        fan: &Fan,
        near: &Nearby,
        seen: &mut Seen,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<()> {
        let rays = lens.rays(fan, near);
        let limits = [f64::INFINITY; PACKET];
        work.begin();
        let quick = &mut work.scratch.quick;
        let looked = self.soft.quick(
            near,
            &rays,
            &|| lens.wide(fan),
            Asked::first(&limits),
            quick,
        )?;
        work.scratch.evaluations = looked.evaluations;
        stats.field_evaluations += looked.evaluations;
        seen.costs = work.costs(PACKET);
        seen.hits = [None; PACKET];
        if looked.met != 0 {
            seen.rays = lens.wide(fan);
            let flesh = &work.scratch.quick.flesh;
            self.clothe(&seen.rays, flesh, near.base, looked.met, &mut seen.hits);
        }
        Some(())
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
        self.soft.flesh(slabs, &based, base, &found, scratch);
        let met = found.iter().fold(0, |m, hit| m | 1u32 << hit.lane);
        self.clothe(rays, &scratch.flesh, base, met, hits);
    }

    /// The hits of a packet that comes near nothing but lumps.
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
        let Some(looked) = self.soft.quick(
            near,
            &lanes,
            &|| *rays,
            Asked::first(&limits),
            &mut scratch.quick,
        ) else {
            let beam = Beam::around(rays);
            let slabs = beam.and_then(|beam| {
                let whole = |base: f64| Beams::one(beam.from(base));
                self.soft
                    .slabs(beam, whole, f64::INFINITY, &mut scratch.spaces)
            });
            if let Some((mut slabs, base)) = slabs {
                self.soft_hits(rays, 0, &mut slabs, base, work, hits);
                work.scratch.evaluations += slabs.evaluations();
                work.scratch.spaces.push(slabs.into_space());
            }
            return;
        };
        scratch.evaluations += looked.evaluations;
        self.clothe(rays, &scratch.quick.flesh, near.base, looked.met, hits);
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
        let gradients = flesh.gradients();
        for lane in (0..PACKET).filter(|lane| met >> lane & 1 != 0) {
            let ray = &rays[lane];
            let gradient = gradients[lane];
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
                    let total: f32 = several.iter().map(|(_, w)| w.to_array()[lane]).sum();
                    for (material, weight) in several {
                        let share = weight.to_array()[lane] / total;
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
                lift: (4.0 * self.soft.precision.last / steepness).at_most(5e-3) + 1e-6,
                finish,
                thing: 1,
            });
        }
    }
}

/// All lanes of a packet.
const ALL: u32 = (1 << PACKET) - 1;
