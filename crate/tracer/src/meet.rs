//! The surface points that rays meet first.
//!
//! The nearest crossing wins, whatever it belongs to: hard elements, the convolution surface of
//! each body, and the surfaces of bodies that are met ray by ray are asked one after the other,
//! each only as far as the rays still go.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::hard::Crossing;
use crate::layout::{PACKET, lanes_in};
use crate::lens::{Fan, Lens};
use crate::nearby::Nearby;
use crate::quick::{Asked, Looked, Rays};
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::shade::Finish;
use crate::slabs::Slabs;
use crate::square::Square;
use crate::stats::Stats;
use crate::surface_samples::SurfaceSamples;
use crate::walk::{Bundle, Quest};
use crate::workspace::Workspace;
use crate::world::{SurfacePoint, World};
use field::Cut;
use glam::DVec3;

/// Rays of a packet, and their hits.
pub(crate) struct Seen {
    pub rays: [Ray; PACKET],
    pub hits: [Option<SurfacePoint>; PACKET],
    /// Cost of finding each hit.
    pub costs: [f32; PACKET],
    /// Number of rays in use, the first ones; the others repeat one of them.
    pub used: usize,
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
            used: PACKET,
        }
    }
}

impl Seen {
    /// Whether any of the rays has a hit.
    pub fn has_hit(&self) -> bool {
        self.hits.iter().any(Option::is_some)
    }

    /// Returns the end of each ray: the parameter of its hit, else infinity.
    pub fn limits(&self) -> [f64; PACKET] {
        self.hits.map(|hit| hit.map_or(f64::INFINITY, |hit| hit.t))
    }
}

/// Functions that make a packet's rays.
pub(crate) struct PacketRays<'r> {
    /// Makes them in single precision, for blobs.
    pub fan: &'r dyn Fn(&Lens) -> Fan,
    /// Makes them in double precision.
    pub exact: &'r dyn Fn() -> [Ray; PACKET],
}

/// Bits of all lanes of a packet.
pub(crate) const ALL: u32 = (1 << PACKET) - 1;

impl World {
    /// Finds the first hits of the rays of the packet in a column and row of a square; they go into
    /// `seen`, with the rays if there is a hit.
    pub fn meet(
        &self,
        square: &mut Square<'_>,
        place: [u32; 2],
        rays: &PacketRays<'_>,
        seen: &mut Seen,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        work.begin();
        seen.hits = [None; PACKET];
        let mut exact = false;
        if !self.only_soft() {
            seen.rays = (rays.exact)();
            exact = true;
        }
        if !self.solids.is_empty() {
            for (hit, ray) in seen.hits.iter_mut().zip(&seen.rays) {
                *hit = self.hard_point(ray, self.one_sided, &mut work.crossings);
            }
        }
        self.meet_soft(square, place, rays, seen, &mut exact, work);
        if !self.others.is_empty() {
            self.meet_others(seen, ALL, &mut work.scratch);
        }
        stats.field_evaluations += work.scratch.evaluations;
        seen.costs = work.costs(PACKET);
    }

    /// Replaces hits by points on convolution surfaces that are nearer.
    fn meet_soft(
        &self,
        square: &mut Square<'_>,
        place: [u32; 2],
        rays: &PacketRays<'_>,
        seen: &mut Seen,
        exact: &mut bool,
        work: &mut Workspace,
    ) {
        let mut general = core::mem::take(&mut work.general);
        square.general(place, &mut general);
        // One body that is not all blobs takes the general way with all it has.
        let by_blobs = self.soft.bodies.len() > 1 || general.is_empty();
        if let Some((near, lens)) = square
            .blobs(place)
            .filter(|(near, _)| by_blobs && near.len() > 0)
        {
            self.meet_blobs(near, lens, &general, rays, seen, exact, work);
        }
        for &(from, body) in &general {
            if seen.limits().iter().all(|&limit| limit <= from) {
                continue;
            }
            if self.soft.is_far(body) {
                self.make_exact(rays, seen, exact);
                if self.meet_far(body, ALL, seen, &mut work.scratch) {
                    continue;
                }
            }
            if let Some((slabs, base, number)) = square.slabs(body, place, &mut work.scratch) {
                self.make_exact(rays, seen, exact);
                self.meet_slabs(body, slabs, base, (number, ALL), seen, &mut work.scratch);
            }
        }
        work.general = general;
    }

    /// Replaces hits by nearer points on bodies near which a packet meets nothing but blobs,
    /// passing over those bodies that take the general way.
    #[expect(clippy::too_many_arguments, reason = "they form no group")]
    fn meet_blobs(
        &self,
        near: &Nearby,
        lens: Option<&Lens>,
        general: &[(f64, u32)],
        rays: &PacketRays<'_>,
        seen: &mut Seen,
        exact: &mut bool,
        work: &mut Workspace,
    ) {
        let mut left = match lens {
            Some(lens) if !*exact => {
                let fan = (rays.fan)(lens);
                let lanes = lens.rays(&fan, near);
                let wide = || lens.wide(&fan);
                let left = self.meet_blobs_by(near, general, &lanes, &wide, ALL, seen, work);
                if seen.has_hit() {
                    seen.rays = wide();
                }
                left
            }
            _ => {
                self.make_exact(rays, seen, exact);
                let lanes = Rays::new(&seen.rays, near);
                let wide = seen.rays;
                self.meet_blobs_by(near, general, &lanes, &|| wide, ALL, seen, work)
            }
        };
        if !left.is_empty() && !*exact {
            // The march may succeed with rays in double precision.
            self.make_exact(rays, seen, exact);
            let lanes = Rays::new(&seen.rays, near);
            let wide = seen.rays;
            let others = (0..self.soft.bodies.len() as u32).filter(|body| !left.contains(body));
            let others: Vec<(f64, u32)> = others.map(|body| (0.0, body)).collect();
            left = self.meet_blobs_by(near, &others, &lanes, &|| wide, ALL, seen, work);
        }
        for body in left {
            let scratch = &mut work.scratch;
            let slabs = Beam::around(&seen.rays).and_then(|beam| {
                self.soft.slabs(
                    body,
                    beam,
                    |base| Beams::one(beam.from(base)),
                    f64::INFINITY,
                    &mut scratch.spaces,
                )
            });
            if let Some((mut slabs, base)) = slabs {
                self.meet_slabs(body, &mut slabs, base, (0, ALL), seen, scratch);
                scratch.evaluations += slabs.evaluations();
                scratch.spaces.push(slabs.into_space());
            }
        }
    }

    /// Makes the rays in double precision, unless that is done.
    fn make_exact(&self, rays: &PacketRays<'_>, seen: &mut Seen, exact: &mut bool) {
        if !*exact {
            seen.rays = (rays.exact)();
            *exact = true;
        }
    }

    /// Replaces hits of some lanes by nearer points on bodies near which a packet meets nothing but
    /// blobs, given its rays in single precision; `wide` returns them in double precision. Returns
    /// the bodies whose march gave up.
    #[expect(clippy::too_many_arguments, reason = "they form no group")]
    pub fn meet_blobs_by(
        &self,
        near: &Nearby,
        general: &[(f64, u32)],
        lanes: &Rays,
        wide: &dyn Fn() -> [Ray; PACKET],
        alive: u32,
        seen: &mut Seen,
        work: &mut Workspace,
    ) -> Vec<u32> {
        let limits = seen.limits();
        let Scratch {
            quick, evaluations, ..
        } = &mut work.scratch;
        let mut tell = |looked: Looked, samples: &SurfaceSamples| {
            *evaluations += looked.evaluations;
            if looked.met != 0 {
                self.soft_points(
                    looked.body,
                    &wide(),
                    samples,
                    near.base,
                    looked.met,
                    &mut seen.hits,
                );
            }
            (seen.limits(), alive)
        };
        if self.soft.bodies.len() == 1 {
            let looked = self
                .soft
                .quick(near, lanes, wide, Asked::first(&limits, alive), quick);
            return match looked {
                Some(looked) => {
                    tell(looked, &quick.samples);
                    Vec::new()
                }
                None => vec![0],
            };
        }
        let general: Vec<u32> = general.iter().map(|&(_, body)| body).collect();
        let asked = Asked::first(&limits, alive);
        self.soft
            .quick_each(near, &general, lanes, wide, asked, quick, tell)
    }

    /// Replaces hits of some lanes by nearer points on the surface of a body of very many points
    /// that never end. Returns false if the rays must be followed in another way.
    pub fn meet_far(&self, body: u32, alive: u32, seen: &mut Seen, scratch: &mut Scratch) -> bool {
        let limits = seen.limits();
        let met = self.soft.far_first(
            body,
            &seen.rays,
            &limits,
            alive,
            Quest::First,
            &mut scratch.far,
        );
        scratch.evaluations += core::mem::take(&mut scratch.far.evaluations);
        let Some(met) = met else { return false };
        if met != 0 {
            let samples = &scratch.far.samples;
            self.soft_points(body, &seen.rays, samples, 0.0, met, &mut seen.hits);
        }
        true
    }

    /// Replaces hits of some lanes by nearer points on the surface of a body, found by the slabs of
    /// a beam around the rays, which start at parameter `base`.
    pub fn meet_slabs(
        &self,
        body: u32,
        slabs: &mut Slabs<'_>,
        base: f64,
        (number, alive): (usize, u32),
        seen: &mut Seen,
        scratch: &mut Scratch,
    ) {
        let based = seen.rays.map(|r| Ray {
            origin: r.at(base),
            direction: r.direction,
        });
        let bundle = Bundle {
            rays: &based,
            limits: &seen.limits().map(|limit| limit - base),
            alive,
            number,
        };
        let found = self.soft.walk(body, slabs, bundle, Quest::First, scratch);
        if found.is_empty() {
            return;
        }
        self.soft.sample_hits(slabs, &based, base, &found, scratch);
        let met = found.iter().fold(0, |m, hit| m | 1u32 << hit.lane);
        self.soft_points(
            body,
            &seen.rays,
            &scratch.samples,
            base,
            met,
            &mut seen.hits,
        );
    }

    /// Returns the point of hard elements, or of their front faces only, that a ray meets first.
    pub fn hard_point(
        &self,
        ray: &Ray,
        front_only: bool,
        crossings: &mut Vec<Crossing>,
    ) -> Option<SurfacePoint> {
        let (number, crossing) = self
            .solids
            .first(ray, f64::INFINITY, front_only, crossings)?;
        Some(SurfacePoint {
            t: crossing.t,
            position: ray.at(crossing.t),
            normal: crossing.normal,
            lift: self.hard_lift * (1.0 + crossing.t),
            finish: self.finishes[self.solids.finish(number)],
            surface: self.surface_of_solid(number),
        })
    }

    /// Makes surface points of a convolution surface's samples where rays meet it.
    fn soft_points(
        &self,
        body: u32,
        rays: &[Ray; PACKET],
        samples: &SurfaceSamples,
        base: f64,
        met: u32,
        hits: &mut [Option<SurfacePoint>; PACKET],
    ) {
        let surface = self.surface_of_body(self.soft.bodies[body as usize].number);
        let gradients = samples.gradients();
        for lane in lanes_in(met) {
            let ray = &rays[lane];
            let gradient = gradients[lane];
            let steepness = gradient.length();
            let Some(normal) = (-gradient).try_normalize() else {
                continue;
            };
            let t = base + samples.t[lane];
            let finish = match &samples.weights[..] {
                [(only, _)] => self.finishes[*only as usize],
                several => {
                    let mut finish = Finish::default();
                    let total: f32 = several.iter().map(|(_, w)| w.to_array()[lane]).sum();
                    for (index, weight) in several {
                        let share = weight.to_array()[lane] / total;
                        if share > 0.0 {
                            finish.mix(&self.finishes[*index as usize], share);
                        }
                    }
                    finish
                }
            };
            hits[lane] = Some(SurfacePoint {
                t,
                position: ray.at(t),
                normal,
                lift: (4.0 * self.soft.precision.last / steepness).at_most(5e-3) + 1e-6,
                finish,
                surface,
            });
        }
    }

    /// Replaces hits by nearer points on the surfaces of bodies that are met ray by ray.
    pub fn meet_others(&self, seen: &mut Seen, alive: u32, scratch: &mut Scratch) {
        for body in &self.others {
            for (lane, (ray, hit)) in seen.rays.iter().zip(&mut seen.hits).enumerate() {
                if alive >> lane & 1 == 0 {
                    continue;
                }
                let limit = hit.map_or(f64::INFINITY, |hit| hit.t);
                let (found, cost) = body.first(ray, limit, Quest::First);
                scratch.evaluations += cost;
                scratch.alone[lane] += cost;
                let Some(t) = found else { continue };
                let Some(normal) = (-body.gradient(ray, t)).try_normalize() else {
                    continue;
                };
                let position = ray.at(t);
                let mut shares = Vec::new();
                body.shares(position, &mut shares);
                *hit = Some(SurfacePoint {
                    t,
                    position,
                    normal,
                    lift: body.lift(t),
                    finish: self.mix(shares.iter().map(|&(_, finish, share)| (finish, share))),
                    surface: self.surface_of_body(body.number()),
                });
            }
        }
    }
}
