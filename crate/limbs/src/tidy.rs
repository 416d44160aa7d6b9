//! Changes of a graph that leave no limb twice and none without length.

use crate::graph::{Graph, Limb, Node, Sets};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

impl Graph {
    /// Joins each node to one that stands for itself and is as thick then as the thickest of them.
    pub(crate) fn join(&mut self, places: &[u32]) {
        let moves = places.iter().enumerate();
        for (i, place) in moves.filter(|(i, place)| *i != **place as usize) {
            let Node {
                radius, is_ball, ..
            } = self.nodes[i];
            let kept = &mut self.nodes[*place as usize];
            kept.radius = kept.radius.max(radius);
            kept.is_ball |= is_ball;
            self.nodes[i].is_ball = false;
        }
        for limb in &mut self.limbs {
            limb.ends = limb.ends.map(|end| places[end as usize]);
        }
    }

    /// Draws limbs without length together, and returns their number.
    pub(crate) fn contract(&mut self) -> usize {
        let nodes = &self.nodes;
        let mut sets = Sets::new(nodes.len());
        let mut count = 0;
        for Limb { ends: [a, b], .. } in &self.limbs {
            if nodes[*a as usize].position == nodes[*b as usize].position {
                sets.join(*a, *b);
                count += 1;
            }
        }
        if count > 0 {
            let places: Vec<u32> = (0..nodes.len() as u32).map(|i| sets.find(i)).collect();
            self.join(&places);
            self.limbs.retain(|limb| limb.ends[0] != limb.ends[1]);
        }
        count
    }

    /// Takes out limbs between two nodes that a thicker one joins, or one as thick that comes
    /// before, and returns their number.
    pub(crate) fn drop_doubles(&mut self) -> usize {
        let before = self.limbs.len();
        let mut seen: HashMap<[u32; 2], usize> = HashMap::with_capacity(before);
        let mut kept: Vec<Limb> = Vec::with_capacity(before);
        for limb in std::mem::take(&mut self.limbs) {
            let [a, b] = limb.ends;
            match seen.entry([a.min(b), a.max(b)]) {
                Entry::Vacant(place) => {
                    place.insert(kept.len());
                    kept.push(limb);
                }
                Entry::Occupied(place) => {
                    let other = &mut kept[*place.get()];
                    if limb.radii.iter().sum::<f64>() > other.radii.iter().sum() {
                        *other = limb;
                    }
                }
            }
        }
        self.limbs = kept;
        before - self.limbs.len()
    }
}
