//! Traversal of a beam's slabs by a packet, which finds the crossings of its rays with the soft
//! surface.
//!
//! The rays visit the slabs of their beam together, front to back. Each slab adds its resolved
//! primitives' spans to the cubics of the longer slabs that contain it. Where the cubics and the
//! bounds on pending primitives prove that every ray stays outside (or inside) the surface, the
//! slab is left at once; where nothing is pending, the cubics' roots are the crossings. The
//! traversal ends when every ray has its crossing, so that nothing behind the first hit is
//! interpolated.
use crate::convex::{log_above, log_below, most_between};
use crate::lanes::{Lanes, spread};
use crate::ray::Ray;
use crate::root_isolation::{Along, BoundedTerms, RootIsolator, STEEP};
use crate::slabs::{Parts, Slabs, Which};
use crate::spans::{Node, Span};
use field::{Primitive, THRESHOLD};

/// Kind of crossing that rays look for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quest {
    /// The first crossing, into the surface or, from inside, out of it.
    First,
    /// Whether there is any crossing from outside to inside.
    Entry,
    /// Every crossing.
    All,
}

/// Rays of the slabs' beam, one a lane.
#[derive(Clone, Copy, Debug)]
pub struct Bundle<'r> {
    /// The rays, at least one and at most as many as there are lanes; t is counted from where the
    /// slabs start. Lanes beyond the last ray repeat it.
    pub rays: &'r [Ray],
    /// End of each ray.
    pub limits: &'r [f64],
    /// The lanes to follow, a bit each.
    pub alive: u32,
    /// The bundle's number among the beam's divisions.
    pub number: usize,
}

/// A crossing, as exact as the spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Ray parameter.
    pub t: f64,
    /// Slab that contains it.
    pub slab: u32,
    /// The ray's lane.
    pub lane: usize,
    /// Whether t is exact in double precision.
    pub isolated: bool,
}

/// Traversal state of a bundle.
pub struct Walk<'w, 's, L> {
    sight: BoundedTerms<'w>,
    slabs: &'w mut Slabs<'s>,
    packet: usize,
    quest: Quest,
    rays: &'w [Ray],
    origin: [L; 3],
    direction: [L; 3],
    /// End of each ray.
    limit: L,
    /// Rays without their crossing, a bit each.
    alive: u32,
    /// Rays known to be outside at the parameter reached, a bit each.
    outside: u32,
    /// Rays known to be inside at the parameter reached, a bit each.
    inside: u32,
    memory: &'w mut Memories<L>,
    isolator: RootIsolator,
    found: Vec<Found>,
    /// The sum of the slab being visited, or of one that contains it.
    sum: GaussianSum<L>,
    /// Work so far, see [`MOST_WORK`].
    work: usize,
    /// Evaluations of one primitive's field at one point.
    pub evaluations: u64,
}

/// The sum of the Gaussians pending in a slab.
#[derive(Debug)]
struct GaussianSum<L> {
    /// The primitives, with bounds on their profiles.
    list: Vec<(u32, L)>,
    /// Largest [`field::Bound::log_bend`].
    log_bend: f64,
    /// Bounds on the rounding of the sum: a part of it, and what is added to that.
    rounding: [f64; 2],
    /// Lower bounds on the logarithm of what the slab's other terms leave up to T.
    room: L,
}

/// The last node at which a primitive was evaluated, which adjacent slabs share.
#[derive(Clone, Copy, Debug)]
struct Memory<L> {
    /// The traversal that it belongs to.
    walk: u32,
    t: f64,
    node: Node<L>,
}

/// The last nodes of all primitives; the allocation is kept between traversals.
#[derive(Debug)]
pub struct Memories<L> {
    walk: u32,
    last: Vec<Memory<L>>,
}

impl<L> Default for Memories<L> {
    fn default() -> Self {
        Self {
            walk: 0,
            last: Vec::new(),
        }
    }
}

impl<L: Lanes> Memories<L> {
    /// Starts a traversal: earlier nodes become invalid.
    fn begin(&mut self) {
        if self.walk == u32::MAX {
            *self = Self::default();
        }
        self.walk += 1;
    }

    /// Makes room for `count` primitives.
    fn hold(&mut self, count: usize) {
        let blank = Memory {
            walk: 0,
            t: 0.0,
            node: Node::zero(),
        };
        if self.last.len() < count {
            self.last.resize(count, blank);
        }
    }
}

/// Largest depth of slabs that are halved: lengths of 2⁻⁴⁰ of the beam's.
const DEEPEST_SLAB: u32 = 40;

/// Most primitives in a slab with which crossings are isolated directly, without shared
/// interpolants.
const FEW_PRIMITIVES: usize = 64;
/// Least ratio of all primitives in a slab to the near ones at which shared interpolants are used
/// in place of the others.
const WORTH: usize = 4;

/// Fewest pending entries of a slab whose Gaussians are added up at its ends.
const FEWEST_GAUSSIANS: usize = 6;
/// Largest square of a slab's length, in widths of the sharpest Gaussian, for which Gaussians are
/// added up: their sum may be e^(¼·this) times larger between the ends than there.
const LONGEST_BEND: f64 = 8.0;
/// Largest field of a Gaussian for which the bound counts instead of the value.
const FAINT: f64 = 4e-3 * THRESHOLD;

/// Number of halvings of a slab's cubics to isolate their crossings.
const CUTS: u32 = 4;

/// Most list entries that one packet's traversal looks at, unless [`MOST_VISITS`] times the scene's
/// primitives are more. After that, slabs are not halved further; crossings in them are isolated
/// ray by ray, within limits, so that no scene takes unlimited time or memory. A packet of the
/// published scenes looks at a few hundred. The limit must not depend on the work of other packets
/// of the beam, which differs with the tiles.
const MOST_WORK: usize = 1 << 17;
/// Most visits of each primitive, see [`MOST_WORK`].
const MOST_VISITS: usize = 64;
/// Upper limit on the entries of [`MOST_WORK`] with very many primitives.
const MOST_WORK_OF_MANY: usize = 1 << 22;

impl<'w, 's, L: Lanes> Walk<'w, 's, L> {
    /// Starts a traversal. `memory` is working space.
    #[must_use]
    pub fn new(
        sight: BoundedTerms<'w>,
        slabs: &'w mut Slabs<'s>,
        bundle: Bundle<'w>,
        quest: Quest,
        memory: &'w mut Memories<L>,
    ) -> Self {
        let Bundle { rays, limits, .. } = bundle;
        let [origin, direction] = spread(rays);
        memory.begin();
        Self {
            sight,
            slabs,
            packet: bundle.number,
            quest,
            rays,
            origin,
            direction,
            limit: L::from_lanes(|i| limits[i.min(limits.len() - 1)]),
            alive: bundle.alive,
            outside: 0,
            inside: 0,
            memory,
            isolator: RootIsolator::default(),
            found: Vec::new(),
            sum: GaussianSum {
                list: Vec::new(),
                log_bend: 0.0,
                rounding: [0.0; 2],
                room: L::splat(0.0),
            },
            work: 0,
            evaluations: 0,
        }
    }

    /// Runs the traversal. Returns the crossings, in order of t for each lane, and the number of
    /// evaluations.
    #[must_use]
    pub fn run(mut self) -> (Vec<Found>, u64) {
        let root = self.slabs.root();
        self.visit(root, Span::zero(), Span::zero(), None);
        (self.found, self.evaluations)
    }

    /// Visits a slab, given the sums of the shared and of the resolved primitives of the longer
    /// slabs that contain it, and of the Gaussians pending in one of them.
    fn visit(&mut self, index: u32, mut shared: Span<L>, mut base: Span<L>, sum: Option<[L; 2]>) {
        let slab = self.slabs.slab(index);
        let (error, depth, from) = (slab.error, slab.depth, slab.from);
        let (above, below) = (slab.above, slab.below);
        let pending = [slab.pending_above, slab.pending_below];
        let resolves = !slab.resolved.is_empty();
        let (shares, joins) = (!slab.shared.is_empty(), !slab.joined.is_empty());
        let kinked = slab.kinked;
        self.work += 1 + slab.joined.len() + slab.resolved.len() + slab.pending.len();
        // Rays that end before this slab have no crossing.
        self.alive &= L::splat(from).less(self.limit);
        let mut span = shared.plus(base);
        if self.alive == 0 || self.reject(index, span, above, below, error) {
            return;
        }
        if shares {
            shared = shared.plus(self.together(index, Which::Shared));
        }
        if joins {
            base = base.plus(self.together(index, Which::Joined));
        }
        if resolves {
            base = base.plus(self.span(index));
        }
        if shares || joins || resolves {
            span = shared.plus(base);
            if self.reject(index, span, pending[0], pending[1], error) {
                return;
            }
        }
        let all = self.sight.primitives.len();
        let most = (MOST_VISITS * all).clamp(MOST_WORK, MOST_WORK_OF_MANY);
        let single = self.slabs.is_polar(index, self.packet) || self.slabs.is_blurred(index);
        if kinked || self.work > most || depth >= DEEPEST_SLAB || single {
            self.isolate(index, self.alive);
            return;
        }
        let sum = sum.or_else(|| self.add_gaussians(index, span));
        if !sum.is_some_and(|sum| self.reject_sum(index, sum)) {
            self.divide(index, shared, base, sum);
        }
    }

    /// Visits the parts of a slab, or finds the crossings if nothing is pending.
    fn divide(&mut self, index: u32, shared: Span<L>, base: Span<L>, sum: Option<[L; 2]>) {
        let slab = self.slabs.slab(index);
        let (error, done) = (slab.error, slab.pending.is_empty());
        let middle = 0.5 * (slab.from + slab.to);
        if done {
            let span = shared.plus(base);
            let doubtful = self.doubtful(span, error);
            if doubtful != 0 && !self.slabs.is_final(index) {
                let finer = self.slabs.refine(index);
                self.visit(finer, shared, Span::zero(), sum);
            } else {
                self.cross(index, span, !doubtful);
                self.isolate(index, doubtful);
            }
            return;
        }
        match self.slabs.parts(index, self.packet) {
            Parts::Halves(left, right) => {
                let [near, far] = base.halves();
                let [shared_near, shared_far] = shared.halves();
                let sums = sum.map(|sum| self.halve_sum(index, sum, middle));
                let [before, behind] = sums.unwrap_or_default();
                self.visit(left, shared_near, near, before);
                if self.alive != 0 {
                    self.visit(right, shared_far, far, behind);
                }
            }
            Parts::Narrower(same) => self.visit(same, shared, base, sum),
        }
    }

    /// Lists the Gaussians pending in a slab and returns upper bounds on the logarithm of their sum
    /// at its ends, if they are all that is pending, and the slab is so short that the ends tell of
    /// what is between; `rest` is the span of the other terms.
    fn add_gaussians(&mut self, index: u32, rest: Span<L>) -> Option<[L; 2]> {
        let slab = self.slabs.slab(index);
        let (from, to, log_bend) = (slab.from, slab.to, slab.log_bend);
        let is_short = log_bend * (to - from) * (to - from) <= LONGEST_BEND;
        if !is_short || slab.pending.len() < FEWEST_GAUSSIANS {
            return None;
        }
        let room = log_below(L::splat(THRESHOLD - slab.error) - rest.max());
        let ends = [from, to].map(|t| self.point(t));
        let (sight, sum) = (self.sight, &mut self.sum);
        sum.list.clear();
        sum.rounding = self.slabs.list_pending(index, |p| {
            if sight.bounds[p as usize].adds() {
                let factor = sight.primitives[p as usize].factor_between(ends);
                sum.list.push((p, factor));
            }
        });
        (sum.log_bend, sum.room) = (log_bend, room);
        Some([from, to].map(|t| self.log_sum(index, t)))
    }

    /// Returns upper bounds on the logarithm of the sum of Gaussians at t, a parameter in a slab.
    #[inline(never)]
    fn log_sum(&mut self, index: u32, t: f64) -> L {
        let (center, radius) = self.slabs.ball(index, t);
        let point = self.point(t);
        let (mut total, mut faint, mut evaluated) = (L::splat(0.0), 0.0, 0);
        for &(p, factor) in &self.sum.list {
            let bound = &self.sight.bounds[p as usize];
            let magnitude = bound.magnitude(bound.nearness(center, radius));
            if magnitude <= FAINT {
                faint += magnitude;
                continue;
            }
            total = total + factor * self.sight.primitives[p as usize].plain_value(point);
            evaluated += 1;
        }
        self.evaluations += L::LANES as u64 * evaluated;
        self.work += self.sum.list.len();
        let [part, more] = self.sum.rounding;
        log_above(total * L::splat(1.0 + 2.0 * part) + L::splat(more + faint))
    }

    /// Returns whether the sum of Gaussians, given its logarithm's bounds at a slab's ends, proves
    /// that all rays stay outside in the whole slab; records that.
    fn reject_sum(&mut self, index: u32, ends: [L; 2]) -> bool {
        let slab = self.slabs.slab(index);
        let (from, length) = (slab.from, slab.to - slab.from);
        let most = most_between(ends, self.sum.log_bend * length * length);
        let outside = most.less(self.sum.room);
        if self.alive & !outside != 0 {
            return false;
        }
        self.arrive(index, from, outside, 0, false);
        true
    }

    /// Returns the bounds of [`Walk::reject_sum`] for the halves of a slab.
    fn halve_sum(&mut self, index: u32, [from, to]: [L; 2], t: f64) -> [Option<[L; 2]>; 2] {
        let are_outside = [from, to].map(|end| self.alive & !end.less(self.sum.room) == 0);
        // Neither half will be rejected where rays are not outside at either end.
        let between = if are_outside == [false; 2] {
            L::splat(f64::INFINITY)
        } else {
            self.log_sum(index, t)
        };
        [Some([from, between]), Some([between, to])]
    }

    /// Returns the rays' points at t.
    fn point(&self, t: f64) -> [L; 3] {
        let t = L::splat(t);
        core::array::from_fn(|k| self.origin[k] + self.direction[k] * t)
    }

    /// Returns the span of the primitives with a common interpolant.
    fn together(&mut self, index: u32, which: Which) -> Span<L> {
        let s = self.slabs.slab(index);
        let (from, to) = (s.from, s.to);
        let Some(block) = self.slabs.block(index, which) else {
            return Span::zero();
        };
        let steps = block.cell.steps(self.direction);
        let t = L::splat(from);
        let near = core::array::from_fn(|k| self.origin[k] + self.direction[k] * t);
        let near = block.cell.local(near);
        let length = L::splat(to - from);
        let far = core::array::from_fn(|k| near[k] + steps[k] * length);
        let [near, far] = [near, far].map(|place| {
            let (value, [x, y, z]) = block.total.jet(place);
            Node {
                value,
                slope: x * steps[0] + y * steps[1] + z * steps[2],
            }
        });
        Span::hermite(near, far, to - from)
    }

    /// Returns whether all rays are proved to stay on one side in the whole slab; records the side.
    fn reject(&mut self, index: u32, span: Span<L>, above: f64, below: f64, error: f64) -> bool {
        let outside = span.max().less(L::splat(THRESHOLD - above - error));
        let inside = L::splat(THRESHOLD + below + error).less(span.min());
        if self.alive & !(outside | inside) != 0 {
            return false;
        }
        let from = self.slabs.slab(index).from;
        self.arrive(index, from, outside, inside, false);
        true
    }

    /// Records the sides of the rays at t; a ray that was on the other side crosses there.
    fn arrive(&mut self, index: u32, t: f64, outside: u32, inside: u32, isolated: bool) {
        let outside = outside & self.alive;
        let inside = inside & self.alive & !outside;
        let leaving = outside & self.inside;
        let entering = inside & self.outside;
        let mut crossing = leaving | entering;
        self.outside = (self.outside & !inside) | outside;
        self.inside = (self.inside & !outside) | inside;
        while crossing != 0 {
            let lane = crossing.trailing_zeros() as usize;
            crossing &= crossing - 1;
            let found = Found {
                t,
                slab: index,
                lane,
                isolated,
            };
            self.report(found, entering >> lane & 1 != 0);
        }
    }

    /// Records a crossing, if it is one that the quest asks for and before the ray's end.
    fn report(&mut self, found: Found, enters: bool) {
        if found.t > self.limit.lane(found.lane) {
            self.alive &= !(1 << found.lane);
            return;
        }
        if enters || self.quest != Quest::Entry {
            self.found.push(found);
            if self.quest != Quest::All {
                self.alive &= !(1 << found.lane);
            }
        }
    }

    /// Returns the rays whose cubics do not prove the number of crossings in this slab: on each
    /// piece of it none, or exactly one.
    fn doubtful(&self, span: Span<L>, error: f64) -> u32 {
        Self::doubts(self.alive, span, error, STEEP * error, CUTS)
    }

    /// Returns those of some rays that are in doubt on a piece of a slab, which is halved up to
    /// `cuts` times. The differences of the coefficients there have the error `steep`.
    fn doubts(lanes: u32, span: Span<L>, error: f64, steep: f64, cuts: u32) -> u32 {
        let [a, b, c, d] = span.0;
        let level = L::splat(THRESHOLD);
        let e = L::splat(error);
        let never = span.max().less(level - e) | (level + e).less(span.min());
        let off = L::splat(steep);
        let rises = off.less(b - a) & off.less(c - b) & off.less(d - c);
        let falls = off.less(a - b) & off.less(b - c) & off.less(c - d);
        let open = lanes & !(never | rises | falls);
        if open == 0 || cuts == 0 {
            return open;
        }
        let [left, right] = span.halves();
        let before = Self::doubts(open, left, error, 0.5 * steep, cuts - 1);
        before | Self::doubts(open & !before, right, error, 0.5 * steep, cuts - 1)
    }

    /// Isolates the crossings of some rays in a slab one ray at a time in double precision.
    fn isolate(&mut self, index: u32, lanes: u32) {
        let mut lanes = lanes & self.alive;
        if lanes == 0 {
            return;
        }
        let s = self.slabs.slab(index);
        let (from, to) = (s.from, s.to);
        lanes &= !self.isolate_near(index, lanes);
        if lanes == 0 {
            return;
        }
        let (slabs, list) = (&*self.slabs, &mut self.isolator.list);
        list.clear();
        slabs.each(index, true, |p| list.push(p));
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            let bit = 1u32 << lane;
            lanes &= !bit;
            let along = Along {
                sight: self.sight,
                ray: self.rays[lane.min(self.rays.len() - 1)],
                resolution: self.slabs.resolution(),
            };
            let mut isolator = core::mem::take(&mut self.isolator);
            isolator.crossings(&along, [from, to], |t, inside| {
                let (outside, inside) = if inside { (0, bit) } else { (bit, 0) };
                self.arrive(index, t, outside, inside, true);
                self.alive & bit != 0
            });
            // Isolation counts as work, too: it takes far longer in many short slabs than in a few
            // long ones.
            self.work += isolator.evaluations as usize;
            self.evaluations += core::mem::take(&mut isolator.evaluations);
            self.isolator = isolator;
        }
    }

    /// Isolates crossings with shared interpolants in place of far primitives, where that saves
    /// most of the work. Returns the rays that are decided so, a bit each.
    fn isolate_near(&mut self, index: u32, lanes: u32) -> u32 {
        let all = self.slabs.count(index);
        if all <= FEW_PRIMITIVES {
            return 0;
        }
        // Listing counts as work, too.
        self.work += all / 16;
        self.isolator.list.clear();
        let afar = self.slabs.list_near(index, &mut self.isolator.list);
        if self.isolator.list.len() * WORTH > all {
            return 0;
        }
        let s = self.slabs.slab(index);
        let interval = [s.from, s.to];
        let mut isolated = 0;
        for lane in (0..L::LANES).filter(|lane| lanes >> lane & 1 != 0) {
            let along = Along {
                sight: self.sight,
                ray: self.rays[lane.min(self.rays.len() - 1)],
                resolution: self.slabs.resolution(),
            };
            let isolator = &mut self.isolator;
            let crossings = afar.along(&along.ray, |known| {
                isolator.crossings_with(&along, interval, known)
            });
            let spent = core::mem::take(&mut self.isolator.evaluations);
            self.work += spent as usize;
            self.evaluations += spent;
            let Some(crossings) = crossings else {
                continue;
            };
            let bit = 1u32 << lane;
            isolated |= bit;
            for (t, inside) in crossings {
                let (outside, inside) = if inside { (0, bit) } else { (bit, 0) };
                self.arrive(index, t, outside, inside, false);
                if self.alive & bit == 0 {
                    break;
                }
            }
        }
        isolated
    }

    /// Records the crossings of some rays in a slab whose cubics are final.
    fn cross(&mut self, index: u32, span: Span<L>, lanes: u32) {
        let level = L::splat(THRESHOLD);
        let (from, to) = {
            let s = self.slabs.slab(index);
            (s.from, s.to)
        };
        let outside = span.0[0].less(level);
        self.arrive(index, from, outside & lanes, !outside & lanes, false);
        // Lanes whose coefficients are all on one side have no root.
        let one_sided = span.max().less(level) | level.less(span.min());
        let mut lanes = self.alive & lanes & !one_sided;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let cubic = span.lane(lane);
            for &x in cubic.crossings(THRESHOLD).as_slice() {
                if self.alive >> lane & 1 == 0 {
                    break;
                }
                // A cubic that starts on the level counts as starting inside.
                if x <= 0.0 {
                    continue;
                }
                let bit = 1u32 << lane;
                let enters = self.outside & bit != 0;
                self.outside ^= bit;
                self.inside ^= bit;
                let found = Found {
                    t: from + x * (to - from),
                    slab: index,
                    lane,
                    isolated: false,
                };
                self.report(found, enters);
            }
        }
    }

    /// Adds up the spans of a slab's resolved primitives.
    fn span(&mut self, index: u32) -> Span<L> {
        let s = self.slabs.slab(index);
        let range = &s.resolved;
        let (from, to) = (s.from, s.to);
        let places = [from, to].map(|t| self.point(t));
        let (mut left, mut right) = (Node::zero(), Node::zero());
        self.memory.hold(self.slabs.len());
        for &local in self.slabs.locals(range) {
            let primitive = &self.sight.primitives[self.slabs.primitive(local) as usize];
            let walk = self.memory.walk;
            let memory = &mut self.memory.last[local as usize];
            if memory.walk != walk || memory.t != from {
                memory.node = node(primitive, places[0], self.direction);
                self.evaluations += L::LANES as u64;
            }
            left = left.plus(memory.node);
            memory.node = node(primitive, places[1], self.direction);
            (memory.walk, memory.t) = (walk, to);
            self.evaluations += L::LANES as u64;
            right = right.plus(memory.node);
        }
        Span::hermite(left, right, to - from)
    }
}

/// Returns the value of a primitive and its slope along rays.
#[inline]
fn node<L: Lanes>(primitive: &Primitive, point: [L; 3], direction: [L; 3]) -> Node<L> {
    let jet = primitive.jet(point);
    let [gx, gy, gz] = jet.gradient;
    Node {
        value: jet.value,
        slope: gx * direction[0] + gy * direction[1] + gz * direction[2],
    }
}
