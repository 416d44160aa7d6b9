//! Where along a beam which primitives need how many spans.
//!
//! The part of the beam that the soft surface can reach is halved again and again. In each slab a
//! primitive is *resolved* when one Hermite span over the slab is certified to be near enough to
//! it, for all rays of the beam; what is not yet resolved is *pending* and is handed to the halves.
//! A primitive beyond its depth of influence from the slab is dropped there. So broad or distant
//! primitives get few long spans and sharp near ones many short spans. The tree grows only where a
//! ray asks for it, and is shared by all rays of the beam.
//!
//! Where a slab has become shorter than its beam is wide, halving it further would not bring the
//! rays' surroundings closer together: the beam is then divided into narrower ones instead, and each
//! packet of rays goes on in its own. In beams wider than a block of eight packets nothing is resolved, as
//! spans would be made for rays that do not meet their primitives: they only show what is empty.
use crate::beams::Beams;
use core::ops::Range;
use field::THRESHOLD;
use field::bound::{Bound, Estimate, SpanLength};

/// How exactly spans follow the field.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// The sum of spans is within this of the field at first …
    pub first: f64,
    /// … and within this before a slab in which the surface may lie is decided upon.
    pub last: f64,
    /// Whether primitives are dropped beyond their depth of influence.
    pub truncate: bool,
    /// Rounding of coordinates, and of values relative to a primitive's field.
    pub rounding: f64,
    /// Stretches of rays shorter than this need not be looked into, in units of the scene.
    pub resolution: f64,
}

impl Precision {
    /// For pictures: near the surface the field changes by about T over a radius, so the surface
    /// of the spans is within about 1/2000 of a radius of the true one.
    pub const PICTURE: Self = Self {
        first: 8e-3,
        last: 5e-4,
        truncate: true,
        rounding: 2.5e-7,
        resolution: 5e-7,
    };
    /// For exact answers.
    pub const EXACT: Self = Self {
        first: 8e-3,
        last: 1e-9,
        truncate: false,
        rounding: 0.0,
        resolution: 1e-12,
    };
}

/// The primitives that a beam can meet, and its slabs so far.
pub struct Slabs<'a> {
    bounds: &'a [Bound],
    beams: Beams<'a>,
    precision: Precision,
    /// Primitive of each local number.
    list: Vec<u32>,
    nodes: Vec<Slab>,
    /// Local numbers; the slabs' lists are ranges of it.
    ids: Vec<u32>,
    scratch: Vec<(u32, f64, f64)>,
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
    /// Local numbers of the primitives that get one span over this slab.
    pub resolved: Range<u32>,
    /// Those handed to the halves.
    pub pending: Range<u32>,
    /// All terms of this slab (resolved and pending) together are at most this …
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
    /// What of it is rounding, which takes nothing from the budget.
    noise: f64,
    /// What the errors may add up to.
    budget: f64,
    parent: u32,
    beam: usize,
    /// Its halves, or the same slab of both halves of the beam. 0: not yet made.
    children: [u32; 2],
    /// The same slab again with finer spans. 0: not yet made.
    finer: u32,
    /// How many times halved.
    pub depth: u32,
}

const NONE: u32 = u32::MAX;

/// A slab is given to narrower beams when its beam is wider than this times its length.
const NARROW: f64 = 0.5;
/// The same of beams wider than a block.
const WIDE: f64 = 0.4;
/// Beams that are divided this many times further, into eight packets, are blocks.
const BLOCK: u32 = 3;

/// Where the field is T no term is much larger than that, unless others carve it away: what is known of rounding
/// counts terms as no larger than this.
pub const LARGE_TERM: f64 = 4.0 * THRESHOLD;

/// Slabs and list entries above which a tree is thrown away between two packets.
const LARGE: (usize, usize) = (1 << 16, 1 << 21);

/// Slabs that [`Slabs::is_empty_for`] looks at.
const MOST_LOOKS: u32 = 64;

impl<'a> Slabs<'a> {
    /// The slabs of beams between two parameters. `list` holds the primitives they can meet.
    #[must_use]
    pub fn new(
        bounds: &'a [Bound],
        list: Vec<u32>,
        beams: Beams<'a>,
        [from, to]: [f64; 2],
        precision: Precision,
    ) -> Self {
        let mut slabs = Self {
            bounds,
            beams,
            precision,
            ids: (0..list.len() as u32).collect(),
            list,
            nodes: Vec::new(),
            scratch: Vec::new(),
        };
        let all = 0..slabs.list.len() as u32;
        slabs.add(all, from, to, 0, NONE, precision.first, [0.0; 2], 0);
        slabs
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

    /// How many local numbers there are.
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
            root.children = [0; 2];
            root.finer = 0;
            self.ids.truncate(root.pending.end as usize);
        }
    }

    /// Whether it is known, after a short look and without following rays, that no ray of a packet meets
    /// anything.
    pub fn is_empty_for(&mut self, packet: usize) -> bool {
        self.tidy();
        self.is_empty_from(self.root(), packet, &mut 0)
    }

    fn is_empty_from(&mut self, index: u32, packet: usize, looks: &mut u32) -> bool {
        let slab = self.slab(index);
        if slab.above + slab.error < THRESHOLD {
            return true;
        }
        *looks += 1 + (slab.pending.len() / 64) as u32;
        // Where there are spans, only rays can tell.
        if !slab.resolved.is_empty() || slab.pending.is_empty() || *looks > MOST_LOOKS {
            return false;
        }
        match self.parts(index, packet) {
            Parts::Narrower(same) => self.is_empty_from(same, packet, looks),
            Parts::Halves(left, right) => {
                self.is_empty_from(left, packet, looks) && self.is_empty_from(right, packet, looks)
            }
        }
    }

    /// How a slab goes on for a packet.
    pub fn parts(&mut self, index: u32, packet: usize) -> Parts {
        let s = &self.nodes[index as usize];
        let (from, to) = (s.from, s.to);
        if let Some(beam) = self.beams.half(s.beam, packet)
            && self.beams.get(s.beam).width(to) > self.narrow(s.beam) * (to - from)
        {
            let side = (beam - 1) % 2;
            if s.children[side] == 0 {
                let child = self.inner(index, from, to, beam, s.depth);
                self.nodes[index as usize].children[side] = child;
            }
            return Parts::Narrower(self.nodes[index as usize].children[side]);
        }
        if s.children == [0; 2] {
            let (beam, depth) = (s.beam, s.depth + 1);
            let middle = 0.5 * (from + to);
            let left = self.inner(index, from, middle, beam, depth);
            let right = self.inner(index, middle, to, beam, depth);
            self.nodes[index as usize].children = [left, right];
        }
        let [left, right] = self.nodes[index as usize].children;
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
        let (pending, budget) = (s.pending.clone(), s.budget);
        let error = [s.error - s.noise, s.noise];
        let index = self.nodes.len() as u32;
        self.add(pending, from, to, beam, parent, budget, error, depth);
        index
    }

    /// Whether a slab's spans are as fine as they get.
    #[must_use]
    pub fn is_final(&self, index: u32) -> bool {
        let slab = self.slab(index);
        slab.error - slab.noise <= self.precision.last || slab.budget <= self.precision.last
    }

    /// Stretches of rays shorter than this need not be looked into.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.precision.resolution
    }

    /// The same slab from anew, with all its primitives and a smaller error.
    pub fn finer(&mut self, index: u32) -> u32 {
        if self.nodes[index as usize].finer == 0 {
            let start = self.ids.len() as u32;
            let mut at = index;
            // What the path to this slab resolved, and what the slab leaves pending.
            let pending = self.nodes[index as usize].pending.clone();
            self.ids
                .extend_from_within(pending.start as usize..pending.end as usize);
            while at != NONE {
                let s = &self.nodes[at as usize];
                let r = s.resolved.clone();
                at = s.parent;
                self.ids
                    .extend_from_within(r.start as usize..r.end as usize);
            }
            let all = start..self.ids.len() as u32;
            let s = &self.nodes[index as usize];
            let (from, to, beam, depth) = (s.from, s.to, s.beam, s.depth + 1);
            let budget = ((s.error - s.noise).min(s.budget) / 16.0).max(self.precision.last);
            let finer = self.nodes.len() as u32;
            self.add(all, from, to, beam, NONE, budget, [0.0; 2], depth);
            self.nodes[index as usize].finer = finer;
        }
        self.nodes[index as usize].finer
    }

    /// Calls `f` with the local number of each primitive that counts in a slab.
    pub fn each(&self, index: u32, mut f: impl FnMut(u32)) {
        let s = self.slab(index);
        self.locals(&s.pending).iter().for_each(|&i| f(i));
        let mut at = index;
        while at != NONE {
            let s = self.slab(at);
            self.locals(&s.resolved).iter().for_each(|&i| f(i));
            at = s.parent;
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn add(
        &mut self,
        candidates: Range<u32>,
        from: f64,
        to: f64,
        beam: usize,
        parent: u32,
        budget: f64,
        [error, mut noise]: [f64; 2],
        depth: u32,
    ) {
        let (center, radius) = self.beams.get(beam).ball(from, to);
        let h = to - from;
        let length = SpanLength::new(h);
        let (mut above, mut below, mut total) = (0.0, 0.0, 0.0);
        let rounding = self.precision.rounding;
        // Coordinates are rounded in the world and in the primitive's own frame.
        let misplaced = rounding * (center.abs().max_element() + radius + to).max(1.0);
        self.scratch.clear();
        for &local in &self.ids[candidates.start as usize..candidates.end as usize] {
            let bound = &self.bounds[self.list[local as usize] as usize];
            let near = bound.nearness(center, radius);
            if self.precision.truncate && near.distance >= bound.influence {
                continue;
            }
            let Estimate {
                magnitude,
                error: span_error,
            } = bound.estimate(near, &length);
            if bound.adds() {
                above += magnitude;
            }
            if bound.carves() {
                below += magnitude;
            }
            total += magnitude;
            // A span is between the values' and slopes' extremes, so it is never further off than
            // its bound says; a NaN counts as far off.
            self.scratch.push((local, magnitude, span_error));
        }
        // What is left of the budget is shared out half evenly, half by size. The shares add up
        // to no more than the whole.
        // In a wide beam a span would be evaluated for many rays that do not meet its primitive.
        let wide = self.beams.levels_below(beam) > BLOCK;
        let left = if wide {
            f64::NEG_INFINITY
        } else {
            (budget - error).max(0.0)
        };
        let even = 0.5 * left / self.scratch.len().max(1) as f64;
        let by_size = 0.5 * left / total.max(f64::MIN_POSITIVE);
        let start = self.ids.len() as u32;
        let mut sum = error;
        for &(local, magnitude, span_error) in &self.scratch {
            if span_error <= even + by_size * magnitude {
                self.ids.push(local);
                sum += span_error;
                let steep = self.bounds[self.list[local as usize] as usize].relative_slope();
                noise += magnitude.min(LARGE_TERM) * (4.0 * rounding + misplaced * steep);
            }
        }
        let middle = self.ids.len() as u32;
        let (mut pending_above, mut pending_below) = (0.0, 0.0);
        for &(local, magnitude, span_error) in &self.scratch {
            if span_error <= even + by_size * magnitude {
                continue;
            }
            self.ids.push(local);
            let bound = &self.bounds[self.list[local as usize] as usize];
            if bound.adds() {
                pending_above += magnitude;
            }
            if bound.carves() {
                pending_below += magnitude;
            }
        }
        let end = self.ids.len() as u32;
        self.nodes.push(Slab {
            from,
            to,
            resolved: start..middle,
            pending: middle..end,
            above,
            below,
            pending_above,
            pending_below,
            error: sum + noise,
            noise,
            budget,
            parent,
            beam,
            children: [0; 2],
            finer: 0,
            depth,
        });
    }
}
