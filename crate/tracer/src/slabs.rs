//! Slabs: a binary subdivision of a beam that decides on which intervals primitives are
//! interpolated by Hermite spans.
//!
//! The part of the beam that the soft surface can reach is halved recursively. In each slab a
//! primitive is *resolved* when the error of one Hermite span over the slab is certified to be
//! small enough for all rays of the beam; else it is *pending* and is handed to the halves.
//! Primitives that are smooth across the beam are interpolated once for all its rays: *shared*, if
//! that is so accurate that it is never refined, or *joined*, in place of spans and as accurate as
//! they. Negligible primitives are *dropped* and count as error. So broad or distant primitives get
//! few long spans and sharp near ones many short spans. The tree grows on demand and is used by all
//! rays of the beam.
//!
//! Where a slab is shorter than its beam is wide, halving it further would not bring its rays
//! closer together: the beam is then divided into narrower ones, and each packet of rays continues
//! in its own. Beams wider than a block of four packets have no spans, which would be made for rays
//! that do not meet their primitives, and beams wider than four blocks no joined interpolants: they
//! only find empty space.
use crate::beams::Beams;
use crate::clusters::{Clusters, Members};
use crate::kinks::Kinks;
use crate::ray::Ray;
use crate::shared::{CORNERS, Cell, Shared, Sums};
use crate::spans::{KnownPart, Node};
use core::ops::Range;
use field::bound::{Bound, Nearness, SpanLength};
use field::{Cut, Primitive, THRESHOLD};
use glam::DVec3;
use std::collections::BTreeMap;

/// Accuracy of spans.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// Largest error of the sum of spans at first.
    pub first: f64,
    /// Largest error of the sum of spans in a slab whose crossings are decided.
    pub last: f64,
    /// Largest additional error of all shared interpolants, which are never refined. 0 stands for
    /// no shared interpolants and no groups.
    pub shared: f64,
    /// Rounding of coordinates, and of values relative to a primitive's field.
    pub rounding: f64,
    /// Length, in units of the scene, below which intervals of rays are not subdivided.
    pub resolution: f64,
}

impl Precision {
    /// Precision of pictures. Near the surface the field changes by about T over a radius, so the
    /// surface of the spans is within about 1/2000 of a radius of the true one.
    pub const PICTURE: Self = Self {
        first: 3.2e-2,
        last: 5e-4,
        shared: 4e-4,
        rounding: 2.5e-7,
        resolution: 5e-7,
    };
    /// Precision of exact crossings.
    pub const EXACT: Self = Self {
        first: 8e-3,
        last: 1e-9,
        shared: 0.0,
        rounding: 0.0,
        resolution: 1e-12,
    };
}

/// The slabs of a beam made so far, with its primitives.
pub struct Slabs<'a> {
    terms: Terms<'a>,
    beams: Beams<'a>,
    precision: Precision,
    /// Primitive number of each local number.
    list: Vec<u32>,
    /// First local number of the members of each opened group.
    opened: BTreeMap<u32, u32>,
    nodes: Vec<Slab>,
    /// Local numbers and groups; the slabs' lists are ranges of it.
    ids: Vec<u32>,
    /// Entries still to be examined for a new slab.
    stack: Vec<u32>,
    blocks: Vec<Interpolant>,
    scratch: Vec<Candidate>,
    /// Entries of a new slab, by fate.
    lists: [Vec<u32>; 5],
    /// Evaluations for interpolants so far.
    evaluations: u64,
}

/// Allocations of slabs that are no longer needed, for reuse.
#[derive(Default)]
pub struct Space {
    list: Vec<u32>,
    nodes: Vec<Slab>,
    ids: Vec<u32>,
    stack: Vec<u32>,
    blocks: Vec<Interpolant>,
    scratch: Vec<Candidate>,
    lists: [Vec<u32>; 5],
}

/// The soft surface's primitives.
#[derive(Clone, Copy)]
pub struct Terms<'a> {
    /// The primitives.
    pub primitives: &'a [Primitive],
    /// Bounds of the primitives.
    pub bounds: &'a [Bound],
    /// Finishes of the primitives.
    pub finishes: &'a [u32],
    /// Kinks of the primitives' profiles.
    pub kinks: &'a Kinks,
    /// The bounded primitives in groups, if a beam's list is to consist of groups; else it consists
    /// of single primitives.
    pub clusters: Option<&'a Clusters>,
    /// Field at which a primitive is left out.
    pub left_out: f64,
}

/// Interpolants of the primitives that are far from a slab.
pub struct Afar {
    blocks: Vec<(Cell, Shared)>,
    /// Bound on the interpolants' error, together with that of the terms left out.
    off: f64,
}

impl Afar {
    /// Calls `f` with the interpolants along a ray, as the known part of the field there.
    pub fn along<R>(&self, ray: &Ray, f: impl FnOnce(&KnownPart<'_>) -> R) -> R {
        f(&KnownPart {
            node: &|t| self.node(ray, t),
            off: self.off,
        })
    }

    /// Returns value and slope along a ray at t.
    fn node(&self, ray: &Ray, t: f64) -> Node<f64> {
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

/// Bit that marks a list entry as the number of a group.
const GROUP: u32 = 1 << 31;

/// Interpolant of a slab's shared or joined primitives.
pub struct Interpolant {
    /// Box in which the interpolant holds.
    pub cell: Cell,
    /// Interpolant of all primitives.
    pub total: Shared,
    /// Interpolants of the primitives of each finish.
    pub of_each: Vec<(u32, Shared)>,
    /// Upper bound on the total.
    pub top: f64,
}

/// A primitive or group in a slab under construction.
#[derive(Clone, Copy)]
struct Candidate {
    id: u32,
    magnitude: f64,
    /// Error bound of its span.
    span: f64,
    /// Error bound of its part of a shared interpolant.
    shared: f64,
    /// Distance from the slab, or less.
    distance: f64,
    adds: bool,
    carves: bool,
    /// Whether it has a kink in the slab, so that spans have no error bound.
    kinked: bool,
    /// The slab's list that it goes to.
    fate: Fate,
}

/// A list of a slab, in the order in which lists are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fate {
    Shared,
    Joined,
    Resolved,
    Pending,
    Dropped,
}

/// Kind of a common interpolant of a slab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Interpolant that is never refined.
    Shared,
    /// Interpolant in place of spans.
    Joined,
}

/// Children of a slab.
#[derive(Clone, Copy, Debug)]
pub enum Parts {
    /// Numbers of the slab's two halves, front to back.
    Halves(u32, u32),
    /// Number of the slab over the same interval of a narrower beam.
    Narrower(u32),
}

/// A part of a beam between two parameters, with lists of its primitives.
#[derive(Clone, Debug)]
pub struct Slab {
    /// Ray parameter of the near end.
    pub from: f64,
    /// Ray parameter of the far end.
    pub to: f64,
    /// List of the entries with a shared interpolant.
    pub shared: Range<u32>,
    /// List of the entries with a joined interpolant.
    pub joined: Range<u32>,
    /// List of the resolved primitives: one span over this slab for each ray.
    pub resolved: Range<u32>,
    /// List of the pending entries, for the children.
    pub pending: Range<u32>,
    /// List of the dropped entries, whose fields count as error.
    dropped: Range<u32>,
    /// Upper bound on the sum of this slab's terms (shared, joined, resolved and pending).
    pub above: f64,
    /// Minus a lower bound on the sum of this slab's terms.
    pub below: f64,
    /// Upper bound on the sum of the pending terms.
    pub pending_above: f64,
    /// Minus a lower bound on the sum of the pending terms.
    pub pending_below: f64,
    /// Bound on the error of all spans over this slab: its own, and those of the slabs that contain
    /// it, with rounding.
    pub error: f64,
    /// Parts of `error`.
    pub spent: Spent,
    /// Bound on the rounding error of the shared interpolant.
    noise_of_shared: f64,
    /// Largest error allowed for spans.
    budget: f64,
    parent: u32,
    /// Whether the slab starts again: its own lists include the primitives that its parents
    /// resolved.
    anew: bool,
    /// Whether all pending primitives have kinks here.
    pub kinked: bool,
    /// Largest [`Bound::log_bend`] of a pending primitive.
    pub log_bend: f64,
    /// Whether rounding of a pending primitive may be as large as T.
    blurring: bool,
    /// Whether a pending primitive's pole is so near that bounds say nothing.
    polar: bool,
    /// Numbers of the shared and the joined interpolant; [`NONE`] until one is made.
    blocks: [u32; 2],
    beam: usize,
    /// Numbers of the slab's halves, or of slabs over its interval of the beam's quarters; 0 until
    /// one is made.
    children: [u32; 4],
    /// Number of the slab with finer spans in its place; 0 until that is made.
    finer: u32,
    /// Number of halvings.
    pub depth: u32,
}

/// Parts of the error of a slab's spans.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Errors of spans and joined interpolants.
    spans: f64,
    /// Errors of shared interpolants, and dropped terms.
    pub shared: f64,
    /// Rounding, which does not count against the budget.
    pub noise: f64,
    rounding: Rounding,
}

/// Bound on the rounding of the terms of a slab and of those above it, without the pending ones.
#[derive(Clone, Copy, Debug, Default)]
struct Rounding {
    /// Sum of the terms' roundings.
    sum: f64,
    /// Largest rounding of a term relative to it.
    part: f64,
    /// Sum of the losses of formulas that subtract larger numbers, which `sum` and `part` leave
    /// out.
    cancelled: f64,
    /// Bound on the sum of negative terms.
    carved: f64,
}

impl Rounding {
    /// Adds a term with a bound on its size, one on its relative rounding, and the loss of its
    /// formula.
    fn add(&mut self, magnitude: f64, part: f64, cancelled: f64) {
        self.sum += magnitude.at_most(self.largest()) * part;
        self.part = self.part.at_least(part);
        self.cancelled += cancelled;
    }

    /// Bounds the total where the field is T: there positive terms are at most T plus the negative
    /// ones.
    fn most(&self) -> f64 {
        self.cancelled + self.sum.at_most(self.largest() * self.part)
    }

    /// Returns a bound on a term, and on the sum of the terms' sizes, where the field is T.
    fn largest(&self) -> f64 {
        LARGE_TERM + 2.0 * self.carved
    }
}

/// Values that a new slab inherits from its parent.
struct Heritage {
    parent: u32,
    anew: bool,
    beam: usize,
    depth: u32,
    budget: f64,
    pub spent: Spent,
}

/// Geometry of a new slab.
struct SlabGeometry {
    from: f64,
    to: f64,
    /// Centre of a ball around the slab.
    center: DVec3,
    /// Radius of that ball.
    radius: f64,
    /// Direction of the beam's axis.
    direction: DVec3,
    /// The beam's spread.
    spread: f64,
    /// Levels of division below the beam.
    levels_below: u32,
    /// Factor from a fourth derivative to the error of a shared interpolant; infinite without
    /// shared interpolants.
    roughness: f64,
    length: SpanLength,
    /// Rounding of coordinates.
    misplaced: f64,
}

/// Sums of bounds over a new slab's candidates.
#[derive(Default)]
struct Sizes {
    /// Sum over the candidates that may be positive.
    above: f64,
    /// Sum over the candidates that may be negative.
    below: f64,
    /// Sum over all candidates.
    total: f64,
}

/// The part of the error budget that a candidate may use: half of the rest is divided evenly, half
/// by size. The shares add up to no more than the rest.
#[derive(Clone, Copy)]
struct Share {
    even: f64,
    by_size: f64,
}

impl Share {
    /// Returns the shares of `count` candidates of the size `total` in all, given the part of the
    /// budget that is spent.
    fn of(budget: f64, spent: f64, count: usize, total: f64) -> Self {
        let left = (budget - spent).at_least(0.0);
        Self {
            even: 0.5 * left / count.max(1) as f64,
            by_size: 0.5 * left / total.at_least(f64::MIN_POSITIVE),
        }
    }

    /// Returns the share of a candidate.
    #[inline(always)]
    fn at(self, magnitude: f64) -> f64 {
        self.even + self.by_size * magnitude
    }
}

/// Decisions for all candidates of a new slab.
struct Plan {
    for_spans: Share,
    /// Whether too few candidates could share an interpolant.
    few: bool,
    /// Whether the beam is narrow enough for spans.
    resolves: bool,
    /// Whether there is a joined interpolant.
    joins: bool,
    /// Whether candidates with large rounding are handed to the halves.
    remote: bool,
}

impl Plan {
    /// Whether a candidate may be part of a joined interpolant.
    #[inline(always)]
    fn is_joinable(&self, c: &Candidate) -> bool {
        c.id & GROUP == 0
            && (c.fate == Fate::Pending || self.few && c.fate == Fate::Shared)
            && c.shared <= self.for_spans.at(c.magnitude)
    }
}

/// Sums over a new slab's candidates by fate.
#[derive(Default)]
struct Sorted {
    pending_above: f64,
    pending_below: f64,
    /// Whether a pending candidate has no kink in the slab.
    smooth: bool,
    /// Whether a pending candidate has a kink in the slab.
    kinked: bool,
    blurring: bool,
    polar: bool,
    /// Largest [`Bound::log_bend`] of a pending candidate.
    log_bend: f64,
    /// Rounding of the shared interpolant.
    of_shared: Rounding,
}

/// Number in place of a slab or an interpolant that there is not.
const NONE: u32 = u32::MAX;

/// Fraction of its share of the shared interpolants' error up to which a primitive is dropped.
const DROPPED_SHARE: f64 = 0.5;

/// Fewest primitives for a common interpolant: fewer cost a ray about as much as its evaluation.
const FEWEST: u32 = 3;

/// Distance, in units of half the scene's size, beyond which slabs are halved rather than lose
/// digits; only infinitely wide primitives have such slabs.
const REMOTE: f64 = 16.0;

/// Ratio of a beam's width to a slab's length from which narrower beams take over.
const NARROW_BEAM: f64 = 0.5;
/// Ratio of a beam's width to a slab's length from which narrower beams take over, for beams wider
/// than a block.
const WIDE_BEAM: f64 = 0.4;
/// Levels of division below a block, which is a beam of four packets.
const BLOCK_LEVELS: u32 = 2;

/// Most levels of division below a beam with joined interpolants.
const JOINED_LEVELS: u32 = 4;

/// Factor by which refining a slab divides its error.
const FINER: f64 = 8.0;

/// Largest term that bounds on rounding assume: where the field is T, larger ones occur only with
/// negative terms.
pub const LARGE_TERM: f64 = 4.0 * THRESHOLD;

/// Most primitives in a slab whose crossings are isolated at once where rounding is as large as T.
const MOST_BLURRED: usize = 32;

/// Largest rounding error of an interpolant that root isolation uses in place of its primitives.
const SHARP_INTERPOLANT: f64 = 2e-5;

/// Bound on a field with a pole from which the pole counts as near.
const POLAR: f64 = 64.0 * THRESHOLD;

/// Numbers of slabs and of list entries above which a tree is discarded between two packets.
const LARGE: (usize, usize) = (1 << 16, 1 << 21);

/// Most slabs that [`Slabs::is_empty_for`] visits.
const MOST_EMPTY_LOOKS: u32 = 64;

/// Whether a slab ends far out and starts in the nearer half of its range.
fn is_remote(from: f64, to: f64) -> bool {
    to > REMOTE && to - from > 0.5 * to
}

impl Slab {
    /// Whether an interpolant has been made.
    #[must_use]
    fn is_made(&self, which: Which) -> bool {
        self.blocks[which as usize] != NONE
    }

    /// Returns the list of the entries of an interpolant.
    #[must_use]
    pub fn together(&self, which: Which) -> &Range<u32> {
        match which {
            Which::Shared => &self.shared,
            Which::Joined => &self.joined,
        }
    }
}

impl<'a> Slabs<'a> {
    /// Starts the slabs of beams between two parameters. `list` holds the primitives near them; the
    /// groups are added.
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

    /// Returns the allocations for reuse.
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

    /// Returns the number of the first slab, over the whole range.
    #[must_use]
    pub fn root(&self) -> u32 {
        0
    }

    /// Returns a slab.
    #[must_use]
    pub fn slab(&self, index: u32) -> &Slab {
        &self.nodes[index as usize]
    }

    /// Returns the entries of a slab's list.
    #[must_use]
    pub fn locals(&self, range: &Range<u32>) -> &[u32] {
        &self.ids[range.start as usize..range.end as usize]
    }

    /// Returns the number of local numbers so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns the primitive of a local number.
    #[must_use]
    pub fn primitive(&self, local: u32) -> u32 {
        self.list[local as usize]
    }

    /// Discards all but the first slab if there are very many; they are made again on demand, with
    /// the same result. To be called between packets only.
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

    /// Whether bounds prove, in a few steps and without evaluating rays, that no ray of a packet
    /// meets the surface.
    pub fn is_empty_for(&mut self, packet: usize) -> bool {
        self.tidy();
        self.is_empty_from(self.root(), packet, 0.0, &mut 0)
    }

    /// [`Slabs::is_empty_for`] below a slab; `base` bounds the interpolants of the slabs above.
    fn is_empty_from(&mut self, index: u32, packet: usize, base: f64, looks: &mut u32) -> bool {
        let slab = self.slab(index);
        let (above, error) = (slab.pending_above, slab.error);
        if base + slab.above + error < THRESHOLD {
            return true;
        }
        *looks += 1 + (slab.pending.len() / 64) as u32;
        // Spans can only be evaluated for rays.
        if !slab.resolved.is_empty() || *looks > MOST_EMPTY_LOOKS {
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

    /// Returns the interpolant of a slab's shared or joined primitives, made at first use; `None`
    /// if it has none.
    pub fn block(&mut self, index: u32, which: Which) -> Option<&Interpolant> {
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
            self.blocks.push(Interpolant {
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

    /// Returns the number of evaluations of one primitive's field at one point for interpolants of
    /// the beam.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Calls `f` with the shared interpolants of a slab and of those above it that have been made.
    pub fn each_block(&self, index: u32, mut f: impl FnMut(&Interpolant)) {
        self.climb(index, |s, _| {
            if let Some(block) = self.blocks.get(s.blocks[0] as usize) {
                f(block);
            }
        });
    }

    /// Calls `f` with a slab and those above it, and whether all of its terms count, or only the
    /// shared and dropped ones.
    fn climb(&self, index: u32, mut f: impl FnMut(&Slab, bool)) {
        let (mut at, mut whole) = (index, true);
        while at != NONE {
            let s = self.slab(at);
            f(s, whole);
            whole &= !s.anew;
            at = s.parent;
        }
    }

    /// Returns a slab's children for a packet, made at first use.
    pub fn parts(&mut self, index: u32, packet: usize) -> Parts {
        let s = &self.nodes[index as usize];
        let (from, to) = (s.from, s.to);
        if let Some((beam, quarter)) = self.beams.quarter(s.beam, packet)
            && self.beams.get(s.beam).width(to) > self.narrow(s.beam) * (to - from)
        {
            if s.children[quarter] == 0 {
                let child = self.add_child(index, from, to, beam, s.depth);
                self.nodes[index as usize].children[quarter] = child;
            }
            return Parts::Narrower(self.nodes[index as usize].children[quarter]);
        }
        if s.children == [0; 4] {
            let (beam, depth) = (s.beam, s.depth + 1);
            let middle = 0.5 * (from + to);
            let left = self.add_child(index, from, middle, beam, depth);
            let right = self.add_child(index, middle, to, beam, depth);
            self.nodes[index as usize].children = [left, right, 0, 0];
        }
        let [left, right, ..] = self.nodes[index as usize].children;
        Parts::Halves(left, right)
    }

    /// Returns the ratio of a beam's width to a slab's length from which narrower beams take over.
    fn narrow(&self, beam: usize) -> f64 {
        if self.beams.levels_below(beam) > BLOCK_LEVELS {
            WIDE_BEAM
        } else {
            NARROW_BEAM
        }
    }

    /// Makes a child of a slab between two parameters; returns its number.
    fn add_child(&mut self, parent: u32, from: f64, to: f64, beam: usize, depth: u32) -> u32 {
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

    /// Whether rounding (also of pending primitives) is as large as T, so that spans prove nothing,
    /// and the primitives are so few that crossings are isolated at once. Slabs that end far out
    /// are halved first, as their far part would use up the pieces for the near one.
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

    /// Whether the beam is so near a pole that bounds say nothing, and the slab so short that only
    /// single rays are farther from it. Halving would go on for the rays beside the surface of a
    /// body that is as thin as the beam.
    #[must_use]
    pub fn is_polar(&self, index: u32, packet: usize) -> bool {
        let slab = self.slab(index);
        slab.polar && self.beams.quarter(slab.beam, packet).is_none() && {
            let width = self.beams.get(slab.beam).width(slab.to);
            width > self.narrow(slab.beam) * (slab.to - slab.from)
        }
    }

    /// Whether a slab's spans are at their final accuracy.
    #[must_use]
    pub fn is_final(&self, index: u32) -> bool {
        let slab = self.slab(index);
        // Spans more accurate than rounding would be no better.
        let last = self.precision.last.at_least(slab.spent.noise);
        slab.spent.spans <= last || slab.budget <= last
    }

    /// Returns a ball around the points at t of all rays of a slab's beam.
    #[must_use]
    pub fn ball(&self, index: u32, t: f64) -> (DVec3, f64) {
        self.beams.get(self.slab(index).beam).ball(t, t)
    }

    /// Returns the length below which intervals of rays are not subdivided.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.precision.resolution
    }

    /// Returns the number of a slab in place of another, with a smaller error, made again from all
    /// its primitives but the shared ones.
    pub fn refine(&mut self, index: u32) -> u32 {
        if self.nodes[index as usize].finer == 0 {
            let start = self.ids.len() as u32;
            // The slab's pending entries, and the resolved and joined ones of the path to it.
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
                // The joined and resolved ranges are adjacent.
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

    /// Calls `f` with each primitive that counts in a slab; with `all` also with the shared and
    /// dropped ones.
    pub fn each(&self, index: u32, all: bool, mut f: impl FnMut(u32)) {
        self.each_local(index, all, |id| self.each_of(id, &mut f));
    }

    /// Calls `f` with each pending primitive of a slab; returns bounds on the rounding of their
    /// sum: a part of it, and what is added to that.
    pub fn list_pending(&self, index: u32, mut f: impl FnMut(u32)) -> [f64; 2] {
        let slab = self.slab(index);
        let misplaced = self.geometry(slab.beam, slab.from, slab.to).misplaced;
        let rounding = self.precision.rounding;
        let (mut steep, mut cancelled) = (0.0, 0.0);
        for &id in self.locals(&slab.pending) {
            steep = self.relative_slope(id, 0.0).at_least(steep);
            cancelled += self.cancels(id);
            self.each_of(id, &mut f);
        }
        [
            4.0 * rounding + misplaced * steep,
            2.0 * rounding * cancelled,
        ]
    }

    /// Returns the number of primitives that count in a slab, with the shared and dropped ones.
    #[must_use]
    pub fn count(&self, index: u32) -> usize {
        let mut count = 0;
        self.each_local(index, true, |id| {
            count += match self.terms.clusters {
                Some(clusters) if id & GROUP != 0 => clusters.all(id & !GROUP).len(),
                _ => 1,
            };
        });
        count
    }

    /// Calls `f` with each primitive or group that counts in a slab; with `all` also with the
    /// shared and dropped ones.
    fn each_local(&self, index: u32, all: bool, mut f: impl FnMut(u32)) {
        let mut each = |range: &Range<u32>| self.locals(range).iter().for_each(|&id| f(id));
        each(&self.slab(index).pending);
        self.climb(index, |s, whole| {
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

    /// Lists the primitives that count in a slab, without the dropped ones and those in accurate
    /// shared interpolants; returns these interpolants.
    pub fn list_near(&self, index: u32, list: &mut Vec<u32>) -> Afar {
        self.each(index, false, |p| list.push(p));
        let mut blocks = Vec::new();
        let mut off = self.slab(index).spent.shared;
        self.climb(index, |s, _| {
            if let Some(block) = self.blocks.get(s.blocks[Which::Shared as usize] as usize)
                && s.noise_of_shared <= SHARP_INTERPOLANT
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

    /// Calls `f` with each primitive of a list entry.
    fn each_of(&self, id: u32, mut f: impl FnMut(u32)) {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => {
                clusters.all(id & !GROUP).iter().for_each(|&p| f(p));
            }
            _ => f(self.list[id as usize]),
        }
    }

    /// Returns the size of the terms that cancel in the formulas of a list entry
    /// ([`Bound::cancels`]).
    fn cancels(&self, id: u32) -> f64 {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => clusters.cancels(id & !GROUP),
            _ => self.terms.bounds[self.list[id as usize] as usize].cancels(),
        }
    }

    /// Returns the largest [`Bound::log_bend`] of a list entry.
    fn log_bend(&self, id: u32) -> f64 {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => clusters.log_bend(id & !GROUP),
            _ => self.terms.bounds[self.list[id as usize] as usize].log_bend(),
        }
    }

    /// Whether a primitive of the list has a pole that is near. Faces of the inverse kernel have a
    /// small field and no pole; those of the squared one grow only like a logarithm, so that their
    /// field does not show it.
    fn is_at_pole(&self, id: u32, magnitude: f64, touches: bool) -> bool {
        let primitive = self.list[id as usize] as usize;
        let kernel = self.terms.primitives[primitive].kernel;
        kernel.has_pole() && (magnitude >= POLAR || touches && kernel.is_finite_over(1))
    }

    /// Estimates a list entry's largest relative slope at a distance ([`Bound::relative_slope`]).
    fn relative_slope(&self, id: u32, distance: f64) -> f64 {
        match self.terms.clusters {
            Some(clusters) if id & GROUP != 0 => clusters.relative_slope(id & !GROUP, distance),
            _ => {
                let bound = &self.terms.bounds[self.list[id as usize] as usize];
                bound.relative_slope(Nearness::at(distance))
            }
        }
    }

    /// Pushes a group's two parts onto the stack, or, for one of the smallest groups, its members'
    /// local numbers.
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

    /// Calls `f` with the local numbers of all members of a group.
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

    /// Makes the slab between two parameters from a parent's entries.
    fn add(&mut self, candidates: Range<u32>, from: f64, to: f64, heritage: Heritage) {
        let place = self.geometry(heritage.beam, from, to);
        let sizes = self.gather(candidates, &place);
        let plan = self.plan(&place, &sizes, &heritage);
        let mut spent = heritage.spent;
        spent.rounding.carved = spent.rounding.carved.at_least(sizes.below);
        let sorted = self.sort(&place, &plan, &mut spent);
        let [start, shared, joined, resolved, pending, dropped] = self.store_lists();
        self.nodes.push(Slab {
            from,
            to,
            shared: start..shared,
            joined: shared..joined,
            resolved: joined..resolved,
            pending: resolved..pending,
            dropped: pending..dropped,
            above: sizes.above,
            below: sizes.below,
            pending_above: sorted.pending_above,
            pending_below: sorted.pending_below,
            error: spent.spans + spent.shared + spent.noise,
            spent,
            noise_of_shared: sorted.of_shared.most(),
            budget: heritage.budget,
            parent: heritage.parent,
            anew: heritage.anew,
            kinked: sorted.kinked && !sorted.smooth && plan.resolves,
            log_bend: sorted.log_bend,
            blurring: sorted.blurring && plan.resolves,
            polar: sorted.polar && plan.resolves,
            blocks: [NONE; 2],
            beam: heritage.beam,
            children: [0; 4],
            finer: 0,
            depth: heritage.depth,
        });
    }

    /// Returns the geometry of a beam's part between two parameters.
    fn geometry(&self, number: usize, from: f64, to: f64) -> SlabGeometry {
        let beam = self.beams.get(number);
        let (center, mut radius) = beam.ball(from, to);
        let mut roughness = f64::INFINITY;
        if self.precision.shared > 0.0 {
            let cell = Cell::around(beam, from, to);
            roughness = cell.roughness();
            radius = radius.at_least(cell.radius());
        }
        let rounding = self.precision.rounding;
        SlabGeometry {
            from,
            to,
            center,
            radius,
            direction: beam.axis.direction,
            spread: beam.spread,
            levels_below: self.beams.levels_below(number),
            roughness,
            length: SpanLength::new(to - from),
            // Coordinates are rounded in the world and in the primitive's own frame.
            misplaced: rounding * (center.abs().max_element() + radius + to).at_least(1.0),
        }
    }

    /// Collects the candidates of a new slab in `scratch`, without negligible ones; near groups are
    /// opened.
    fn gather(&mut self, candidates: Range<u32>, place: &SlabGeometry) -> Sizes {
        let mut sizes = Sizes::default();
        self.scratch.clear();
        for at in candidates {
            let mut first = Some(self.ids[at as usize]);
            while let Some(id) = first.take().or_else(|| self.stack.pop()) {
                let candidate = match self.terms.clusters {
                    Some(clusters) if id & GROUP != 0 => self.group(clusters, id & !GROUP, place),
                    _ => self.single(id, place),
                };
                let Some(candidate) = candidate else {
                    continue;
                };
                let magnitude = candidate.magnitude;
                if candidate.adds {
                    sizes.above += magnitude;
                }
                if candidate.carves {
                    sizes.below += magnitude;
                }
                sizes.total += magnitude;
                self.scratch.push(candidate);
            }
        }
        sizes
    }

    /// Returns a group as a candidate; `None` if it is negligible, or if its parts are candidates
    /// instead.
    #[inline(always)]
    fn group(
        &mut self,
        clusters: &Clusters,
        group: u32,
        place: &SlabGeometry,
    ) -> Option<Candidate> {
        let view = clusters.view(group, place.center, place.radius);
        if view.magnitude <= self.terms.left_out * view.count as f64 {
            return None;
        }
        // With kinks only single primitives have spans.
        if view.near || view.fourth.is_infinite() && place.levels_below <= BLOCK_LEVELS {
            self.open(clusters, group);
            return None;
        }
        Some(Candidate {
            id: group | GROUP,
            magnitude: view.magnitude,
            span: place.length.fourth() * view.fourth,
            shared: view.fourth * place.roughness,
            distance: view.distance,
            adds: view.adds,
            carves: view.carves,
            kinked: false,
            fate: Fate::Pending,
        })
    }

    /// Returns a primitive as a candidate; `None` if it is negligible.
    #[inline(always)]
    fn single(&self, id: u32, place: &SlabGeometry) -> Option<Candidate> {
        let (center, radius) = (place.center, place.radius);
        let primitive = self.list[id as usize];
        let bound = &self.terms.bounds[primitive as usize];
        let near = bound.nearness(center, radius);
        let shortened = bound.shortened(place.direction, place.spread);
        let length = if shortened < 1.0 {
            SpanLength::new(shortened * (place.to - place.from))
        } else {
            place.length
        };
        let estimate = bound.estimate(near, &length);
        if estimate.magnitude <= self.terms.left_out {
            return None;
        }
        Some(Candidate {
            id,
            magnitude: estimate.magnitude,
            // A span is between the values' and slopes' extremes, so its error is never larger than
            // the bound; NaN counts as a large error.
            span: estimate.error,
            shared: estimate.fourth * place.roughness,
            distance: near.distance,
            adds: bound.adds(),
            carves: bound.carves(),
            kinked: bound.has_profile() && {
                let kinks = self.terms.kinks.of(primitive);
                kinks.iter().any(|kink| kink.cuts(center, radius))
            },
            fate: Fate::Pending,
        })
    }

    /// Marks the candidates to drop and to share, and decides which interpolants the slab has.
    fn plan(&mut self, place: &SlabGeometry, sizes: &Sizes, heritage: &Heritage) -> Plan {
        let count = self.scratch.len();
        let share = |budget: f64, spent: f64| Share::of(budget, spent, count, sizes.total);
        let for_spans = share(heritage.budget, heritage.spent.spans);
        let for_shared = share(self.precision.shared, heritage.spent.shared);
        let mut sharing = 0;
        for candidate in &mut self.scratch {
            let share = for_shared.at(candidate.magnitude);
            if candidate.magnitude <= DROPPED_SHARE * share {
                // As small as the error of an interpolant.
                candidate.fate = Fate::Dropped;
            } else if candidate.shared <= share {
                candidate.fate = Fate::Shared;
                sharing += 1;
            }
        }
        let mut plan = Plan {
            for_spans,
            few: sharing < FEWEST,
            resolves: place.levels_below <= BLOCK_LEVELS,
            // A packet's own spans cost as little as joined interpolants.
            joins: (1..=JOINED_LEVELS).contains(&place.levels_below),
            // Most of a slab that ends far out is nearer than its end, and its halves are rounded
            // less.
            remote: is_remote(place.from, place.to),
        };
        if plan.joins {
            let joinable = self.scratch.iter().filter(|c| plan.is_joinable(c));
            plan.joins = joinable.count() >= FEWEST as usize;
        }
        plan
    }

    /// Sorts the candidates into `lists`, by fate, and adds their errors and rounding.
    fn sort(&mut self, place: &SlabGeometry, plan: &Plan, spent: &mut Spent) -> Sorted {
        let rounding = self.precision.rounding;
        let rounded = |magnitude: f64, steepness: f64| {
            magnitude.at_most(LARGE_TERM) * (4.0 * rounding + place.misplaced * steepness)
        };
        let mut sorted = Sorted {
            of_shared: Rounding {
                carved: spent.rounding.carved,
                ..Rounding::default()
            },
            ..Sorted::default()
        };
        let mut lists = core::mem::take(&mut self.lists);
        lists.iter_mut().for_each(Vec::clear);
        for candidate in &self.scratch {
            let Candidate {
                id,
                magnitude,
                span,
                shared,
                ..
            } = *candidate;
            let for_spans = || plan.for_spans.at(magnitude);
            let fate = match candidate.fate {
                Fate::Dropped => Fate::Dropped,
                Fate::Shared if !plan.few => Fate::Shared,
                _ if candidate.kinked => Fate::Pending,
                _ if plan.remote
                    && rounded(magnitude, self.relative_slope(id, candidate.distance))
                        > for_spans() =>
                {
                    Fate::Pending
                }
                _ if plan.joins && plan.is_joinable(candidate) => Fate::Joined,
                _ if plan.resolves && span <= for_spans() => Fate::Resolved,
                _ => Fate::Pending,
            };
            lists[fate as usize].push(id);
            match fate {
                Fate::Shared => spent.shared += shared,
                Fate::Joined => spent.spans += shared,
                Fate::Resolved => spent.spans += span,
                Fate::Pending => {
                    sorted.smooth |= !candidate.kinked;
                    sorted.kinked |= candidate.kinked;
                    sorted.log_bend = sorted.log_bend.at_least(self.log_bend(id));
                    if candidate.adds {
                        sorted.pending_above += magnitude;
                    }
                    if candidate.carves {
                        sorted.pending_below += magnitude;
                    }
                    if id & GROUP == 0 {
                        sorted.blurring |= 2.0 * rounding * self.cancels(id) >= THRESHOLD;
                        let touches = candidate.distance == 0.0;
                        sorted.polar |= self.is_at_pole(id, magnitude, touches);
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
                sorted.of_shared.add(magnitude, part, cancelled);
            }
        }
        spent.noise = spent.rounding.most();
        self.lists = lists;
        sorted
    }

    /// Appends `lists` to `ids`; returns the start and the ends of the lists there. Groups to
    /// resolve are replaced by their members.
    fn store_lists(&mut self) -> [u32; 6] {
        let lists = core::mem::take(&mut self.lists);
        let mut ends = [self.ids.len() as u32; 6];
        for (list, which) in lists.iter().zip(1..) {
            match self.terms.clusters {
                // Spans are those of single primitives.
                Some(clusters) if which == 1 + Fate::Resolved as usize => {
                    for &id in list {
                        if id & GROUP == 0 {
                            self.ids.push(id);
                        } else {
                            self.open_all(clusters, id & !GROUP, |slabs, id| slabs.ids.push(id));
                        }
                    }
                }
                _ => self.ids.extend(list),
            }
            ends[which] = self.ids.len() as u32;
        }
        self.lists = lists;
        ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::Beam;
    use crate::soft::Soft;
    use crate::spans::Span;
    use glam::DVec3;
    use scene::Shape;
    use trials::Random;
    use trials::scenes::{clothe, element, empty, soft};

    /// Returns a cloud of balls of a strength, of which every twentieth has the strength `carving`
    /// unless that is 0.
    fn cloud(radius: f64, strength: f64, carving: f64) -> Soft {
        let mut numbers = Random::new(3);
        let mut scene = empty();
        clothe(&mut scene, vec![soft(2.0, strength), soft(0.5, carving)]);
        for i in 0..400 {
            let center = numbers.vector(1.0);
            let carves = carving != 0.0 && i % 20 == 0;
            let shape = Shape::sphere(center, radius);
            scene.elements.push(element(shape, u32::from(carves)));
        }
        let surfaces = scene.soft_surfaces();
        Soft::new(scene, surfaces)
    }

    /// The bound on rounding holds for terms that add up to T, whatever the sum of the negative
    /// ones.
    #[test]
    fn rounding_of_positive_and_negative_terms_is_bounded() {
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
                // Bounds on terms may be far larger; losses of formulas are added.
                rounding.add(1e9, PART, 0.5);
                let most = rounding.most();
                assert!((0.5..0.5 + 5.0 * rounded).contains(&most), "{most}");
            }
        }
    }

    /// The listed primitives and the interpolants of the rest add up to the field within their
    /// bound, on all rays of the beam.
    #[test]
    fn near_primitives_and_interpolants_add_up_to_the_field() {
        let (mut seen, mut shared, mut noisy, mut largest) = (0, 0, 0, 0.0f64);
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
            let (mut slabs, base) = soft
                .slabs(
                    0,
                    beam,
                    |base| Beams::one(beam.from(base)),
                    f64::INFINITY,
                    &mut Vec::new(),
                )
                .expect("flesh");
            let mut stack = vec![slabs.root()];
            while let Some(index) = stack.pop() {
                slabs.block(index, Which::Shared);
                let (from, to, depth) = {
                    let slab = slabs.slab(index);
                    (slab.from, slab.to, slab.depth)
                };
                let mut list = Vec::new();
                let afar = slabs.list_near(index, &mut list);
                let count = afar.blocks.len();
                if count > 0 {
                    // Rounding of the interpolants is part of the bound. It is far below its own
                    // bound here: a larger one is set.
                    let noise = slabs.nodes[index as usize].noise_of_shared;
                    slabs.nodes[index as usize].noise_of_shared = SHARP_INTERPOLANT;
                    let louder = slabs.list_near(index, &mut Vec::new());
                    if louder.blocks.len() == count && !slabs.slab(index).shared.is_empty() {
                        let more = louder.off - afar.off;
                        let added = SHARP_INTERPOLANT - noise;
                        assert!((more - added).abs() < 1e-12, "{index}: {more} {added}");
                        noisy += 1;
                    }
                    slabs.nodes[index as usize].noise_of_shared = noise;
                }
                seen += 1;
                shared += usize::from(!afar.blocks.is_empty());
                for lean in [[0.0, 0.0], [0.9, 0.0], [-0.6, 0.6]] {
                    let aside = DVec3::new(lean[0], lean[1], 0.0) * beam.spread;
                    let direction = (beam.axis.direction + aside).normalize();
                    let origin = beam.axis.at(base) + aside * base;
                    let ray = Ray { origin, direction };
                    let (span, off) = afar.along(&ray, |known| {
                        let [left, right] = [from, to].map(known.node);
                        (Span::hermite(left, right, to - from), known.off)
                    });
                    for i in 0..=8 {
                        let x = f64::from(i) / 8.0;
                        let place = ray.at(from + x * (to - from)).to_array();
                        let primitives = slabs.terms.primitives;
                        let all: f64 = primitives.iter().map(|p| p.value(place)).sum();
                        let near: f64 = list
                            .iter()
                            .map(|&p| primitives[p as usize].value(place))
                            .sum();
                        // Rounding is bounded where the field is about T.
                        if (all - THRESHOLD).abs() < 1.0 {
                            let apart = (near + span.value_and_slope(x).0 - all).abs();
                            let most = off + 1e-8;
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
        // The bound is not much larger than the error.
        assert!(
            4 * shared > seen && noisy > 20 && largest > 0.2,
            "{seen} {shared} {noisy} {largest}"
        );
    }
}
