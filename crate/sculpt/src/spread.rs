//! The spreading of motions over neighbours.

use crate::decay::Decay;
use core::cmp::Ordering;
use mesh::{HalfEdgeMesh, VertexId};
use std::collections::BinaryHeap;

/// Vertex that is moved, and how strongly.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    pub vertex: u32,
    pub strength: f64,
}

/// Vertex that takes a share of a source's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    pub vertex: u32,
    /// Index of the source.
    pub source: u32,
    /// The decay function's value, 0 … 1.
    pub weight: f64,
}

/// Values of each vertex for one spreading at a time; marks tell which entries belong to the
/// present one.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    mark: u32,
    marks: Vec<u32>,
    /// The largest value offered, and its distance.
    best: Vec<(f64, f64)>,
    settled: Vec<bool>,
}

impl Scratch {
    fn begin(&mut self, slots: usize) {
        if self.marks.len() != slots || self.mark == u32::MAX {
            self.marks = vec![0; slots];
            self.best = vec![(0.0, 0.0); slots];
            self.settled = vec![false; slots];
            self.mark = 0;
        }
        self.mark += 1;
    }

    /// Takes a value for a vertex; `false` if a better one is known or it is settled.
    fn offer(&mut self, v: u32, value: f64, distance: f64) -> bool {
        let i = v as usize;
        if self.marks[i] != self.mark {
            self.marks[i] = self.mark;
            self.settled[i] = false;
            self.best[i] = (f64::NEG_INFINITY, 0.0);
        }
        let (best, nearest) = self.best[i];
        let is_better = value > best || (value == best && distance < nearest);
        if self.settled[i] || !is_better {
            return false;
        }
        self.best[i] = (value, distance);
        true
    }
}

/// Motion handed on to a vertex.
struct Handed {
    /// Strength times weight.
    value: f64,
    distance: f64,
    vertex: u32,
    source: u32,
}

impl Ord for Handed {
    /// The strongest is the greatest, then the nearest, then the lowest number.
    fn cmp(&self, other: &Self) -> Ordering {
        self.value
            .total_cmp(&other.value)
            .then(other.distance.total_cmp(&self.distance))
            .then(other.vertex.cmp(&self.vertex))
            .then(other.source.cmp(&self.source))
    }
}

impl PartialOrd for Handed {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Handed {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Handed {}

/// Hands the motions of sources on from neighbour to neighbour: each vertex within the range of a
/// source, measured along edges, takes the strongest motion that reaches it, strength ×
/// decay(distance / range). Without a range the sources keep theirs.
///
/// Returns each vertex once, the strongest motions first.
pub fn spread(
    mesh: &HalfEdgeMesh,
    scratch: &mut Scratch,
    sources: &[Source],
    decay: Decay,
    range: f64,
) -> Vec<Reached> {
    let mut queue: BinaryHeap<Handed> = BinaryHeap::with_capacity(2 * sources.len());
    if range <= 0.0 {
        return (0..)
            .zip(sources)
            .map(|(source, s)| Reached {
                vertex: s.vertex,
                source,
                weight: 1.0,
            })
            .collect();
    }
    scratch.begin(mesh.vertex_slots());
    for (source, s) in (0..).zip(sources) {
        if scratch.offer(s.vertex, s.strength, 0.0) {
            queue.push(Handed {
                value: s.strength,
                distance: 0.0,
                vertex: s.vertex,
                source,
            });
        }
    }
    let mut reached = Vec::with_capacity(sources.len());
    while let Some(handed) = queue.pop() {
        let settled = &mut scratch.settled[handed.vertex as usize];
        if core::mem::replace(settled, true) {
            continue;
        }
        reached.push(Reached {
            vertex: handed.vertex,
            source: handed.source,
            weight: decay.at(handed.distance / range),
        });
        let here = VertexId(handed.vertex);
        let strength = sources[handed.source as usize].strength;
        for there in mesh.neighbors(here) {
            let length = mesh.position(here).distance(mesh.position(there));
            let distance = handed.distance + length;
            let value = strength * decay.at(distance / range);
            if value > 0.0 && scratch.offer(there.0, value, distance) {
                queue.push(Handed {
                    value,
                    distance,
                    vertex: there.0,
                    source: handed.source,
                });
            }
        }
    }
    reached
}
