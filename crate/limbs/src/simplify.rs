//! Fewer limbs for the same lines.

use crate::error::Remark;
use crate::graph::{Cap, Graph, Limb};
use crate::merge::compare;
use std::collections::HashSet;

/// Line of limbs between two nodes at which something changes, or once around.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Nodes along the line; the last is the first of a line that runs once around.
    pub nodes: Vec<u32>,
    /// Limbs between them, and whether each is walked from its first end to its second.
    pub limbs: Vec<(u32, bool)>,
}

impl Graph {
    /// Takes out nodes along lines, such that centrelines move by at most a distance, and radii by
    /// at most as much at the nearest place.
    ///
    /// Nodes remain where limbs branch, end, change their group or jump in radius, where balls are,
    /// and so many of each cycle that it stays one.
    pub fn simplify(&mut self, within: f64) {
        let before = self.limbs.len();
        let chains = self.chains();
        // Two lines between the same nodes must not become one limb.
        let mut taken: HashSet<[u32; 2]> = chains
            .iter()
            .filter(|chain| chain.limbs.len() == 1)
            .map(|chain| sort([chain.nodes[0], chain.nodes[1]]))
            .collect();
        let mut limbs = Vec::new();
        for mut chain in chains {
            if self.runs_backwards(&chain) {
                chain.nodes.reverse();
                chain.limbs.reverse();
                chain
                    .limbs
                    .iter_mut()
                    .for_each(|(_, forward)| *forward ^= true);
            }
            let ends = [chain.nodes[0], chain.nodes[chain.nodes.len() - 1]];
            let count = chain.limbs.len();
            let mut kept = match ends[0] == ends[1] {
                // A cycle has three limbs at least.
                true => {
                    let stops = [0, count / 3, 2 * count / 3, count];
                    let parts = stops.windows(2).flat_map(|stops| {
                        let mut kept = self.keep(&chain, stops[0], stops[1], within);
                        kept.pop();
                        kept
                    });
                    parts.chain([count]).collect()
                }
                false => self.keep(&chain, 0, count, within),
            };
            if kept.len() == 2 && count > 1 && !taken.insert(sort(ends)) {
                kept.insert(1, count / 2);
            }
            limbs.extend(
                kept.windows(2)
                    .map(|pair| self.span(&chain, pair[0], pair[1])),
            );
        }
        self.limbs = limbs;
        self.drop_lonely_nodes();
        let after = self.limbs.len();
        if after < before {
            let text = format!("{before} limbs are {after} where lines may move by {within}");
            self.remarks.push(Remark { line: None, text });
        }
    }

    /// Splits the graph into lines. Each limb is in one of them.
    #[must_use]
    pub fn chains(&self) -> Vec<Chain> {
        let around = self.around();
        let is_passed: Vec<bool> = (0..)
            .zip(&around)
            .map(|(node, limbs)| self.is_passed(node, limbs))
            .collect();
        let mut seen = vec![false; self.limbs.len()];
        let mut chains = Vec::new();
        // Lines between nodes first, then those that run once around.
        for wants_end in [true, false] {
            let mut starts: Vec<u32> = (0..self.nodes.len() as u32)
                .filter(|node| is_passed[*node as usize] != wants_end)
                .collect();
            if !wants_end {
                starts.sort_by(|a, b| {
                    let [a, b] = [a, b].map(|node| self.nodes[*node as usize].position);
                    compare(a, b)
                });
            }
            for start in starts {
                for first in &around[start as usize] {
                    if seen[*first as usize] {
                        continue;
                    }
                    let mut chain = Chain {
                        nodes: vec![start],
                        limbs: Vec::new(),
                    };
                    let mut next = Some(*first);
                    let mut at = start;
                    while let Some(limb) = next.filter(|limb| !seen[*limb as usize]) {
                        seen[limb as usize] = true;
                        let [a, b] = self.limbs[limb as usize].ends;
                        chain.limbs.push((limb, a == at));
                        at = if a == at { b } else { a };
                        chain.nodes.push(at);
                        let goes_on = is_passed[at as usize] && at != start;
                        let others = around[at as usize].iter().copied();
                        next = others.filter(|_| goes_on).find(|other| *other != limb);
                    }
                    chains.push(chain);
                }
            }
        }
        chains
    }

    /// Whether a line passes a node, at which nothing but its direction changes.
    fn is_passed(&self, node: u32, limbs: &[u32]) -> bool {
        let &[a, b] = limbs else { return false };
        let [a, b] = [a, b].map(|limb| &self.limbs[limb as usize]);
        let [r, s] = [a, b].map(|limb| limb.radii[usize::from(limb.ends[1] == node)]);
        !self.nodes[node as usize].is_ball && a.group == b.group && a.clip == b.clip && r == s
    }

    /// Whether the other direction of a line is the one that does not depend on numbering.
    fn runs_backwards(&self, chain: &Chain) -> bool {
        let places = chain
            .nodes
            .iter()
            .map(|node| self.nodes[*node as usize].position);
        let order = places.clone().zip(places.rev()).map(|(a, b)| compare(a, b));
        let mut order = order.filter(|order| order.is_ne());
        order.next().is_some_and(std::cmp::Ordering::is_gt)
    }

    /// Returns the nodes of a piece of a line that remain, by their indices in it: each goes as far
    /// as it can.
    fn keep(&self, chain: &Chain, start: usize, end: usize, within: f64) -> Vec<usize> {
        let mut kept = vec![start];
        let mut at = start;
        while at < end {
            // The farthest known to do, and the nearest known not to.
            let (mut far, mut beyond) = (at + 1, end + 1);
            let mut step = 2;
            while far < end {
                let next = (at + step).min(end);
                if !self.is_near(chain, at, next, within) {
                    beyond = next;
                    break;
                }
                far = next;
                step *= 2;
            }
            while beyond - far > 1 && beyond <= end {
                let middle = far + (beyond - far) / 2;
                match self.is_near(chain, at, middle, within) {
                    true => far = middle,
                    false => beyond = middle,
                }
            }
            kept.push(far);
            at = far;
        }
        kept
    }

    /// Whether a piece of a line is nowhere farther than a distance from one limb between its ends,
    /// in place and in radius.
    fn is_near(&self, chain: &Chain, start: usize, end: usize, within: f64) -> bool {
        let limb = self.span(chain, start, end);
        let [a, b] = limb.ends.map(|node| self.nodes[node as usize].position);
        let (axis, [from, to]) = (b - a, limb.radii);
        (start..end).all(|i| {
            let piece = self.span(chain, i, i + 1);
            let [p, q] = piece.ends.map(|node| self.nodes[node as usize].position);
            let [s, t] = [p, q].map(|end| (end - a).dot(axis) / axis.length_squared());
            // The distance is largest at an end; the difference of radii also where the nearest
            // place becomes an end of the limb.
            let kinks = [0.0, 1.0].map(|end| ((end - s) / (t - s)).clamp(0.0, 1.0));
            [0.0, 1.0]
                .into_iter()
                .chain(kinks)
                .filter(|u| !u.is_nan())
                .all(|u| {
                    let nearest = (s + (t - s) * u).clamp(0.0, 1.0);
                    let radius = piece.radii[0] + (piece.radii[1] - piece.radii[0]) * u;
                    let place = p + (q - p) * u;
                    place.distance(a + axis * nearest) <= within
                        && (radius - (from + (to - from) * nearest)).abs() <= within
                })
        })
    }

    /// Returns the radius and the cap of a limb at its first end along a line, or at its last.
    fn side(&self, (limb, is_forward): (u32, bool), is_last: bool) -> (f64, Cap) {
        let limb = &self.limbs[limb as usize];
        let side = usize::from(is_last == is_forward);
        (limb.radii[side], limb.caps[side])
    }

    /// Returns the limb between two nodes of a line.
    fn span(&self, chain: &Chain, start: usize, end: usize) -> Limb {
        let first = self.side(chain.limbs[start], false);
        let last = self.side(chain.limbs[end - 1], true);
        Limb {
            ends: [chain.nodes[start], chain.nodes[end]],
            radii: [first.0, last.0],
            caps: [first.1, last.1],
            ..self.limbs[chain.limbs[start].0 as usize]
        }
    }
}

/// Sorts two numbers.
fn sort([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
