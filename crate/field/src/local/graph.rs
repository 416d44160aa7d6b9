//! Distances along a skeleton.
use std::collections::{BTreeMap, BinaryHeap};

/// A graph of nodes joined by edges with lengths.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Neighbours of each node.
    edges: Vec<Vec<(u32, f64)>>,
}

impl Graph {
    /// Makes a graph of some nodes, without edges.
    #[must_use]
    pub fn new(nodes: usize) -> Self {
        Self {
            edges: vec![Vec::new(); nodes],
        }
    }

    /// Adds a node and returns its number.
    pub fn add(&mut self) -> u32 {
        self.edges.push(Vec::new());
        self.edges.len() as u32 - 1
    }

    /// Joins two nodes.
    pub fn join(&mut self, [a, b]: [u32; 2], length: f64) {
        self.edges[a as usize].push((b, length));
        self.edges[b as usize].push((a, length));
    }

    /// Returns the distances along the graph, up to a reach, of nodes from the nearest of some with
    /// distances of their own (Dijkstra's algorithm), at most `most` of them.
    #[must_use]
    pub fn within(&self, from: &[(u32, f64)], reach: f64, most: usize) -> BTreeMap<u32, f64> {
        let mut found = BTreeMap::new();
        let near = from.iter().filter(|(_, distance)| *distance <= reach);
        let mut waiting: BinaryHeap<Waiting> = near
            .map(|&(node, distance)| Waiting { distance, node })
            .collect();
        while let Some(Waiting { distance, node }) = waiting.pop() {
            if found.len() >= most {
                break;
            }
            if found.contains_key(&node) {
                continue;
            }
            found.insert(node, distance);
            for &(next, length) in &self.edges[node as usize] {
                let distance = distance + length;
                if distance <= reach && !found.contains_key(&next) {
                    waiting.push(Waiting {
                        distance,
                        node: next,
                    });
                }
            }
        }
        found
    }
}

/// A node that waits to be visited; the nearest one is the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Waiting {
    distance: f64,
    node: u32,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        let nearest = other.distance.total_cmp(&self.distance);
        nearest.then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
