//! The soft surface, made ready: which primitives a beam can meet, where its rays hit, and what
//! the surface is like there.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::clusters::Clusters;
use crate::flesh::{Active, Flesh};
use crate::hierarchy::Hierarchy;
use crate::nearby::{Nearby, Other};
use crate::quick::Quick;
use crate::ray::Ray;
use crate::roots::bracketed;
use crate::settle::{Along, Settler, Sight};
use crate::slabs::{Precision, Slabs, Space, Terms};
use crate::stock::Stock;
use crate::walk::{Bundle, Found, Memories, Quest, Walk};
use field::{Bound, Cut, Kink, Primitive, THRESHOLD};
use glam::DVec3;
use scene::Scene;
use std::collections::BTreeMap;
use std::sync::OnceLock;
use wide::f32x8;

/// Rays of one packet.
pub const PACKET: usize = 8;

/// The soft surface of a scene.
pub struct Soft {
    pub(crate) primitives: Vec<Primitive>,
    /// Material of each primitive.
    pub(crate) material: Vec<u32>,
    /// See [`Soft::bounds`].
    bounds: OnceLock<Vec<Bound>>,
    /// Balls within which each counts.
    tree: Hierarchy,
    /// Balls beyond which each is next to nothing.
    all: OnceLock<Hierarchy>,
    /// What slabs need beyond that.
    groups: OnceLock<Groups>,
    /// Primitives without a bounding ball.
    everywhere: Vec<u32>,
    stock: Stock,
    /// Where each other primitive is at most this, it is left out.
    left_out: f64,
    /// How exactly pictures follow the surface.
    pub precision: Precision,
    /// The width of a pixel at distance 1.
    pub pixel: f64,
}

/// What is only made for what is not all lumps.
struct Groups {
    /// Balls outside which the field is below T.
    strong: Hierarchy,
    clusters: Clusters,
    kinks: Kinks,
}

/// Where the primitives that have profiles are not smooth; nothing is known of it in scenes of very many.
#[derive(Debug, Default)]
pub struct Kinks(BTreeMap<u32, Vec<Kink>>);

/// In larger scenes kinks are not looked for: a ray that meets one is settled alone, by all primitives.
const FEW: usize = 16;

impl Kinks {
    fn new(primitives: &[Primitive]) -> Self {
        if primitives.len() > FEW {
            return Self::default();
        }
        let own = |(i, p): (usize, &Primitive)| {
            p.profile.as_ref()?;
            Some((i as u32, field::kinks::of(p)))
        };
        Self(primitives.iter().enumerate().filter_map(own).collect())
    }

    /// Those of a primitive.
    #[must_use]
    pub fn of(&self, primitive: u32) -> &[Kink] {
        self.0.get(&primitive).map_or(&[], Vec::as_slice)
    }

    /// Whether there are none at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// What is left out of all primitives but lumps, together, in T.
const LEFT_OUT: f64 = 1e-5;

/// What slabs leave out, together, in T: less than settling can tell. What is more is in their lists, so that it counts
/// where rays are settled.
pub const NEXT_TO_NOTHING: f64 = 1e-10;

/// Rays from infinitely wide primitives are followed this far (in units of the scene's size).
const FAR: f64 = 1e4;

/// Strides along a beam after which it is taken to come near a primitive …
const MOST_STRIDES: usize = 32;
/// … as it is where it comes so near, in units of how far that counts.
const CLOSE: f64 = 0.05;

/// Scratch space that is worth keeping between packets.
#[derive(Default)]
pub struct Scratch {
    memory: Memories<f32x8>,
    /// That of slabs that are not needed any more.
    pub(crate) spaces: Vec<Space>,
    pub(crate) active: Active,
    pub(crate) flesh: Flesh,
    pub(crate) quick: Quick,
    /// Evaluations of one primitive's field at one point, so far.
    pub evaluations: u64,
    /// Those of them that were made for one ray alone.
    pub alone: [u64; PACKET],
}

impl Soft {
    /// Collects a scene's soft elements. What is left of the scene is dropped before their bounds are made, so that
    /// there is room for many.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        let surface = scene.soft_surface();
        let material: Vec<u32> = surface
            .element
            .iter()
            .map(|&e| scene.elements[e].material as u32)
            .collect();
        drop(scene);
        drop(surface.element);
        let primitives = surface.field.primitives;
        let stock = Stock::new(&primitives, &material);
        let left_out = LEFT_OUT * THRESHOLD / primitives.len().max(1) as f64;
        let mut balls = Vec::with_capacity(primitives.len());
        let mut everywhere = Vec::new();
        for (i, p) in primitives.iter().enumerate() {
            let ball = stock.ball(i).or_else(|| {
                let (center, around) = p.bounding_sphere()?;
                let skeleton = around - p.influence;
                Some((center, skeleton + Bound::new(p).distance_of(left_out)))
            });
            match ball {
                Some((center, radius)) => balls.push((i as u32, center, radius)),
                None => everywhere.push(i as u32),
            }
        }
        Self {
            primitives,
            material,
            bounds: OnceLock::new(),
            tree: Hierarchy::new(balls),
            all: OnceLock::new(),
            groups: OnceLock::new(),
            everywhere,
            stock,
            left_out,
            precision: Precision::PICTURE,
            pixel: 1.0,
        }
    }

    /// The primitives' bounds. The quick way does without, so they are made when first asked for.
    pub(crate) fn bounds(&self) -> &[Bound] {
        self.bounds
            .get_or_init(|| self.primitives.iter().map(Bound::new).collect())
    }

    /// Whether there is no soft surface at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.primitives.is_empty()
    }

    /// Calls `f` with each primitive that counts where a ray may come, the
    /// primitive's bounds and its material, in no order.
    pub fn along<'a>(&'a self, ray: &Ray, mut f: impl FnMut(&'a Primitive, &'a Bound, u32)) {
        let mut give = |i: u32| {
            let i = i as usize;
            f(&self.primitives[i], &self.bounds()[i], self.material[i]);
        };
        self.everywhere.iter().for_each(|&i| give(i));
        self.tree.search(&Beam::of_ray(*ray), |i, _, _| give(i));
    }

    /// The slabs of a beam, up to a parameter; with them the parameter at which the first starts
    /// to count. `None` if no primitive reaches the beam, or all together never reach T.
    ///
    /// `beams` divides the beam, given the parameter at which to start; `spaces` is what there is of used space.
    pub fn slabs<'a>(
        &'a self,
        beam: Beam,
        beams: impl FnOnce(f64) -> Beams<'a>,
        limit: f64,
        spaces: &mut Vec<Space>,
    ) -> Option<(Slabs<'a>, f64)> {
        if !(beam.axis.origin.is_finite() && beam.axis.direction.is_finite()) {
            return None;
        }
        let mut list = self.everywhere.clone();
        let mut range = if list.is_empty() {
            [f64::INFINITY, 0.0]
        } else {
            [0.0, FAR]
        };
        let groups = self.groups();
        groups.strong.search(&beam, |_, center, radius| {
            let [near, far] = beam.reach(center, radius);
            range = [range[0].at_most(near), range[1].at_least(far)];
        });
        let [from, to] = [range[0], range[1].min(limit)];
        if from.is_nan() || to.is_nan() || from >= to {
            return None;
        }
        // Parameters are counted from where the first primitive starts to count, so that single
        // precision does not lose digits to a distant eye.
        let range = [0.0, to - from];
        let mut clusters = Some(&groups.clusters);
        if self.precision.shared == 0.0 {
            clusters = None;
            self.tree.search(&beam, |i, _, _| list.push(i));
        }
        let terms = self.terms(NEXT_TO_NOTHING / LEFT_OUT * self.left_out, clusters);
        let space = spaces.pop().unwrap_or_default();
        let slabs = Slabs::new(terms, &list, beams(from), range, self.precision, space);
        if slabs.slab(slabs.root()).above >= THRESHOLD {
            return Some((slabs, from));
        }
        spaces.push(slabs.into_space());
        None
    }

    fn groups(&self) -> &Groups {
        self.groups.get_or_init(|| self.group())
    }

    fn group(&self) -> Groups {
        let share = THRESHOLD / self.primitives.len().max(1) as f64;
        let (mut strong, mut skeletons) = (Vec::new(), Vec::new());
        for (i, (p, bound)) in self.primitives.iter().zip(self.bounds()).enumerate() {
            let Some((center, around)) = p.bounding_sphere() else {
                continue;
            };
            let skeleton = around - bound.influence;
            skeletons.push((i as u32, center, skeleton));
            if bound.adds() {
                strong.push((i as u32, center, skeleton + bound.distance_of(share)));
            }
        }
        Groups {
            strong: Hierarchy::new(strong),
            clusters: Clusters::new(skeletons, self.bounds()),
            kinks: Kinks::new(&self.primitives),
        }
    }

    fn sight(&self) -> Sight<'_> {
        Sight {
            primitives: &self.primitives,
            bounds: self.bounds(),
            kinks: &self.groups().kinks,
        }
    }

    fn terms<'a>(&'a self, left_out: f64, clusters: Option<&'a Clusters>) -> Terms<'a> {
        Terms {
            primitives: &self.primitives,
            bounds: self.bounds(),
            materials: &self.material,
            clusters,
            kinks: &self.groups().kinks,
            left_out,
        }
    }

    /// Lists the lumps near a beam, up to a parameter, and the few other primitives there. False if those are more than a few.
    pub fn list_lumps(&self, beam: &Beam, limit: f64, list: &mut Nearby) -> bool {
        let finite = beam.axis.origin.is_finite() && beam.axis.direction.is_finite();
        if !self.everywhere.is_empty() || !finite {
            return false;
        }
        // The tree's balls reach as far beyond those of the skeletons.
        let reach = |i: u32, radius: f64| {
            let p = &self.primitives[i as usize];
            let around = p.bounding_sphere().map_or(0.0, |(_, around)| around);
            radius - (around - p.influence)
        };
        self.stock.list(&self.tree, beam, limit, reach, list)
    }

    /// Whether a ray of a beam may come so near to one of some primitives, up to a parameter, that it counts.
    pub fn meets_any(&self, others: &[Other], beam: &Beam, limit: f64) -> bool {
        others.iter().any(|other| {
            let [mut t, far] = beam.reach(other.center, other.radius);
            let far = far.at_most(limit);
            let bound = &self.bounds()[other.primitive as usize];
            for _ in 0..MOST_STRIDES {
                if t > far {
                    return false;
                }
                // No ray that is at t is further from the axis than its width there.
                let away = bound.nearness(beam.axis.at(t), beam.width(t)).distance - other.reach;
                if away <= CLOSE * other.reach {
                    break;
                }
                // As it goes on a ray comes nearer by no more than it goes.
                t += away / (1.0 + beam.spread);
            }
            true
        })
    }

    /// Walks a bundle through the slabs of its beam.
    pub fn walk(
        &self,
        slabs: &mut Slabs<'_>,
        bundle: Bundle<'_>,
        quest: Quest,
        scratch: &mut Scratch,
    ) -> Vec<Found> {
        slabs.tidy();
        let (found, evaluations) =
            Walk::<f32x8>::new(self.sight(), slabs, bundle, quest, &mut scratch.memory).run();
        scratch.evaluations += evaluations;
        found
    }

    /// Where a ray first enters the surface on a short stretch, in double precision, with the number of evaluations; its
    /// start, if it is inside there. What is no lump, or sum of lumps, is taken to count as far as it is followed.
    pub fn entry(&self, ray: Ray, [from, to]: [f64; 2]) -> (Option<f64>, u64) {
        let (center, radius) = (ray.at(0.5 * (from + to)), 0.5 * (to - from));
        let least = NEXT_TO_NOTHING * THRESHOLD / self.primitives.len() as f64;
        let mut near = Vec::new();
        let all = self.all.get_or_init(|| self.stock.reaches(&self.tree));
        all.around(center, radius, |i, _, _| {
            if self.stock.counts(i as usize, center, radius, least) {
                near.push(i);
            }
        });
        near.sort_unstable();
        // Bounds of all primitives would take too much room where there are very many.
        let of = |&i: &u32| self.primitives[i as usize].clone();
        let primitives: Vec<Primitive> = near.iter().map(of).collect();
        let bounds: Vec<Bound> = primitives.iter().map(Bound::new).collect();
        let along = Along {
            sight: Sight {
                primitives: &primitives,
                bounds: &bounds,
                kinks: &Kinks::new(&primitives),
            },
            ray,
            resolution: self.precision.resolution,
        };
        let mut settler = Settler::default();
        settler.list.extend(0..primitives.len() as u32);
        let mut found = None;
        settler.crossings(&along, [from, to], |t, inside| {
            found = inside.then_some(t);
            !inside
        });
        (found, settler.evaluations)
    }

    /// All crossings of a ray, exactly: where the whole field, with nothing cut off, equals T.
    /// Pairs (t, gradient), in order of t > 0.
    #[must_use]
    pub fn crossings(&self, ray: &Ray) -> Vec<(f64, DVec3)> {
        let count = self.primitives.len();
        if count == 0 {
            return Vec::new();
        }
        // Beyond the distance where each primitive is below T/n the sum is below T.
        let beam = Beam::of_ray(*ray);
        let share = THRESHOLD / count as f64;
        let mut range = [f64::INFINITY, 0.0f64];
        for (p, bound) in self.primitives.iter().zip(self.bounds()) {
            let [near, far] = match p.bounding_sphere() {
                Some((center, radius)) => {
                    let skeleton = radius - bound.influence;
                    beam.reach(center, skeleton + bound.distance_of(share))
                }
                None => [0.0, FAR],
            };
            range = [range[0].at_most(near), range[1].at_least(far)];
        }
        let [from, to] = range;
        if from.is_nan() || to.is_nan() || from >= to {
            return Vec::new();
        }
        let based = Ray {
            origin: ray.at(from),
            direction: ray.direction,
        };
        let mut slabs = Slabs::new(
            self.terms(0.0, None),
            &(0..count as u32).collect::<Vec<u32>>(),
            Beams::one(Beam::of_ray(based)),
            [0.0, to - from],
            Precision::EXACT,
            Space::default(),
        );
        let (found, _) = Walk::<f64>::new(
            self.sight(),
            &mut slabs,
            Bundle {
                rays: &[based],
                limits: &[to - from],
                alive: 1,
                number: 0,
            },
            Quest::All,
            &mut Memories::default(),
        )
        .run();
        // Between neighbouring crossings the exact field has its sign; where it changes from one
        // such place to the next, there is the exact crossing.
        let excess = |t: f64| {
            let (value, gradient) = self.field(based.at(t));
            (value - THRESHOLD, gradient)
        };
        let mut places = vec![0.0];
        places.extend(found.windows(2).map(|w| 0.5 * (w[0].t + w[1].t)));
        if !found.is_empty() {
            places.push(to - from);
        }
        let mut crossings = Vec::new();
        let mut before = excess(0.0).0;
        for w in places.windows(2) {
            let after = excess(w[1]).0;
            if (before < 0.0) != (after < 0.0) {
                let t = bracketed(
                    |t| {
                        let (value, gradient) = excess(t);
                        (value, gradient.dot(ray.direction))
                    },
                    w[0],
                    w[1],
                    1e-14 * (1.0 + w[1]),
                );
                crossings.push((from + t, excess(t).1));
            }
            before = after;
        }
        crossings
    }

    /// The whole field and its gradient.
    fn field(&self, point: DVec3) -> (f64, DVec3) {
        let mut value = 0.0;
        let mut gradient = DVec3::ZERO;
        for p in &self.primitives {
            let jet = p.jet(point.to_array());
            value += jet.value;
            gradient += DVec3::from_array(jet.gradient);
        }
        (value, gradient)
    }
}
