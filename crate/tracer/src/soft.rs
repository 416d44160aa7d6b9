//! The convolution surfaces of all bodies, prepared for finding the primitives near a beam, and the
//! places where its rays cross a body's surface.
use crate::beam::Beam;
use crate::beams::Beams;
use crate::blob_set::{BlobSet, NEXT_TO_NOTHING};
use crate::clusters::Clusters;
use crate::far_march::{FarBody, FarQuery, FarWork};
use crate::hierarchy::Hierarchy;
use crate::inner_ball::InnerBall;
use crate::kinks::Kinks;
use crate::layout::PACKET;
use crate::nearby::{Nearby, Other};
use crate::ray::Ray;
use crate::root_isolation::{Along, BoundedTerms, RootIsolator};
use crate::roots::refine_root;
use crate::slabs::{Precision, Slabs, Space, Terms};
use crate::walk::{Bundle, Memories, Quest, Walk};
use field::{Bound, Cut, Primitive, THRESHOLD};
use glam::DVec3;
use scene::{Scene, SoftSurface};
use std::ops::Range;
use std::sync::{Mutex, OnceLock};

/// The convolution surfaces of a scene's bodies.
///
/// The primitives of all bodies stand in one list, body by body, so that the blobs near a beam are
/// found in one search however many bodies there are.
pub struct Soft {
    pub(crate) primitives: Vec<Primitive>,
    /// Finish of each primitive.
    pub(crate) finish: Vec<u32>,
    /// The scene's element that each primitive came from.
    pub(crate) element: Vec<u32>,
    /// The bodies that have a surface.
    pub(crate) bodies: Vec<SoftBody>,
    /// Balls around bodies, by their index in `bodies`; those without a ball are not in it.
    body_tree: Hierarchy,
    /// The primitives' bounds, once they are needed.
    bounds: OnceLock<Vec<Bound>>,
    /// Ball of each primitive outside which it is left out.
    tree: Hierarchy,
    /// Ball of each primitive outside which it is negligible, in double precision, too.
    all: OnceLock<Hierarchy>,
    blob_set: BlobSet,
    /// Field at which a primitive that is no blob is left out.
    left_out: f64,
    /// Accuracy of pictures.
    pub precision: Precision,
    /// Width of a pixel at distance 1.
    pub pixel: f64,
}

/// The convolution surface of one body.
pub(crate) struct SoftBody {
    /// The body's number in the scene.
    pub number: u32,
    /// Range of the body's primitives.
    range: Range<u32>,
    /// Primitives without a bounding ball.
    everywhere: Vec<u32>,
    /// Whether all primitives have kernels that end or fall as the Gaussian, so that a lone ray has
    /// few near it.
    is_local: bool,
    /// Ball outside which no primitive counts; `None` if some count everywhere.
    pub ball: Option<(DVec3, f64)>,
    /// Data that only slabs need.
    groups: OnceLock<Groups>,
    /// The hierarchy of the far field, if the body is of many points that never end.
    far: OnceLock<Option<Box<FarBody>>>,
    /// The hierarchy of the far field in the scene before, which helps to make `far`.
    earlier: Mutex<Option<Box<FarBody>>>,
}

#[cfg(test)]
impl SoftBody {
    /// Returns the hierarchy of the far field, if it was made.
    pub fn far_body(&self) -> Option<&FarBody> {
        self.far.get()?.as_deref()
    }
}

/// The composition of the material of a body's surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MakeUp {
    /// Whether all primitives have one finish.
    pub is_even: bool,
    /// The first primitive's finish.
    pub first: u32,
    /// Whether some element consists of several primitives.
    pub is_pieced: bool,
}

/// Data that is made at first use, for bodies that are not all blobs.
struct Groups {
    /// Balls such that the field is below T outside all of them.
    strong: Hierarchy,
    /// A ball that holds the balls of `strong`; `None` if there are none.
    surface: Option<(DVec3, f64)>,
    /// A ball in which the field is above T; `None` if none is known.
    inside: Option<InnerBall>,
    clusters: Clusters,
    kinks: Kinks,
}

/// Largest sum, in T, of the fields that are left out of all primitives that are no blobs.
const OTHERS_LEFT_OUT: f64 = 1e-5;

/// End of rays along infinitely wide primitives, in units of the scene's size.
const FAR: f64 = 1e4;

/// Steps along a beam after which it counts as near a primitive.
const MOST_STRIDES: usize = 32;
/// Distance of a beam from a primitive's reach that counts as near, over the reach.
const CLOSE_BEAM: f64 = 0.05;

impl Soft {
    /// Collects the primitives of a scene's convolution surfaces. The scene is dropped before their
    /// bounds are made, which saves memory.
    #[must_use]
    pub fn new(scene: Scene, surfaces: Vec<SoftSurface>) -> Self {
        let count: usize = surfaces.iter().map(|s| s.element.len()).sum();
        let finishes = surfaces.iter().flat_map(|s| &s.element);
        let finish: Vec<u32> = finishes
            .map(|&e| scene.elements[e as usize].finish)
            .collect();
        drop(scene);
        let mut element = Vec::new();
        let mut primitives: Vec<Primitive> = Vec::new();
        let mut bodies = Vec::with_capacity(surfaces.len());
        for surface in surfaces {
            let first = primitives.len() as u32;
            if primitives.is_empty() {
                // The first and mostly only body's lists are taken as they are.
                (primitives, element) = (surface.sum.primitives, surface.element);
                primitives.reserve_exact(count - primitives.len());
                element.reserve_exact(count - element.len());
            } else {
                primitives.extend(surface.sum.primitives);
                element.extend(surface.element);
            }
            bodies.push(SoftBody {
                number: surface.body,
                range: first..primitives.len() as u32,
                everywhere: Vec::new(),
                is_local: false,
                ball: None,
                groups: OnceLock::new(),
                far: OnceLock::new(),
                earlier: Mutex::default(),
            });
        }
        let ranges: Vec<Range<u32>> = bodies.iter().map(|body| body.range.clone()).collect();
        let blob_set = BlobSet::new(&primitives, &finish, &ranges);
        let left_out = OTHERS_LEFT_OUT * THRESHOLD / primitives.len().max(1) as f64;
        let mut balls = Vec::with_capacity(primitives.len());
        let mut body_balls = Vec::new();
        for (number, body) in (0..).zip(&mut bodies) {
            let first = balls.len();
            for i in body.range.clone() {
                let p = &primitives[i as usize];
                let ball = blob_set.ball(i as usize).or_else(|| {
                    let (center, around) = p.bounding_sphere()?;
                    let skeleton = around - p.influence;
                    Some((center, skeleton + Bound::new(p).distance_of(left_out)))
                });
                match ball {
                    Some((center, radius)) => balls.push((i, center, radius)),
                    None => body.everywhere.push(i),
                }
            }
            let own = body.range.start as usize..body.range.end as usize;
            body.is_local = body.everywhere.is_empty()
                && primitives[own]
                    .iter()
                    .all(|p| field::far_field::power(p.kernel).is_none());
            if body.everywhere.is_empty() {
                let (center, radius) = around(&balls[first..]);
                body.ball = Some((center, radius));
                body_balls.push((number, center, radius));
            }
        }
        Self {
            primitives,
            finish,
            element,
            bodies,
            body_tree: Hierarchy::new(body_balls),
            bounds: OnceLock::new(),
            tree: Hierarchy::new(balls),
            all: OnceLock::new(),
            blob_set,
            left_out,
            precision: Precision::PICTURE,
            pixel: 1.0,
        }
    }

    /// Returns the body of a primitive, numbered among those with a surface.
    pub fn body_of(&self, primitive: u32) -> u32 {
        let after = self
            .bodies
            .partition_point(|body| body.range.start <= primitive);
        after as u32 - 1
    }

    /// Lists the bodies that a ray of a beam may meet before a parameter, each with the least
    /// parameter at which it may, in this order.
    pub fn bodies_along(&self, beam: &Beam, limit: f64, list: &mut Vec<(f64, u32)>) {
        list.clear();
        for (number, body) in (0..).zip(&self.bodies) {
            if !body.everywhere.is_empty() {
                list.push((0.0, number));
            }
        }
        self.body_tree.search(beam, |number, center, radius| {
            let near = beam.reach(center, radius)[0];
            if near < limit {
                list.push((near, number));
            }
        });
        field::heap_sort(list, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).is_lt());
    }

    /// Whether some primitive of a body counts everywhere.
    pub fn is_everywhere(&self, body: u32) -> bool {
        !self.bodies[body as usize].everywhere.is_empty()
    }

    /// Returns the primitives' bounds, made at first use: the fast path does not need them.
    pub(crate) fn bounds(&self) -> &[Bound] {
        self.bounds
            .get_or_init(|| self.primitives.iter().map(Bound::new).collect())
    }

    /// Returns the composition of the material of each body's surface.
    pub fn make_ups(&self) -> Vec<MakeUp> {
        let mut make_ups = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let range = body.range.start as usize..body.range.end as usize;
            let finishes = &self.finish[range.clone()];
            let mut elements = self.element[range].to_vec();
            field::heap_sort(&mut elements, |a, b| a < b);
            make_ups.push(MakeUp {
                is_even: finishes.iter().all(|finish| *finish == finishes[0]),
                first: finishes[0],
                is_pieced: elements.windows(2).any(|pair| pair[0] == pair[1]),
            });
        }
        make_ups
    }

    /// Appends the elements that add to a body's field at a point: element, finish and field.
    pub fn shares(&self, body: u32, point: DVec3, shares: &mut Vec<(u32, u32, f64)>) {
        let body = &self.bodies[body as usize];
        let at = point.to_array();
        let mut add = |number: u32| {
            let i = number as usize;
            let value = self.primitives[i].value::<f64>(at);
            if value > 0.0 {
                shares.push((self.element[i], self.finish[i], value));
            }
        };
        body.everywhere.iter().for_each(|&i| add(i));
        self.tree.around(point, 0.0, |i, _, _| {
            if body.range.contains(&i) {
                add(i);
            }
        });
    }

    /// Whether there is no soft surface at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.primitives.is_empty()
    }

    /// Calls `f` with each primitive of a body whose reach a ray may meet, its bounds and its
    /// number, in no order.
    pub fn along<'a>(
        &'a self,
        body: u32,
        ray: &Ray,
        mut f: impl FnMut(&'a Primitive, &'a Bound, u32),
    ) {
        let body = &self.bodies[body as usize];
        let mut give = |number: u32| {
            let i = number as usize;
            f(&self.primitives[i], &self.bounds()[i], number);
        };
        body.everywhere.iter().for_each(|&i| give(i));
        self.tree.search(&Beam::of_ray(*ray), |i, _, _| {
            if body.range.contains(&i) {
                give(i);
            }
        });
    }

    /// Returns the gradient of a body's field where a ray is at t.
    pub fn gradient(&self, body: u32, ray: &Ray, t: f64) -> DVec3 {
        let point = ray.at(t).to_array();
        let mut gradient = DVec3::ZERO;
        self.along(body, ray, |primitive, _, _| {
            gradient += DVec3::from_array(primitive.jet(point).gradient);
        });
        gradient
    }

    /// Returns the slabs of a body along a beam up to a parameter, and the parameter at which they
    /// start. `None` if no primitive reaches the beam, or their sum stays below T.
    ///
    /// `beams` divides the beam, given the parameter at which to start; `spaces` holds allocations
    /// to reuse.
    pub fn slabs<'a>(
        &'a self,
        body: u32,
        beam: Beam,
        beams: impl FnOnce(f64) -> Beams<'a>,
        limit: f64,
        spaces: &mut Vec<Space>,
    ) -> Option<(Slabs<'a>, f64)> {
        if !(beam.axis.origin.is_finite() && beam.axis.direction.is_finite()) {
            return None;
        }
        let body = &self.bodies[body as usize];
        let mut list = body.everywhere.clone();
        let mut range = if list.is_empty() {
            [f64::INFINITY, 0.0]
        } else {
            [0.0, FAR]
        };
        let groups = self.groups(body);
        groups.strong.search(&beam, |_, center, radius| {
            let [near, far] = beam.reach(center, radius);
            range = [range[0].at_most(near), range[1].at_least(far)];
        });
        if let Some(ball) = &groups.inside {
            range[0] = range[0].at_least(ball.exit(&beam));
        }
        let [from, to] = [range[0], range[1].min(limit)];
        if from.is_nan() || to.is_nan() || from >= to {
            return None;
        }
        // Parameters start at the first primitive's reach, so that single precision does not lose
        // digits to a distant eye.
        let range = [0.0, to - from];
        let mut clusters = Some(&groups.clusters);
        let is_alone = beam.radius == 0.0 && beam.spread == 0.0;
        if self.precision.shared == 0.0 || is_alone && body.is_local {
            clusters = None;
            self.tree.search(&beam, |i, _, _| {
                if body.range.contains(&i) {
                    list.push(i);
                }
            });
        }
        let left_out = NEXT_TO_NOTHING / OTHERS_LEFT_OUT * self.left_out;
        let terms = self.terms(&groups.kinks, left_out, clusters);
        let space = spaces.pop().unwrap_or_default();
        let slabs = Slabs::new(terms, &list, beams(from), range, self.precision, space);
        if slabs.slab(slabs.root()).above >= THRESHOLD {
            return Some((slabs, from));
        }
        spaces.push(slabs.into_space());
        None
    }

    /// Returns the hierarchy of a body's far field, made at first use; `None` if it has none.
    fn far<'a>(&self, body: &'a SoftBody) -> Option<&'a FarBody> {
        body.far
            .get_or_init(|| {
                let own = body.range.start as usize..body.range.end as usize;
                let kernel = self.primitives.get(own.start)?.kernel;
                if self.precision.shared == 0.0 || !body.everywhere.is_empty() {
                    return None;
                }
                field::far_field::power(kernel)?;
                let ball = self.groups(body).surface?;
                let primitives = &self.primitives[own.clone()];
                let earlier = body.earlier.lock().ok()?.take();
                FarBody::new(
                    primitives,
                    &self.finish[own.clone()],
                    own.start,
                    ball,
                    earlier.as_deref(),
                )
                .map(Box::new)
            })
            .as_deref()
    }

    /// Whether far fields were made, which a later scene may take over.
    pub fn has_far_cells(&self) -> bool {
        self.bodies
            .iter()
            .any(|body| matches!(body.far.get(), Some(Some(_))))
    }

    /// Moves the far fields of an earlier scene into this one: with their help its own are made
    /// sooner, with the same result.
    pub fn take_over(&mut self, before: &mut Self) {
        for (body, old) in self.bodies.iter_mut().zip(&mut before.bodies) {
            body.earlier = Mutex::new(old.far.take().flatten());
        }
    }

    /// Whether a body has a far field, for [`Soft::far_first`].
    pub fn is_far(&self, body: u32) -> bool {
        self.far(&self.bodies[body as usize]).is_some()
    }

    /// Finds the first crossings of rays with the surface of a body of very many points that never
    /// end; for [`Quest::Entry`] only whether there is one. Returns the rays that cross, a bit
    /// each, with the surface there in `work`, whose parameters are the rays' own. `None` if the
    /// body is of another kind, or the rays must be followed in another way.
    pub fn far_first(
        &self,
        body: u32,
        rays: &[Ray; PACKET],
        limits: &[f64; PACKET],
        alive: u32,
        quest: Quest,
        work: &mut FarWork,
    ) -> Option<u32> {
        let body = &self.bodies[body as usize];
        let far = self.far(body)?;
        let query = FarQuery {
            rays,
            limits,
            alive,
            quest,
            pixel: self.pixel,
            sight: self.sight(body),
            resolution: self.precision.resolution,
        };
        far.first(&query, work)
    }

    /// Returns the data of a body that only slabs need, made at first use.
    fn groups<'a>(&self, body: &'a SoftBody) -> &'a Groups {
        body.groups.get_or_init(|| self.group(body))
    }

    /// Makes the data of a body that only slabs need.
    fn group(&self, body: &SoftBody) -> Groups {
        let share = THRESHOLD / body.range.len().max(1) as f64;
        let (mut strong, mut skeletons) = (Vec::new(), Vec::new());
        for i in body.range.clone() {
            let (p, bound) = (&self.primitives[i as usize], &self.bounds()[i as usize]);
            let Some((center, around)) = p.bounding_sphere() else {
                continue;
            };
            let skeleton = around - bound.influence;
            skeletons.push((i, center, skeleton));
            if bound.adds() {
                strong.push((i, center, skeleton + bound.distance_of(share)));
            }
        }
        let range = body.range.clone();
        let all = range.start as usize..range.end as usize;
        Groups {
            surface: (!strong.is_empty()).then(|| around(&strong)),
            inside: (!skeletons.is_empty())
                .then(|| InnerBall::new(&self.bounds()[all], around(&skeletons)))
                .flatten(),
            strong: Hierarchy::new(strong),
            clusters: Clusters::new(skeletons, self.bounds()),
            kinks: Kinks::new(range.map(|i| (i, &self.primitives[i as usize]))),
        }
    }

    /// Returns the primitives with the kinks of a body's.
    pub fn sight<'a>(&'a self, body: &'a SoftBody) -> BoundedTerms<'a> {
        BoundedTerms {
            primitives: &self.primitives,
            bounds: self.bounds(),
            kinks: &self.groups(body).kinks,
        }
    }

    fn terms<'a>(
        &'a self,
        kinks: &'a Kinks,
        left_out: f64,
        clusters: Option<&'a Clusters>,
    ) -> Terms<'a> {
        Terms {
            primitives: &self.primitives,
            bounds: self.bounds(),
            finishes: &self.finish,
            clusters,
            kinks,
            left_out,
        }
    }

    /// Lists the blobs near a beam, up to a parameter, and the other primitives there. Returns
    /// false if those are more than 16, or the only body counts everywhere.
    pub fn list_blobs(&self, beam: &Beam, limit: f64, list: &mut Nearby) -> bool {
        let finite = beam.axis.origin.is_finite() && beam.axis.direction.is_finite();
        let everywhere = self.bodies.len() == 1 && self.is_everywhere(0);
        if everywhere || !finite {
            return false;
        }
        self.blob_set.list(
            &self.tree,
            beam,
            limit,
            |i, radius| {
                // The tree's balls are the skeletons' bounding balls enlarged by the reach.
                let p = &self.primitives[i as usize];
                let around = p.bounding_sphere().map_or(0.0, |(_, around)| around);
                radius - (around - p.influence)
            },
            list,
        )
    }

    /// Whether a ray of a beam may come within the reach of one of some primitives, up to a
    /// parameter.
    pub fn meets_any<'o>(
        &self,
        others: impl IntoIterator<Item = &'o Other>,
        beam: &Beam,
        limit: f64,
    ) -> bool {
        others
            .into_iter()
            .any(|other| self.meets(other, beam, limit))
    }

    /// [`Soft::meets_any`] for one primitive.
    fn meets(&self, other: &Other, beam: &Beam, limit: f64) -> bool {
        let [mut t, far] = beam.reach(other.center, other.radius);
        let far = far.at_most(limit);
        let bound = &self.bounds()[other.primitive as usize];
        for _ in 0..MOST_STRIDES {
            if t > far {
                return false;
            }
            // All rays are within the beam's width of the axis.
            let away = bound.nearness(beam.axis.at(t), beam.width(t)).distance - other.reach;
            if away <= CLOSE_BEAM * other.reach {
                break;
            }
            // Along a ray the distance shrinks by at most the ray's length.
            t += away / (1.0 + beam.spread);
        }
        true
    }

    /// Adds the bodies of those of some primitives whose reach a ray of a beam may meet, up to a
    /// parameter.
    pub fn bodies_met(&self, others: &[Other], beam: &Beam, limit: f64, bodies: &mut Vec<u32>) {
        for other in others {
            let body = self.body_of(other.primitive);
            if !bodies.contains(&body) && self.meets(other, beam, limit) {
                bodies.push(body);
            }
        }
    }

    /// Returns the parameter at which a ray first enters a body's surface on a short interval, in
    /// double precision, and the number of evaluations: the interval's start, if it is inside;
    /// `None` if there is no entry. Primitives without blobs count within their reach.
    pub fn entry(&self, body: u32, ray: Ray, [from, to]: [f64; 2]) -> (Option<f64>, u64) {
        let (center, radius) = (ray.at(0.5 * (from + to)), 0.5 * (to - from));
        let body = &self.bodies[body as usize];
        let least = NEXT_TO_NOTHING * THRESHOLD / self.primitives.len() as f64;
        let mut near = Vec::new();
        let all = self.all.get_or_init(|| self.blob_set.reaches(&self.tree));
        all.around(center, radius, |i, _, _| {
            if body.range.contains(&i) && self.blob_set.counts(i as usize, center, radius, least) {
                near.push(i);
            }
        });
        field::heap_sort(&mut near, |a, b| a < b);
        // Bounds of all primitives would take too much room where there are very many.
        let near = near.into_iter();
        let primitives: Vec<Primitive> =
            near.map(|i| self.primitives[i as usize].clone()).collect();
        let bounds: Vec<Bound> = primitives.iter().map(Bound::new).collect();
        let along = Along {
            sight: BoundedTerms {
                primitives: &primitives,
                bounds: &bounds,
                kinks: &Kinks::new(primitives.iter().enumerate().map(|(i, p)| (i as u32, p))),
            },
            ray,
            resolution: self.precision.resolution,
        };
        let mut isolator = RootIsolator::default();
        isolator.list.extend(0..primitives.len() as u32);
        let mut found = None;
        isolator.crossings(&along, [from, to], |t, inside| {
            found = inside.then_some(t);
            !inside
        });
        (found, isolator.evaluations)
    }

    /// Returns all crossings of a ray with a body's surface in double precision, with no term left
    /// out: pairs (t, gradient), in order of t > 0.
    #[must_use]
    pub fn crossings(&self, body: u32, ray: &Ray) -> Vec<(f64, DVec3)> {
        let body = &self.bodies[body as usize];
        let own = body.range.start as usize..body.range.end as usize;
        let count = own.len();
        // Beyond the distance where each primitive is below T/n the sum is below T.
        let beam = Beam::of_ray(*ray);
        let share = THRESHOLD / count as f64;
        let mut range = [f64::INFINITY, 0.0f64];
        for (p, bound) in self.primitives[own.clone()]
            .iter()
            .zip(&self.bounds()[own.clone()])
        {
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
            self.terms(&self.groups(body).kinks, 0.0, None),
            &body.range.clone().collect::<Vec<u32>>(),
            Beams::one(Beam::of_ray(based)),
            [0.0, to - from],
            Precision::EXACT,
            Space::default(),
        );
        let (found, _) = Walk::<f64>::new(
            self.sight(body),
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
        // The field's sign between neighbouring approximate crossings; where it changes from one
        // such place to the next, a crossing is refined.
        let excess = |t: f64| {
            let jet = field::sum(&self.primitives[own.clone()], based.at(t).to_array());
            (jet.value - THRESHOLD, DVec3::from_array(jet.gradient))
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
                let t = refine_root(
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
}

/// Returns a ball that holds some balls.
fn around(balls: &[(u32, DVec3, f64)]) -> (DVec3, f64) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (_, center, radius) in balls {
        (low, high) = (low.min(center - *radius), high.max(center + *radius));
    }
    let middle = 0.5 * (low + high);
    let reach = balls
        .iter()
        .map(|(_, center, radius)| center.distance(middle) + radius);
    (middle, reach.fold(0.0, f64::max))
}
