//! The digger: finds where rays cross the soft surface.
//!
//! A few rays walk through the slabs of their beam side by side, front to back. Each slab adds its
//! resolved primitives' spans to the cubics handed down from the longer slabs around it. Where the
//! cubics and the bounds on what is still pending prove that every ray stays outside (or inside)
//! the surface, the slab is left at once; where nothing is pending any more, the cubics' roots are
//! the crossings. Walking stops when every ray has what it wants, so nothing behind the first
//! hit is ever interpolated.
use crate::lanes::Lanes;
use crate::ray::Ray;
use crate::settle::{Along, Given, STEEP, Settler, Sight};
use crate::slabs::{Parts, Slabs, Which};
use crate::spans::{Node, Span};
use field::{Primitive, THRESHOLD};

/// What the rays look for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quest {
    /// The first crossing, into the surface or, from inside, out of it.
    First,
    /// Whether there is any crossing from outside to inside.
    Entry,
    /// All crossings.
    All,
}

/// Some rays of the slabs' beam, one a lane.
#[derive(Clone, Copy, Debug)]
pub struct Bundle<'r> {
    /// The rays, at least one and at most as many as there are lanes; t is counted from where the
    /// slabs start. Lanes beyond the last ray repeat it.
    pub rays: &'r [Ray],
    /// How far each ray goes.
    pub limits: &'r [f64],
    /// The lanes that are followed, a bit each.
    pub alive: u32,
    /// The bundle's number among the beam's divisions.
    pub number: usize,
}

/// A crossing, as exact as the spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Ray parameter.
    pub t: f64,
    /// The slab it lies in.
    pub slab: u32,
    /// The ray's lane.
    pub lane: usize,
    /// Whether t is exact already.
    pub settled: bool,
}

/// Some rays on their way through the slabs of their beam.
pub struct Walk<'w, 's, L> {
    sight: Sight<'w>,
    slabs: &'w mut Slabs<'s>,
    packet: usize,
    quest: Quest,
    rays: &'w [Ray],
    origin: [L; 3],
    direction: [L; 3],
    /// Where each ray ends.
    limit: L,
    /// Rays that have not found what they want, a bit each.
    alive: u32,
    /// Rays known to be outside and inside at the place reached.
    outside: u32,
    inside: u32,
    memory: &'w mut Memories<L>,
    settler: Settler,
    found: Vec<Found>,
    /// Work done, see [`MOST_WORK`].
    work: usize,
    /// Evaluations of one primitive's field at one point.
    pub evaluations: u64,
}

/// The last node at which a primitive was evaluated: slabs that touch share it.
#[derive(Clone, Copy, Debug)]
struct Memory<L> {
    /// The walk that it belongs to.
    walk: u32,
    t: f64,
    node: Node<L>,
}

/// The last nodes of all primitives, and space for them that is kept between walks.
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
    /// Forgets all.
    fn begin(&mut self) {
        if self.walk == u32::MAX {
            *self = Self::default();
        }
        self.walk += 1;
    }

    /// Makes space for so many primitives.
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

/// Slabs deeper than this are not halved further: 2⁻⁴⁰ of the beam's length.
const DEEPEST: u32 = 40;

/// Where no more primitives than this count rays are settled with all of them at once …
const FEW: usize = 64;
/// … as they are where what is near is more than one over this of all.
const WORTH: usize = 4;

/// How many times a slab's cubics are halved to tell their crossings apart.
const CUTS: u32 = 4;

/// When walking one packet has looked at this many list entries, or at [`MOST_VISITS`] times as many as the scene has
/// primitives, the slabs left are not halved further but settled ray by ray, within limits of that, so that no scene can
/// take unlimited time or memory. A packet of the published scenes looks at a few hundred. The limit must not depend on
/// what other packets of the beam have looked at, which differs with the tiles.
const MOST_WORK: usize = 1 << 17;
/// See [`MOST_WORK`].
const MOST_VISITS: usize = 64;
/// See [`MOST_WORK`]: where there are very many primitives.
const MOST_WORK_OF_MANY: usize = 1 << 22;

impl<'w, 's, L: Lanes> Walk<'w, 's, L> {
    /// Rays at the start of the slabs. `memory` is scratch space.
    #[must_use]
    pub fn new(
        sight: Sight<'w>,
        slabs: &'w mut Slabs<'s>,
        bundle: Bundle<'w>,
        quest: Quest,
        memory: &'w mut Memories<L>,
    ) -> Self {
        let Bundle { rays, limits, .. } = bundle;
        let ray = |i: usize| &rays[i.min(rays.len() - 1)];
        memory.begin();
        Self {
            sight,
            slabs,
            packet: bundle.number,
            quest,
            rays,
            origin: core::array::from_fn(|k| L::from_lanes(|i| ray(i).origin[k])),
            direction: core::array::from_fn(|k| L::from_lanes(|i| ray(i).direction[k])),
            limit: L::from_lanes(|i| limits[i.min(limits.len() - 1)]),
            alive: bundle.alive,
            outside: 0,
            inside: 0,
            memory,
            settler: Settler::default(),
            found: Vec::new(),
            work: 0,
            evaluations: 0,
        }
    }

    /// Walks all the way. The crossings come in order of t for each lane.
    #[must_use]
    pub fn run(mut self) -> (Vec<Found>, u64) {
        let root = self.slabs.root();
        self.visit(root, Span::zero(), Span::zero());
        (self.found, self.evaluations)
    }

    /// Follows the rays through a slab, given what the longer slabs around it share and have resolved.
    fn visit(&mut self, index: u32, mut shared: Span<L>, mut base: Span<L>) {
        let slab = self.slabs.slab(index);
        let (error, depth, from) = (slab.error, slab.depth, slab.from);
        let (above, below) = (slab.above, slab.below);
        let pending = [slab.pending_above, slab.pending_below];
        let resolves = !slab.resolved.is_empty();
        let (shares, joins) = (!slab.shared.is_empty(), !slab.joined.is_empty());
        let (done, kinked) = (slab.pending.is_empty(), slab.kinked);
        self.work += 1 + slab.joined.len() + slab.resolved.len() + slab.pending.len();
        // Rays that end before this slab have found nothing.
        self.alive &= L::splat(from).less(self.limit);
        let mut span = shared.plus(base);
        if self.alive == 0 || self.rejected(index, span, above, below, error) {
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
            if self.rejected(index, span, pending[0], pending[1], error) {
                return;
            }
        }
        let all = self.sight.primitives.len();
        let most = (MOST_VISITS * all).clamp(MOST_WORK, MOST_WORK_OF_MANY);
        if kinked || self.work > most || depth >= DEEPEST || self.slabs.is_blurred(index) {
            self.settle(index, self.alive);
            return;
        }
        if done {
            let doubtful = self.doubtful(span, error);
            if doubtful != 0 && !self.slabs.is_final(index) {
                let finer = self.slabs.finer(index);
                self.visit(finer, shared, Span::zero());
            } else {
                self.cross(index, span, !doubtful);
                self.settle(index, doubtful);
            }
            return;
        }
        match self.slabs.parts(index, self.packet) {
            Parts::Halves(left, right) => {
                let [near, far] = base.halves();
                let [shared_near, shared_far] = shared.halves();
                self.visit(left, shared_near, near);
                if self.alive != 0 {
                    self.visit(right, shared_far, far);
                }
            }
            Parts::Narrower(same) => self.visit(same, shared, base),
        }
    }

    /// The span of primitives that have an interpolant together.
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
        let node = |place: [L; 3]| {
            let (value, [x, y, z]) = block.total.jet(place);
            Node {
                value,
                slope: x * steps[0] + y * steps[1] + z * steps[2],
            }
        };
        Span::hermite(node(near), node(far), to - from)
    }

    /// Whether all rays are proved to stay on one side all through a slab; notes the side.
    fn rejected(&mut self, index: u32, span: Span<L>, above: f64, below: f64, error: f64) -> bool {
        let outside = span.max().less(L::splat(THRESHOLD - above - error));
        let inside = L::splat(THRESHOLD + below + error).less(span.min());
        if self.alive & !(outside | inside) != 0 {
            return false;
        }
        let slab = self.slabs.slab(index);
        let from = slab.from;
        self.arrive(index, from, outside, inside, false);
        true
    }

    /// Notes on which side the rays are, at t; a ray that was on the other side crosses there.
    fn arrive(&mut self, index: u32, t: f64, outside: u32, inside: u32, settled: bool) {
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
                settled,
            };
            self.report(found, entering >> lane & 1 != 0);
        }
    }

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

    /// The rays whose cubics do not tell for certain how often they cross in this slab: on each piece
    /// of it never, or exactly once.
    fn doubtful(&self, span: Span<L>, error: f64) -> u32 {
        Self::open(self.alive, span, error, STEEP * error, CUTS)
    }

    /// Those of some rays that are in doubt on a piece, on which differences of coefficients are off by `steep`.
    fn open(lanes: u32, span: Span<L>, error: f64, steep: f64, cuts: u32) -> u32 {
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
        let before = Self::open(open, left, error, 0.5 * steep, cuts - 1);
        before | Self::open(open & !before, right, error, 0.5 * steep, cuts - 1)
    }

    /// The crossings of some rays in a slab, by single rays in double precision.
    fn settle(&mut self, index: u32, lanes: u32) {
        let mut lanes = lanes & self.alive;
        if lanes == 0 {
            return;
        }
        let s = self.slabs.slab(index);
        let (from, to) = (s.from, s.to);
        lanes &= !self.settle_near(index, lanes);
        if lanes == 0 {
            return;
        }
        let (slabs, list) = (&*self.slabs, &mut self.settler.list);
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
            let mut settler = core::mem::take(&mut self.settler);
            settler.crossings(&along, [from, to], |t, inside| {
                let side = |yes: bool| if yes { bit } else { 0 };
                self.arrive(index, t, side(!inside), side(inside), true);
                self.alive & bit != 0
            });
            // What is settled is work, too: many short slabs would take far longer than a few long ones.
            self.work += settler.evaluations as usize;
            self.evaluations += core::mem::take(&mut settler.evaluations);
            self.settler = settler;
        }
    }

    /// The same with the interpolants of what is far, where that tells enough and saves most of the work; gives the rays that are settled.
    fn settle_near(&mut self, index: u32, lanes: u32) -> u32 {
        let all = self.slabs.count(index);
        if all <= FEW {
            return 0;
        }
        // Listing is work, too.
        self.work += all / 16;
        self.settler.list.clear();
        let afar = self.slabs.near(index, &mut self.settler.list);
        if self.settler.list.len() * WORTH > all {
            return 0;
        }
        let s = self.slabs.slab(index);
        let stretch = [s.from, s.to];
        let mut settled = 0;
        for lane in (0..L::LANES).filter(|lane| lanes >> lane & 1 != 0) {
            let along = Along {
                sight: self.sight,
                ray: self.rays[lane.min(self.rays.len() - 1)],
                resolution: self.slabs.resolution(),
            };
            let given = Given {
                node: &|t| afar.node(&along.ray, t),
                off: afar.off,
            };
            let told = self.settler.crossings_with(&along, stretch, &given);
            let spent = core::mem::take(&mut self.settler.evaluations);
            self.work += spent as usize;
            self.evaluations += spent;
            let Some(told) = told else { continue };
            let bit = 1u32 << lane;
            settled |= bit;
            for (t, inside) in told {
                let side = |yes: bool| if yes { bit } else { 0 };
                self.arrive(index, t, side(!inside), side(inside), false);
                if self.alive & bit == 0 {
                    break;
                }
            }
        }
        settled
    }

    /// The crossings of some rays in a slab whose cubics are final.
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
                // A cubic that starts on the level was said to start inside.
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
                    settled: false,
                };
                self.report(found, enters);
            }
        }
    }

    /// The sum of the spans of a slab's resolved primitives.
    fn span(&mut self, index: u32) -> Span<L> {
        let s = self.slabs.slab(index);
        let range = &s.resolved;
        let (from, to) = (s.from, s.to);
        let along = |t: f64| {
            let t = L::splat(t);
            core::array::from_fn(|k| self.origin[k] + self.direction[k] * t)
        };
        let places: [[L; 3]; 2] = [along(from), along(to)];
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

/// A primitive's value and slope along a ray.
#[inline]
fn node<L: Lanes>(primitive: &Primitive, point: [L; 3], direction: [L; 3]) -> Node<L> {
    let jet = primitive.jet(point);
    let [gx, gy, gz] = jet.gradient;
    Node {
        value: jet.value,
        slope: gx * direction[0] + gy * direction[1] + gz * direction[2],
    }
}
