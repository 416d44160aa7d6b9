//! Where along a beam which primitives need how many spans.
//!
//! The part of the beam that the soft surface can reach is halved again and again. In each slab a
//! primitive is *resolved* when one Hermite span over the slab is certified to be near enough to
//! it, for all rays of the beam; what is not yet resolved is *pending* and is handed to the halves.
//! What all rays of the beam can share is interpolated once for them: for good, if that is exact enough, or in place of
//! spans, as exact as those. What is next to nothing counts as error. So broad or distant
//! primitives get few long spans and sharp near ones many short spans. The tree grows only where a
//! ray asks for it, and is shared by all rays of the beam.
//!
//! Where a slab has become shorter than its beam is wide, halving it further would not bring the
//! rays' surroundings closer together: the beam is then divided into narrower ones instead, and each
//! packet of rays goes on in its own. In beams wider than a block of four packets there are no spans, which would be made for
//! rays that do not meet their primitives, and in wider ones than four of those no interpolants in place of spans: such beams
//! only show what is empty.
use crate::beams::Beams;
use crate::clusters::{Clusters, Members};
use crate::kinks::Kinks;
use crate::ray::Ray;
use crate::shared::{CORNERS, Cell, Shared, Sums};
use crate::spans::Node;
use core::ops::Range;
use field::bound::{Bound, Nearness, SpanLength};
use field::{Cut, Primitive, THRESHOLD};
use std::collections::BTreeMap;

/// How exactly spans follow the field.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// The sum of spans is within this of the field at first …
    pub first: f64,
    /// … and within this before a slab in which the surface may lie is decided upon.
    pub last: f64,
    /// Beyond that, the interpolants that a beam's rays share are together within this of what they stand for: so
    /// little that they are never made finer. 0: there are none, and no groups.
    pub shared: f64,
    /// Rounding of coordinates, and of values relative to a primitive's field.
    pub rounding: f64,
    /// Stretches of rays shorter than this need not be looked into, in units of the scene.
    pub resolution: f64,
}

impl Precision {
    /// For pictures: near the surface the field changes by about T over a radius, so the surface
    /// of the spans is within about 1/2000 of a radius of the true one.
    pub const PICTURE: Self = Self {
        first: 3.2e-2,
        last: 5e-4,
        shared: 4e-4,
        rounding: 2.5e-7,
        resolution: 5e-7,
    };
    /// For exact answers.
    pub const EXACT: Self = Self {
        first: 8e-3,
        last: 1e-9,
        shared: 0.0,
        rounding: 0.0,
        resolution: 1e-12,
    };
}

/// The primitives that a beam can meet, and its slabs so far.
pub struct Slabs<'a> {
    terms: Terms<'a>,
    beams: Beams<'a>,
    precision: Precision,
    /// Primitive of each local number.
    list: Vec<u32>,
    /// The first local number of each group's members that have been looked at one by one.
    opened: BTreeMap<u32, u32>,
    nodes: Vec<Slab>,
    /// Local numbers, and groups; the slabs' lists are ranges of it.
    ids: Vec<u32>,
    /// Those that are still to be looked at for a new slab.
    stack: Vec<u32>,
    blocks: Vec<Block>,
    scratch: Vec<Candidate>,
    /// Those of each fate.
    lists: [Vec<u32>; 5],
    /// Evaluations made for interpolants.
    evaluations: u64,
}

/// The space of slabs that are not needed any more, kept for others.
#[derive(Default)]
pub struct Space {
    list: Vec<u32>,
    nodes: Vec<Slab>,
    ids: Vec<u32>,
    stack: Vec<u32>,
    blocks: Vec<Block>,
    scratch: Vec<Candidate>,
    lists: [Vec<u32>; 5],
}

/// The soft surface's primitives.
#[derive(Clone, Copy)]
pub struct Terms<'a> {
    /// Their fields.
    pub primitives: &'a [Primitive],
    /// What is known of each.
    pub bounds: &'a [Bound],
    /// Each one's finish.
    pub finishes: &'a [u32],
    /// Where they are not smooth.
    pub kinks: &'a Kinks,
    /// Those that have a place, in groups, if a beam's list consists of these.
    pub clusters: Option<&'a Clusters>,
    /// Where each is at most this, it is left out.
    pub left_out: f64,
}

/// What is far from a slab, as interpolants.
pub struct Afar {
    blocks: Vec<(Cell, Shared)>,
    /// How far off these are, together with what is left out.
    pub off: f64,
}

impl Afar {
    /// Value and slope along a ray.
    #[must_use]
    pub fn node(&self, ray: &Ray, t: f64) -> Node<f64> {
        let place = ray.at(t).to_array();
        let direction = ray.direction.to_array();
        self.blocks
            .iter()
            .fold(Node::zero(), |sum, (cell, shared)| {
                let (value, [x, y, z]) = shared.jet::<f64>(cell.local(place));
                let [dx, dy, dz] = cell.steps(direction);
                let slope = x * dx + y * dy + z * dz;
                sum.plus(Node { value, slope })
            })
    }
}

/// What in a list says that a number is a group's.
const GROUP: u32 = 1 << 31;

/// What a slab's shared primitives add up to.
pub struct Block {
    /// Where.
    pub cell: Cell,
    /// All of them.
    pub total: Shared,
    /// Those of each finish.
    pub of_each: Vec<(u32, Shared)>,
    /// They add up to no more than this.
    pub top: f64,
}

/// A primitive, or a group, in a slab that is being made.
#[derive(Clone, Copy)]
struct Candidate {
    id: u32,
    magnitude: f64,
    /// What its span would be off by …
    span: f64,
    /// … and what it would add to the error of a shared interpolant.
    shared: f64,
    /// How near it is, at least.
    distance: f64,
    adds: bool,
    carves: bool,
    /// Whether it is not smooth here, so that no span follows it.
    kinked: bool,
    /// What becomes of it.
    fate: Fate,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Fate {
    Shared,
    Joined,
    Resolved,
    Pending,
    Dropped,
}

/// Which of a slab's primitives have an interpolant together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Those whose interpolant is never made finer.
    Shared,
    /// Those whose interpolant stands for their spans.
    Joined,
}

/// How a slab goes on.
#[derive(Clone, Copy, Debug)]
pub enum Parts {
    /// In its two halves, front to back.
    Halves(u32, u32),
    /// As the same slab of a narrower beam.
    Narrower(u32),
}

/// One slab of a beam.
#[derive(Clone, Debug)]
pub struct Slab {
    /// Ray parameters of its ends.
    pub from: f64,
    /// The far end.
    pub to: f64,
    /// Local numbers of the primitives, and the groups, that have one interpolant for all rays together.
    pub shared: Range<u32>,
    /// Those that are resolved, too, but by one interpolant for all rays together, less exact than that of the shared ones.
    pub joined: Range<u32>,
    /// Those that get one span over this slab for each ray.
    pub resolved: Range<u32>,
    /// Those handed to the halves.
    pub pending: Range<u32>,
    /// Those whose fields are so small that they count as part of the error.
    dropped: Range<u32>,
    /// All terms of this slab (shared, resolved and pending) together are at most this …
    pub above: f64,
    /// … and at least minus this.
    pub below: f64,
    /// The same for the pending terms alone.
    pub pending_above: f64,
    /// The same for the pending terms alone.
    pub pending_below: f64,
    /// Bound on the error of all spans over this slab: the resolved ones and the coarser ones, with
    /// the rounding of the arithmetic.
    pub error: f64,
    /// What that consists of.
    pub spent: Spent,
    /// How far rounding may put the interpolant of its shared primitives off.
    noise_of_shared: f64,
    /// What the errors may add up to.
    budget: f64,
    parent: u32,
    /// Whether what its parents resolved does not count.
    anew: bool,
    /// Whether what is pending is not smooth here, and nothing else is pending.
    pub kinked: bool,
    /// Whether rounding of something that is pending may be as large as T.
    blurring: bool,
    /// The interpolant of its shared primitives, and that of the joined ones. [`NONE`]: not yet made.
    blocks: [u32; 2],
    beam: usize,
    /// Its halves, or the same slab of the beam's quarters. 0: not yet made.
    children: [u32; 4],
    /// The same slab again with finer spans. 0: not yet made.
    finer: u32,
    /// How many times halved.
    pub depth: u32,
}

/// What the error of a slab's spans consists of.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// The rays' own spans.
    spans: f64,
    /// Shared interpolants.
    pub shared: f64,
    /// Rounding takes nothing from the budget.
    pub noise: f64,
    rounding: Rounding,
}

/// What rounding of a slab's terms and of those above it comes to, but for those that are pending.
#[derive(Clone, Copy, Debug, Default)]
struct Rounding {
    /// That of each term by itself, added up.
    sum: f64,
    /// No term is rounded by more than this part of it …
    part: f64,
    /// … but for what formulas lose that are differences of larger numbers.
    cancelled: f64,
    /// What terms below zero come to at most.
    carved: f64,
}

impl Rounding {
    /// Adds a term that is no more than a magnitude, of which no more than a part is rounded away.
    fn add(&mut self, magnitude: f64, part: f64, cancelled: f64) {
        self.sum += magnitude.at_most(self.largest()) * part;
        self.part = self.part.at_least(part);
        self.cancelled += cancelled;
    }

    /// All together, where the field is T: what adds is no more than that and what carves, and both are rounded.
    fn most(&self) -> f64 {
        self.cancelled + self.sum.at_most(self.largest() * self.part)
    }

    /// No term, nor the sizes of all together, are more than this where the field is T.
    fn largest(&self) -> f64 {
        LARGE_TERM + 2.0 * self.carved
    }
}

/// What a new slab takes from the one that it is made for.
struct Heritage {
    parent: u32,
    anew: bool,
    beam: usize,
    depth: u32,
    budget: f64,
    pub spent: Spent,
}

const NONE: u32 = u32::MAX;

/// Primitives that are at most this part of their share of the shared interpolants' error are left out of them.
const LEAST: f64 = 0.5;

/// Fewer primitives than this do not share an interpolant, whose evaluation costs a ray about as much as theirs.
const FEWEST: u32 = 3;

/// Slabs that end further out than this, in units of half the scene's size, as only infinitely wide primitives have
/// them, are halved rather than rounded much.
const REMOTE: f64 = 16.0;

/// A slab is given to narrower beams when its beam is wider than this times its length.
const NARROW: f64 = 0.5;
/// The same of beams wider than a block.
const WIDE: f64 = 0.4;
/// Beams that are divided this many times further, into four packets, are blocks.
const BLOCK: u32 = 2;

/// In beams that are divided no more than this many times further, primitives may have one interpolant in place of spans.
const JOINED: u32 = 4;

/// What is made finer has so small a part of the error it had.
const FINER: f64 = 8.0;

/// Where the field is T no term is much larger than that, unless others carve it away: what is known of rounding
/// counts terms as no larger than this.
pub const LARGE_TERM: f64 = 4.0 * THRESHOLD;

/// Where rounding tells nothing rays are settled at once in slabs that no more primitives than this count in.
const MOST_BLURRED: usize = 32;

/// An interpolant that rounding puts off by no more than this stands for its primitives also where rays are settled.
const SHARP: f64 = 2e-5;

/// Slabs and list entries above which a tree is thrown away between two packets.
const LARGE: (usize, usize) = (1 << 16, 1 << 21);

/// Slabs that [`Slabs::is_empty_for`] looks at.
const MOST_LOOKS: u32 = 64;

/// Whether a slab reaches far out, and most of it is nearer than its end.
fn is_remote(from: f64, to: f64) -> bool {
    to > REMOTE && to - from > 0.5 * to
}

impl Slab {
    /// Whether what some of its primitives add up to has been asked for.
    #[must_use]
    fn is_made(&self, which: Which) -> bool {
        self.blocks[which as usize] != NONE
    }

    /// The primitives that have an interpolant together.
    #[must_use]
    pub fn together(&self, which: Which) -> &Range<u32> {
        match which {
            Which::Shared => &self.shared,
            Which::Joined => &self.joined,
        }
    }
}

impl<'a> Slabs<'a> {
    /// The slabs of beams between two parameters. `list` holds the primitives they can meet; the groups are added.
    #[must_use]
    pub fn new(
        terms: Terms<'a>,
        list: &[u32],
        beams: Beams<'a>,
        [from, to]: [f64; 2],
        precision: Precision,
        mut space: Space,
    ) -> Self {
        let groups = terms.clusters.and_then(Clusters::root);
        space.list.clear();
        space.list.extend(list);
        space.ids.clear();
        space.ids.extend(0..list.len() as u32);
        space.ids.extend(groups.map(|root| root | GROUP));
        space.nodes.clear();
        space.blocks.clear();
        let Space {
            list,
            nodes,
            ids,
            stack,
            blocks,
            scratch,
            lists,
        } = space;
        let mut slabs = Self {
            terms,
            beams,
            precision,
            list,
            opened: BTreeMap::new(),
            nodes,
            ids,
            stack,
            blocks,
            scratch,
            lists,
            evaluations: 0,
        };
        let all = 0..slabs.ids.len() as u32;
        let heritage = Heritage {
            parent: NONE,
            anew: true,
            beam: 0,
            depth: 0,
            budget: precision.first,
            spent: Spent::default(),
        };
        slabs.add(all, from, to, heritage);
        slabs
    }

    /// The space that these took.
    #[must_use]
    pub fn into_space(self) -> Space {
        Space {
            list: self.list,
            nodes: self.nodes,
            ids: self.ids,
            stack: self.stack,
            blocks: self.blocks,
            scratch: self.scratch,
            lists: self.lists,
        }
    }

    /// The first slab, over the whole range.
    #[must_use]
    pub fn root(&self) -> u32 {
        0
    }

    /// A slab.
    #[must_use]
    pub fn slab(&self, index: u32) -> &Slab {
        &self.nodes[index as usize]
    }

    /// Local numbers in a slab's list.
    #[must_use]
    pub fn locals(&self, range: &Range<u32>) -> &[u32] {
        &self.ids[range.start as usize..range.end as usize]
    }

    /// How many local numbers there are so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// The primitive of a local number.
    #[must_use]
    pub fn primitive(&self, local: u32) -> u32 {
        self.list[local as usize]
    }

    /// Forgets all but the first slab if there are very many. To be called between packets only,
    /// as what is forgotten is found again, the same.
    pub fn tidy(&mut self) {
        if self.nodes.len() > LARGE.0 || self.ids.len() > LARGE.1 {
            self.nodes.truncate(1);
            let root = &mut self.nodes[0];
            root.children = [0; 4];
            root.finer = 0;
            root.blocks = [NONE; 2];
            self.ids.truncate(root.dropped.end as usize);
            self.blocks.clear();
        }
    }

    /// Whether it is known, after a short look and without following rays, that no ray of a packet meets
    /// anything.
    pub fn is_empty_for(&mut self, packet: usize) -> bool {
        self.tidy();
        self.is_empty_from(self.root(), packet, 0.0, &mut 0)
    }

    /// `base` is what the slabs above have at most.
    fn is_empty_from(&mut self, index: u32, packet: usize, base: f64, looks: &mut u32) -> bool {
        let slab = self.slab(index);
        let (above, error) = (slab.pending_above, slab.error);
        if base + slab.above + error < THRESHOLD {
            return true;
        }
        *looks += 1 + (slab.pending.len() / 64) as u32;
        // Where there are spans, only rays can tell.
        if !slab.resolved.is_empty() || *looks > MOST_LOOKS {
            return false;
        }
        let nothing_left = slab.pending.is_empty();
        let mut base = base;
        for which in [Which::Shared, Which::Joined] {
            base += self.block(index, which).map_or(0.0, |block| block.top);
        }
        if base + above + error < THRESHOLD {
            return true;
        }
        if nothing_left {
            return false;
        }
        match self.parts(index, packet) {
            Parts::Narrower(same) => self.is_empty_from(same, packet, base, looks),
            Parts::Halves(left, right) => {
                self.is_empty_from(left, packet, base, looks)
                    && self.is_empty_from(right, packet, base, looks)
            }
        }
    }

    /// What a slab's shared or joined primitives add up to, if it has any.
    pub fn block(&mut self, index: u32, which: Which) -> Option<&Block> {
        let slab = &self.nodes[index as usize];
        if slab.together(which).is_empty() {
            return None;
        }
        if !slab.is_made(which) {
            let cell = Cell::around(self.beams.get(slab.beam), slab.from, slab.to);
            let mut sums = Sums::new(&cell);
            let mut count = 0;
            for &id in self.locals(slab.together(which)) {
                self.each_of(id, |p| {
                    count += 1;
                    let p = p as usize;
                    sums.add(&self.terms.primitives[p], self.terms.finishes[p]);
                });
            }
            let (total, of_each) = sums.finish();
            self.evaluations += CORNERS * count;
            let made = self.blocks.len() as u32;
            self.blocks.push(Block {
                cell,
                total,
                of_each,
                top: total.top(),
            });
            self.nodes[index as usize].blocks[which as usize] = made;
        }
        let block = self.nodes[index as usize].blocks[which as usize];
        self.blocks.get(block as usize)
    }

    /// Evaluations of one primitive's field at one point that were made for all rays of the beam.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Calls `f` with the shared blocks of a slab and of those above it, where they have been asked for.
    pub fn each_block(&self, index: u32, mut f: impl FnMut(&Block)) {
        self.up(index, |s, _| {
            if let Some(block) = self.blocks.get(s.blocks[0] as usize) {
                f(block);
            }
        });
    }

    /// Calls `f` with a slab and those above it, and whether all that they have counts or what they share alone.
    fn up(&self, index: u32, mut f: impl FnMut(&Slab, bool)) {
        let (mut at, mut whole) = (index, true);
        while at != NONE {
            let s = self.slab(at);
            f(s, whole);
            whole &= !s.anew;
            at = s.parent;
        }
    }

    /// How a slab goes on for a packet.
    pub fn parts(&mut self, index: u32, packet: usize) -> Parts {
        let s = &self.nodes[index as usize];
        let (from, to) = (s.from, s.to);
        if let Some((beam, quarter)) = self.beams.quarter(s.beam, packet)
            && self.beams.get(s.beam).width(to) > self.narrow(s.beam) * (to - from)
        {
            if s.children[quarter] == 0 {
                let child = self.inner(index, from, to, beam, s.depth);
                self.nodes[index as usize].children[quarter] = child;
            }
            return Parts::Narrower(self.nodes[index as usize].children[quarter]);
        }
        if s.children == [0; 4] {
            let (beam, depth) = (s.beam, s.depth + 1);
            let middle = 0.5 * (from + to);
            let left = self.inner(index, from, middle, beam, depth);
            let right = self.inner(index, middle, to, beam, depth);
            self.nodes[index as usize].children = [left, right, 0, 0];
        }
        let [left, right, ..] = self.nodes[index as usize].children;
        Parts::Halves(left, right)
    }

    /// A slab is given to narrower beams when its beam is wider than this times its length.
    fn narrow(&self, beam: usize) -> f64 {
        if self.beams.levels_below(beam) > BLOCK {
            WIDE
        } else {
            NARROW
        }
    }

    fn inner(&mut self, parent: u32, from: f64, to: f64, beam: usize, depth: u32) -> u32 {
        let s = &self.nodes[parent as usize];
        let pending = s.pending.clone();
        let heritage = Heritage {
            parent,
            anew: false,
            beam,
            depth,
            budget: s.budget,
            spent: s.spent,
        };
        let index = self.nodes.len() as u32;
        self.add(pending, from, to, heritage);
        index
    }

    /// Whether rounding is so large, or will be of something pending, that no span shows that there is nothing here, and
    /// there are so few primitives that rays had better be settled at once. What reaches far out is halved first: what is
    /// known of the primitives far away would take the settler's pieces from what is near.
    #[must_use]
    pub fn is_blurred(&self, index: u32) -> bool {
        let slab = self.slab(index);
        if slab.spent.noise < THRESHOLD && !slab.blurring || is_remote(slab.from, slab.to) {
            return false;
        }
        let mut count = 0;
        self.each(index, true, |_| count += 1);
        count <= MOST_BLURRED
    }

    /// Whether a slab's spans are as fine as they get.
    #[must_use]
    pub fn is_final(&self, index: u32) -> bool {
        let slab = self.slab(index);
        // Rounding is what it is: spans much nearer to the field than that would tell no more.
        let last = self.precision.last.at_least(slab.spent.noise);
        slab.spent.spans <= last || slab.budget <= last
    }

    /// Stretches of rays shorter than this need not be looked into.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.precision.resolution
    }

    /// The same slab from anew, with all its primitives but the shared ones, and a smaller error.
    pub fn finer(&mut self, index: u32) -> u32 {
        if self.nodes[index as usize].finer == 0 {
            let start = self.ids.len() as u32;
            // What the path to this slab resolved, and what the slab leaves pending.
            let s = &self.nodes[index as usize];
            let pending = s.pending.clone();
            let (from, to) = (s.from, s.to);
            let budget = (s.spent.spans.at_most(s.budget) / FINER).at_least(self.precision.last);
            let heritage = Heritage {
                parent: index,
                anew: true,
                beam: s.beam,
                depth: s.depth + 1,
                budget,
                spent: Spent {
                    spans: 0.0,
                    ..s.spent
                },
            };
            self.ids
                .extend_from_within(pending.start as usize..pending.end as usize);
            let mut at = index;
            while at != NONE {
                let s = &self.nodes[at as usize];
                // These follow one another.
                let r = s.joined.start as usize..s.resolved.end as usize;
                at = if s.anew { NONE } else { s.parent };
                self.ids.extend_from_within(r);
            }
            let all = start..self.ids.len() as u32;
            let finer = self.nodes.len() as u32;
            self.add(all, from, to, heritage);
            self.nodes[index as usize].finer = finer;
        }
        self.nodes[index as usize].finer
    }

    /// Calls `f` with each primitive that counts in a slab; `all`: also with those that blocks stand for, and with the
    /// small ones.
    pub fn each(&self, index: u32, all: bool, mut f: impl FnMut(u32)) {
        let mut each = |range: &Range<u32>| {
            for &id in self.locals(range) {
                self.each_of(id, &mut f);
            }
        };
        each(&self.slab(index).pending);
        self.up(index, |s, whole| {
            if whole {
                each(&s.joined);
                each(&s.resolved);
            }
            if all {
                each(&s.shared);
                each(&s.dropped);
            }
        });
    }

    /// How many primitives count in a slab, small ones and those that blocks stand for included.
    #[must_use]
    pub fn count(&self, index: u32) -> usize {
        let mut count = 0;
        let mut all = |range: &Range<u32>| {
            for &id in self.locals(range) {
                count += match self.terms.clusters {
                    Some(clusters) if id & GROUP != 0 => clusters.all(id & !GROUP).len(),
                    _ => 1,
                };
            }
        };
        all(&self.slab(index).pending);
        self.up(index, |s, whole| {
            if whole {
                all(&s.joined);
                all(&s.resolved);
            }
            all(&s.shared);
            all(&s.dropped);
        });
        count
    }

    /// Lists the primitives that count in a slab, but for those that are next to nothing and those that interpolants stand for which
    /// rounding hardly puts off; gives these.
    pub fn near(&self, index: u32, list: &mut Vec<u32>) -> Afar {
        self.each(index, false, |p| list.push(p));
        let mut blocks = Vec::new();
        let mut off = self.slab(index).spent.shared;
        self.up(index, |s, _| {
            if let Some(block) = self.blocks.get(s.blocks[Which::Shared as usize] as usize)
                && s.noise_of_shared <= SHARP
            {
                blocks.push((block.cell, block.total));
                off += s.noise_of_shared;
            } else {
                for &id in self.locals(&s.shared) {
                    self.each_of(id, |p| list.push(p));
                }
            }
        });
        Afar { blocks, off }
    }

    /// Calls `f` with each primitive that an entry of a list stands for.
    fn each_of(&self, id: u32, mut f: impl FnMut(u32)) {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => {
                clusters.all(id & !GROUP).iter().for_each(|&p| f(p));
            }
            _ => f(self.list[id as usize]),
        }
    }

    /// What formulas of an entry of a list may lose, in units of rounding.
    fn cancels(&self, id: u32) -> f64 {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => clusters.cancels(id & !GROUP),
            _ => self.terms.bounds[self.list[id as usize] as usize].cancels(),
        }
    }

    /// About the largest slope of an entry of a list at a distance, over its size.
    fn relative_slope(&self, id: u32, distance: f64) -> f64 {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => clusters.relative_slope(id & !GROUP, distance),
            _ => {
                let bound = &self.terms.bounds[self.list[id as usize] as usize];
                bound.relative_slope(Nearness::at(distance))
            }
        }
    }

    /// The local numbers of a group's members, if it is one of the smallest, or else its parts, onto the stack.
    fn open(&mut self, clusters: &Clusters, group: u32) {
        match clusters.members(group) {
            Members::Groups(parts) => self.stack.extend(parts.map(|part| part | GROUP)),
            Members::Primitives(members) => {
                let list = &mut self.list;
                let first = *self.opened.entry(group).or_insert_with(|| {
                    let first = list.len() as u32;
                    list.extend(members);
                    first
                });
                self.stack.extend(first..first + members.len() as u32);
            }
        }
    }

    /// The local numbers of all members of a group.
    fn open_all(&mut self, clusters: &Clusters, group: u32, mut f: impl FnMut(&mut Self, u32)) {
        let bottom = self.stack.len();
        self.open(clusters, group);
        while self.stack.len() > bottom {
            match self.stack.pop() {
                Some(id) if id & GROUP != 0 => self.open(clusters, id & !GROUP),
                Some(id) => f(self, id),
                None => {}
            }
        }
    }

    fn add(&mut self, candidates: Range<u32>, from: f64, to: f64, heritage: Heritage) {
        let Heritage {
            parent,
            anew,
            beam: number,
            depth,
            budget,
            mut spent,
        } = heritage;
        let beam = self.beams.get(number);
        let levels_below = self.beams.levels_below(number);
        let (center, mut radius) = beam.ball(from, to);
        let mut roughness = f64::INFINITY;
        if self.precision.shared > 0.0 {
            let cell = Cell::around(beam, from, to);
            roughness = cell.roughness();
            radius = radius.at_least(cell.radius());
        }
        let length = SpanLength::new(to - from);
        let (direction, spread) = (beam.axis.direction, beam.spread);
        let (mut above, mut below, mut total) = (0.0, 0.0, 0.0);
        let rounding = self.precision.rounding;
        // Coordinates are rounded in the world and in the primitive's own frame.
        let misplaced = rounding * (center.abs().max_element() + radius + to).at_least(1.0);
        self.scratch.clear();
        for at in candidates {
            let mut first = Some(self.ids[at as usize]);
            while let Some(id) = first.take().or_else(|| self.stack.pop()) {
                let candidate =
                    if let (Some(clusters), true) = (self.terms.clusters, id & GROUP != 0) {
                        let group = id & !GROUP;
                        let view = clusters.view(group, center, radius);
                        if view.magnitude <= self.terms.left_out * view.count as f64 {
                            continue;
                        }
                        // Of what has kinks only single primitives have spans.
                        if view.near || view.fourth.is_infinite() && levels_below <= BLOCK {
                            self.open(clusters, group);
                            continue;
                        }
                        Candidate {
                            id,
                            magnitude: view.magnitude,
                            span: length.fourth() * view.fourth,
                            shared: view.fourth * roughness,
                            distance: view.distance,
                            adds: view.adds,
                            carves: view.carves,
                            kinked: false,
                            fate: Fate::Pending,
                        }
                    } else {
                        let primitive = self.list[id as usize];
                        let bound = &self.terms.bounds[primitive as usize];
                        let near = bound.nearness(center, radius);
                        let shortened = bound.shortened(direction, spread);
                        let length = if shortened < 1.0 {
                            SpanLength::new(shortened * (to - from))
                        } else {
                            length
                        };
                        let estimate = bound.estimate(near, &length);
                        if estimate.magnitude <= self.terms.left_out {
                            continue;
                        }
                        Candidate {
                            id,
                            magnitude: estimate.magnitude,
                            // A span is between the values' and slopes' extremes, so it is never further off than
                            // its bound says; a NaN counts as far off.
                            span: estimate.error,
                            shared: estimate.fourth * roughness,
                            distance: near.distance,
                            adds: bound.adds(),
                            carves: bound.carves(),
                            kinked: bound.has_profile() && {
                                let kinks = self.terms.kinks.of(primitive);
                                kinks.iter().any(|kink| kink.cuts(center, radius))
                            },
                            fate: Fate::Pending,
                        }
                    };
                let magnitude = candidate.magnitude;
                if candidate.adds {
                    above += magnitude;
                }
                if candidate.carves {
                    below += magnitude;
                }
                total += magnitude;
                self.scratch.push(candidate);
            }
        }
        // What is left of a budget is shared out half evenly, half by size. The shares add up
        // to no more than the whole.
        let share = |budget: f64, spent: f64| {
            let left = (budget - spent).at_least(0.0);
            let even = 0.5 * left / self.scratch.len().max(1) as f64;
            let by_size = 0.5 * left / total.at_least(f64::MIN_POSITIVE);
            move |magnitude: f64| even + by_size * magnitude
        };
        let for_spans = share(budget, spent.spans);
        let for_shared = share(self.precision.shared, spent.shared);
        let resolves = levels_below <= BLOCK;
        // A packet's own spans are as quick to make.
        let joins = (1..=JOINED).contains(&levels_below);
        // Of a slab that reaches far out, most are nearer than its end, and halves are rounded less.
        let remote = is_remote(from, to);
        let rounded = |magnitude: f64, steepness: f64| {
            magnitude.at_most(LARGE_TERM) * (4.0 * rounding + misplaced * steepness)
        };
        let mut count = 0;
        for candidate in &mut self.scratch {
            let share = for_shared(candidate.magnitude);
            if candidate.magnitude <= LEAST * share {
                // What is as small as that is as good as interpolated by nothing.
                candidate.fate = Fate::Dropped;
            } else if candidate.shared <= share {
                candidate.fate = Fate::Shared;
                count += 1;
            }
        }
        let few = count < FEWEST;
        let coarse = |c: &Candidate| {
            c.id & GROUP == 0
                && (c.fate == Fate::Pending || few && c.fate == Fate::Shared)
                && c.shared <= for_spans(c.magnitude)
        };
        let joins = joins && self.scratch.iter().filter(|c| coarse(c)).count() >= FEWEST as usize;
        spent.rounding.carved = spent.rounding.carved.at_least(below);
        let mut of_shared = Rounding {
            carved: spent.rounding.carved,
            ..Rounding::default()
        };
        let mut lists = core::mem::take(&mut self.lists);
        lists.iter_mut().for_each(Vec::clear);
        let (mut pending_above, mut pending_below) = (0.0, 0.0);
        // Whether something is pending that spans will follow, and something that they will not.
        let (mut left, mut kinked, mut blurring) = (false, false, false);
        for candidate in &self.scratch {
            let Candidate {
                id,
                magnitude,
                span,
                shared,
                ..
            } = *candidate;
            let fate = match candidate.fate {
                Fate::Dropped => Fate::Dropped,
                Fate::Shared if !few => Fate::Shared,
                _ if candidate.kinked => Fate::Pending,
                _ if remote
                    && rounded(magnitude, self.relative_slope(id, candidate.distance))
                        > for_spans(magnitude) =>
                {
                    Fate::Pending
                }
                _ if joins && coarse(candidate) => Fate::Joined,
                _ if resolves && span <= for_spans(magnitude) => Fate::Resolved,
                _ => Fate::Pending,
            };
            left |= fate == Fate::Pending && !candidate.kinked;
            kinked |= fate == Fate::Pending && candidate.kinked;
            lists[fate as usize].push(id);
            match fate {
                Fate::Shared => spent.shared += shared,
                Fate::Joined => spent.spans += shared,
                Fate::Resolved => spent.spans += span,
                Fate::Pending => {
                    if candidate.adds {
                        pending_above += magnitude;
                    }
                    if candidate.carves {
                        pending_below += magnitude;
                    }
                    if id & GROUP == 0 {
                        blurring |= 2.0 * rounding * self.cancels(id) >= THRESHOLD;
                    }
                    continue;
                }
                Fate::Dropped => {
                    spent.shared += magnitude;
                    continue;
                }
            }
            let part = rounded(1.0, self.relative_slope(id, candidate.distance));
            let cancelled = 2.0 * rounding * self.cancels(id);
            spent.rounding.add(magnitude, part, cancelled);
            if fate == Fate::Shared {
                of_shared.add(magnitude, part, cancelled);
            }
        }
        spent.noise = spent.rounding.most();
        let mut ends = [self.ids.len() as u32; 6];
        for (list, which) in lists.iter().zip(1..) {
            match self.terms.clusters {
                // Spans are those of single primitives.
                Some(clusters) if which == 1 + Fate::Resolved as usize => {
                    for &id in list {
                        if id & GROUP == 0 {
                            self.ids.push(id);
                        } else {
                            let push = |own: &mut Self, id: u32| own.ids.push(id);
                            self.open_all(clusters, id & !GROUP, push);
                        }
                    }
                }
                _ => self.ids.extend(list),
            }
            ends[which] = self.ids.len() as u32;
        }
        self.lists = lists;
        let [start, shared, joined, resolved, pending, dropped] = ends;
        self.nodes.push(Slab {
            from,
            to,
            shared: start..shared,
            joined: shared..joined,
            resolved: joined..resolved,
            pending: resolved..pending,
            dropped: pending..dropped,
            above,
            below,
            pending_above,
            pending_below,
            error: spent.spans + spent.shared + spent.noise,
            spent,
            noise_of_shared: of_shared.most(),
            budget,
            parent,
            anew,
            kinked: kinked && !left && resolves,
            blurring: blurring && resolves,
            blocks: [NONE; 2],
            beam: number,
            children: [0; 4],
            finer: 0,
            depth,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::Beam;
    use crate::soft::Soft;
    use crate::spans::Span;
    use crate::tests::common::{Numbers, clothe, element, empty, soft};
    use glam::DVec3;
    use scene::Shape;

    /// Balls in a cloud, of which every twentieth carves; `strength` of the others.
    fn cloud(radius: f64, strength: f64, carving: f64) -> Soft {
        let mut numbers = Numbers(3);
        let mut scene = empty();
        clothe(&mut scene, vec![soft(-2.0, strength), soft(-0.5, carving)]);
        for i in 0..400 {
            let center = numbers.vector();
            let carves = carving != 0.0 && i % 20 == 0;
            let shape = Shape::Sphere { center, radius };
            scene.elements.push(element(shape, u32::from(carves)));
        }
        Soft::new(scene)
    }

    /// Terms that add up to T are rounded by no more than is said, however much of them is carved away.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn what_adds_and_what_carves_are_both_rounded() {
        const PART: f64 = 1e-3;
        for carved in [0.0, 1.0, 99.0, 1e4] {
            for terms in [1, 7, 100] {
                let mut rounding = Rounding {
                    carved,
                    ..Rounding::default()
                };
                let share = 1.0 / f64::from(terms);
                for _ in 0..terms {
                    rounding.add((THRESHOLD + carved) * share, PART, 0.0);
                    rounding.add(carved * share, PART, 0.0);
                }
                let rounded = PART * (THRESHOLD + 2.0 * carved);
                let most = rounding.most();
                assert!(most >= rounded * (1.0 - 1e-9), "{carved} {terms}: {most}");
                // Bounds on terms may be far larger, and what formulas lose comes on top.
                rounding.add(1e9, PART, 0.5);
                let most = rounding.most();
                assert!((0.5..0.5 + 5.0 * rounded).contains(&most), "{most}");
            }
        }
    }

    /// What is near and the interpolants of the rest are together as near to the field as is said, on all rays of the beam; and
    /// interpolants, in single precision, are as near to their primitives.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn what_is_near_and_interpolants_are_all_of_the_field() {
        let (mut seen, mut shared, mut largest) = (0, 0, 0.0f64);
        for soft in [
            cloud(0.02, 1.0, 0.0),
            cloud(0.1, 1.0, 0.0),
            cloud(1.7, 20.0, -60.0),
        ] {
            let beam = Beam {
                axis: Ray {
                    origin: DVec3::new(0.1, 0.2, 4.0),
                    direction: DVec3::NEG_Z,
                },
                radius: 0.0,
                spread: 1e-3,
                ahead: 0.0,
            };
            let one = |base: f64| Beams::one(beam.from(base));
            let (mut slabs, base) = soft
                .slabs(0, beam, one, f64::INFINITY, &mut Vec::new())
                .expect("flesh");
            let mut stack = vec![slabs.root()];
            while let Some(index) = stack.pop() {
                slabs.block(index, Which::Shared);
                let (from, to, depth) = {
                    let slab = slabs.slab(index);
                    (slab.from, slab.to, slab.depth)
                };
                let mut list = Vec::new();
                let afar = slabs.near(index, &mut list);
                seen += 1;
                shared += usize::from(!afar.blocks.is_empty());
                for lean in [[0.0, 0.0], [0.9, 0.0], [-0.6, 0.6]] {
                    let aside = DVec3::new(lean[0], lean[1], 0.0) * beam.spread;
                    let direction = (beam.axis.direction + aside).normalize();
                    let origin = beam.axis.at(base) + aside * base;
                    let ray = Ray { origin, direction };
                    let [left, right] = [from, to].map(|t| afar.node(&ray, t));
                    let span = Span::hermite(left, right, to - from);
                    for i in 0..=8 {
                        let x = f64::from(i) / 8.0;
                        let place = ray.at(from + x * (to - from)).to_array();
                        let value = |p: &Primitive| p.value(place);
                        let all: f64 = slabs.terms.primitives.iter().map(value).sum();
                        let near = list
                            .iter()
                            .map(|&p| value(&slabs.terms.primitives[p as usize]));
                        let told = near.sum::<f64>() + span.value_and_slope(x).0;
                        // Rounding is bounded where the field is about T.
                        if (all - THRESHOLD).abs() < 1.0 {
                            let apart = (told - all).abs();
                            let most = afar.off + 1e-8;
                            assert!(apart <= most, "{index}: {apart} > {most}");
                            largest = largest.max(apart / most);
                        }
                    }
                }
                if let (true, Parts::Halves(left, right)) = (depth < 8, slabs.parts(index, 0)) {
                    stack.extend([left, right]);
                }
            }
        }
        // Nor is it said to be much further off than it is.
        assert!(
            4 * shared > seen && largest > 0.2,
            "{seen} {shared} {largest}"
        );
    }
}
