//! The places whose planes may meet a ball, and bounds on their fields there.
use super::near::Nearby;
use super::planes::Places;
use super::{Link, Local, Place, Segment};
use crate::Ball;
use crate::ripple::times;
use glam::DVec3;

/// Bounds on a function in a ball: those of [`crate::Enclosure`], and how much its gradient jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least and the largest value.
    pub value: [f64; 2],
    /// The largest length of the gradient; infinite if the value may jump.
    pub slope: f64,
    /// The largest second derivative along any line, where there is one.
    pub curvature: f64,
    /// The gradients at two points differ by no more than the curvature times their distance and
    /// this.
    pub jump: f64,
}

/// The places in an interval of a segment whose planes may meet a ball, or an end or a branch.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// Number among the terms of [`Local`].
    pub term: u32,
    pub segment: u32,
    pub parts: [f64; 2],
    rate: f64,
    /// Number of the first one of those that go on in each other.
    pub chain: usize,
    /// Whether the value is continuous in the ball.
    solid: bool,
    /// Whether there is a place for every point of the ball.
    lasting: bool,
    /// Number of ends at which it goes on in another interval, where the gradient jumps.
    joints: u32,
    /// An upper bound on its field.
    pub most: f64,
    /// Whether that is the sum of bounds on pieces.
    summed: bool,
    pub known: Option<Known>,
}

/// Bounds of a candidate, found by evaluating its pieces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub bounds: Bounds,
    /// The gradient at the ball's centre, if a place's plane passes through it.
    pub gradient: Option<DVec3>,
}

/// Candidates of a ball.
pub(super) struct Survey<'a> {
    pub local: &'a Local,
    pub ball: Ball,
    pub all: Vec<Candidate>,
    pieces: Nearby<'a>,
}

/// An end of an interval that is at an end of its segment.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Touch {
    segment: u32,
    end: usize,
    candidate: usize,
}

impl<'a> Survey<'a> {
    /// The candidates among some terms.
    pub fn new(local: &'a Local, ball: Ball, terms: &[u32]) -> Self {
        let mut all: Vec<Candidate> = Vec::new();
        let mut touching: Vec<Touch> = Vec::new();
        for &term in terms {
            let node = (term as usize).checked_sub(local.segments.len());
            if let Some(&(number, end)) = node.and_then(|node| local.nodes.get(node)) {
                let group = &local.segments[number as usize].group;
                all.push(Candidate {
                    term,
                    segment: number,
                    parts: [end as f64; 2],
                    rate: f64::INFINITY,
                    chain: all.len(),
                    solid: true,
                    lasting: true,
                    joints: 0,
                    most: group.most(group.distance(&ball)),
                    summed: false,
                    known: None,
                });
                continue;
            }
            let segment = &local.segments[term as usize];
            segment.swept.each_in(ball, |Places { parts, rate }| {
                let candidate = all.len();
                for (end, touches) in [parts[0] <= 0.0, parts[1] >= 1.0].into_iter().enumerate() {
                    if touches {
                        touching.push(Touch {
                            segment: term,
                            end,
                            candidate,
                        });
                    }
                }
                all.push(Candidate {
                    term,
                    segment: term,
                    parts,
                    rate,
                    chain: candidate,
                    solid: rate != 0.0,
                    lasting: rate != 0.0,
                    joints: 0,
                    most: segment.group.most(segment.group.distance(&ball)),
                    summed: false,
                    known: None,
                });
            });
        }
        // In the order of the segments, so that those that a place goes on in are found fast.
        touching.sort_unstable();
        join(local, &mut all, &touching);
        Self {
            pieces: Nearby::new(&local.pieces, ball),
            local,
            ball,
            all,
        }
    }

    /// Returns an upper bound on a candidate's field.
    pub fn most(&mut self, number: usize) -> f64 {
        let candidate = &mut self.all[number];
        if !candidate.summed {
            let local = self.local;
            let segment = &local.segments[candidate.segment as usize];
            let [low, high] = candidate.parts;
            let along = 0.5 * (low + high) * segment.length;
            let span = 0.5 * (high - low) * segment.length;
            let [steep, _] = local.window.steepest();
            let mut sum = 0.0;
            for link in &local.links[segment.links.clone()] {
                let [nearest, _] = reach_of(segment, link, along);
                if nearest - span < local.window.reach {
                    let varies = steep * span;
                    let weight = if varies >= 1.0 {
                        1.0
                    } else {
                        (local.weight(segment, link, along).value + varies).min(1.0)
                    };
                    sum += weight * self.pieces.most(link.piece);
                }
            }
            // A bound that is no number is none.
            if sum < candidate.most {
                candidate.most = sum;
            }
            candidate.summed = true;
        }
        candidate.most
    }

    /// Looks closely at a candidate.
    pub fn look(&mut self, number: usize) {
        if self.all[number].known.is_none() {
            let most = self.most(number);
            let candidate = self.all[number].clone();
            let known = self.evaluate(&candidate, most);
            self.all[number].most = known.bounds.value[1];
            self.all[number].known = Some(known);
        }
    }

    /// Looks closely at all candidates that go on in each other.
    pub fn look_at_chain(&mut self, chain: usize) {
        for i in 0..self.all.len() {
            if self.all[i].chain == chain {
                self.look(i);
            }
        }
    }

    /// Computes bounds on W for the places of a candidate.
    fn evaluate(&mut self, candidate: &Candidate, most: f64) -> Known {
        let (local, ball) = (self.local, self.ball);
        let segment = &local.segments[candidate.segment as usize];
        let [low, high] = candidate.parts;
        let is_place = candidate.rate.is_infinite();
        let mut middle = 0.5 * (low + high);
        let mut centered = is_place;
        if !is_place {
            segment.swept.each(ball.center, |part| {
                if part >= low && part <= high {
                    middle = part;
                    centered = true;
                }
            });
        }
        let along = middle * segment.length;
        let span = (high - middle).max(middle - low) * segment.length;
        let [steep, bent] = local.window.steepest();
        let (mut value, mut slope, mut curvature) = (0.0, 0.0, 0.0);
        let (mut gradient, mut at_place) = (DVec3::ZERO, 0.0);
        // By the place, twice by the place, and by the place and the point.
        let (mut by_place, mut by_places, mut mixed) = (0.0, 0.0, 0.0);
        let links = &local.links[segment.links.clone()];
        for link in links {
            let [nearest, farthest] = reach_of(segment, link, along);
            if nearest - span >= local.window.reach {
                continue;
            }
            let weight = local.weight(segment, link, along);
            let near = self.pieces.close(link.piece);
            let largest = (weight.value + steep * span).min(1.0);
            slope += largest * near.slope;
            curvature += largest * near.curvature;
            value += weight.value * near.jet.value;
            gradient += weight.value * DVec3::from_array(near.jet.gradient);
            at_place += weight.slope * near.jet.value;
            if farthest + span > local.window.flat() {
                // More where both ways to a piece are equally long.
                let varies = bent + 2.0 * steep / link.length;
                let steepest = steep.min(weight.slope.abs() + varies * span);
                by_place += steepest * near.most;
                by_places += varies * near.most;
                mixed += steepest * near.slope;
            }
        }
        let change = times(slope, ball.radius) + times(by_place, span);
        let change = if change.is_nan() {
            f64::INFINITY
        } else {
            change
        };
        let mut lowest = value - change;
        if lowest < 0.5 * value {
            // Near a pole of the kernel a field is much larger than its slope tells.
            let least = links.iter().filter_map(|link| {
                let [nearest, _] = reach_of(segment, link, along);
                let weight = local.weight(segment, link, along).value - steep * span;
                let counts = nearest < local.window.reach && weight > 0.0;
                counts.then(|| weight * self.pieces.least(link.piece))
            });
            lowest = lowest.max(least.sum());
        }
        // ∇s and ∇²s; an end stays where it is.
        let [turn, bend] = segment.swept.bends();
        let first = 1.0 / candidate.rate.abs();
        let second = (bend.abs() * first + 2.0 * turn) * first * first;
        let [once, twice] = [first, second].map(|turned| times(turned, segment.length));
        if !is_place {
            let rate = segment.swept.rate(ball.center, middle);
            let turned = segment.swept.normal(middle) * times(at_place, -segment.length / rate);
            gradient += turned;
        }
        let unless = |not: bool, bound: f64| if not { f64::INFINITY } else { bound };
        let loose = !candidate.solid;
        let kinks = f64::from(candidate.joints);
        Known {
            bounds: Bounds {
                value: [lowest.max(0.0), (value + change).min(most)],
                slope: unless(loose, slope + times(by_place, once)),
                curvature: unless(
                    loose,
                    curvature
                        + 2.0 * times(mixed, once)
                        + times(by_places, once * once)
                        + times(by_place, twice),
                ),
                jump: unless(loose, times(kinks, times(by_place, once))),
            },
            gradient: (centered && gradient.is_finite()).then_some(gradient),
        }
    }

    /// The candidate whose place is nearest to the ball's centre.
    fn nearest(&self) -> Option<usize> {
        let distances = self.all.iter().map(|c| {
            let [low, high] = c.parts;
            let swept = &self.local.segments[c.segment as usize].swept;
            swept
                .at(0.5 * (low + high))
                .distance_squared(self.ball.center)
        });
        let nearest = distances.zip(0..).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, number)| number)
    }

    /// Returns a lower bound on the largest stretch, after a close look at some candidates that may
    /// be the largest.
    pub fn floor(&mut self) -> f64 {
        if let Some(nearest) = self.nearest() {
            self.look_at_chain(self.all[nearest].chain);
        }
        let floor = self.least(|_, _| true);
        let mut best: Option<(f64, usize)> = None;
        for i in 0..self.all.len() {
            if self.all[i].most >= floor {
                let most = self.most(i);
                if self.all[i].lasting && best.is_none_or(|best| most > best.0) {
                    best = Some((most, i));
                }
            }
        }
        match best {
            Some((_, i)) if self.all[i].known.is_none() => {
                self.look_at_chain(self.all[i].chain);
                self.least(|_, _| true)
            }
            _ => floor,
        }
    }

    /// Returns a lower bound on the largest of some candidates: of one that is there for every
    /// point of the ball, with all that it goes on in.
    pub fn least(&self, of: impl Fn(usize, &Candidate) -> bool) -> f64 {
        // For each chain the least value of its candidates.
        let mut lowest = vec![f64::INFINITY; self.all.len()];
        for (i, candidate) in self.all.iter().enumerate() {
            let low = match &candidate.known {
                Some(known) if candidate.lasting && of(i, candidate) => known.bounds.value[0],
                _ => 0.0,
            };
            let chain = &mut lowest[candidate.chain];
            *chain = chain.min(low);
        }
        let finite = lowest.into_iter().filter(|low| low.is_finite());
        finite.fold(0.0, f64::max)
    }

    /// The terms whose candidates may be above a level, with those that they go on in, in ascending
    /// order.
    pub fn terms_above(&mut self, level: f64) -> Vec<u32> {
        let mut matters = vec![false; self.all.len()];
        for i in 0..self.all.len() {
            if self.all[i].most >= level && self.most(i) >= level {
                matters[self.all[i].chain] = true;
            }
        }
        let kept = self.all.iter().filter(|c| matters[c.chain]);
        let mut terms: Vec<u32> = kept.map(|c| c.term).collect();
        terms.sort_unstable();
        terms.dedup();
        terms
    }

    /// The place in the middle of a candidate, and half the length of its interval.
    pub fn middle(&self, candidate: &Candidate) -> (Place, f64) {
        let Candidate { segment, parts, .. } = *candidate;
        let length = self.local.segments[segment as usize].length;
        let along = 0.5 * (parts[0] + parts[1]) * length;
        (
            Place { segment, along },
            0.5 * (parts[1] - parts[0]) * length,
        )
    }
}

/// The least and the largest distance of a piece's points from a place of a segment, within the two
/// ways to it.
pub(super) fn reach_of(segment: &Segment, link: &Link, along: f64) -> [f64; 2] {
    if link.own {
        let [[start, _], [end, _]] = link.distances;
        let far = (along - start).abs().max((along - end).abs());
        let near = (start - along).max(along - end).max(0.0);
        return [near, far];
    }
    let rest = segment.length - along;
    let [a, b] = link.distances.map(|[s, e]| (along + s).min(rest + e));
    let near = a.min(b);
    [near, near + link.length]
}

/// Returns the first candidate of the chain that a candidate is in.
fn first_of(all: &[Candidate], mut i: usize) -> usize {
    while all[i].chain != i {
        i = all[i].chain;
    }
    i
}

/// Joins candidates that go on in each other to chains: a place passes from one to the other as the
/// point moves, if their planes turn alike.
fn join(local: &Local, all: &mut [Candidate], touching: &[Touch]) {
    for &Touch {
        segment: number,
        end,
        candidate: at,
    } in touching
    {
        let segment = &local.segments[number as usize];
        let Some(next) = segment.next[end] else {
            // Where the place leaves its segment, the end is a candidate that is as large.
            all[at].lasting = false;
            continue;
        };
        let other = local.segments.get(next as usize);
        let there = other.map_or(0, |o| usize::from(o.ends[0] != segment.ends[end]));
        let from = touching.partition_point(|t| (t.segment, t.end) < (next, there));
        let beyond = touching.get(from);
        all[at].joints += 1;
        match beyond.filter(|t| (t.segment, t.end) == (next, there)) {
            Some(beyond) if all[at].rate * all[beyond.candidate].rate > 0.0 => {
                let [a, b] = [at, beyond.candidate].map(|i| first_of(all, i));
                all[a.max(b)].chain = a.min(b);
            }
            _ => all[at].solid = false,
        }
    }
    let (mut solid, mut lasting) = (vec![true; all.len()], vec![true; all.len()]);
    for i in 0..all.len() {
        let chain = first_of(all, i);
        all[i].chain = chain;
        solid[chain] &= all[i].solid;
        lasting[chain] &= all[i].lasting;
    }
    for candidate in all {
        candidate.solid = solid[candidate.chain];
        candidate.lasting = solid[candidate.chain] && lasting[candidate.chain];
    }
}
