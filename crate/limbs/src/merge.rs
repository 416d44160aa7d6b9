//! Lines that run side by side become one.

use crate::error::{Error, Remark, fail};
use crate::graph::{Graph, Limb};
use crate::limits::MAX_LISTED;
use glam::DVec3;
use mesh::{Aabb, Bvh};

/// Comparisons of nodes with limbs: enough for a hundred neighbours of each.
const MOST_COMPARISONS: usize = 20_000_000;

impl Graph {
    /// Joins lines that run within a distance of each other, as the trunk of a vessel tree does
    /// that is listed once for each outlet.
    ///
    /// Nodes within the distance of one become that one, and a limb that passes a node within the
    /// distance is led through it. So nothing moves farther than twice the distance. The result
    /// does not depend on the order of nodes and limbs, but for numbering.
    ///
    /// # Errors
    /// If so many limbs are near each other that this would take too long; the graph is empty then.
    pub fn merge(&mut self, within: f64) -> Result<(), Error> {
        let before = self.limbs.len();
        let places = self.nearest_leaders(within);
        self.join(&places);
        self.limbs.retain(|limb| limb.ends[0] != limb.ends[1]);
        self.drop_lonely_nodes();
        self.lead_through(within)?;
        self.drop_doubles();
        self.drop_lonely_nodes();
        let after = self.limbs.len();
        let text = format!("{before} limbs are {after} where lines within {within} are joined");
        self.remarks.push(Remark { line: None, text });
        Ok(())
    }

    /// Returns for each node one within a distance that stands for it, such that no two of these
    /// are within the distance of each other: in the order of their coordinates, each is one that
    /// no other stands for yet.
    fn nearest_leaders(&self, within: f64) -> Vec<u32> {
        let boxes: Vec<Aabb> = self
            .nodes
            .iter()
            .map(|node| Aabb::of_points([node.position]))
            .collect();
        let bvh = Bvh::new(&boxes);
        let mut order: Vec<u32> = (0..self.nodes.len() as u32).collect();
        order.sort_by(|a, b| compare(self.position(*a), self.position(*b)));
        let mut places: Vec<Option<u32>> = vec![None; self.nodes.len()];
        for leader in order {
            if places[leader as usize].is_some() {
                continue;
            }
            let reach = DVec3::splat(within);
            let around =
                Aabb::of_points([self.position(leader) - reach, self.position(leader) + reach]);
            for other in bvh.overlapping(&around) {
                let place = &mut places[other as usize];
                if place.is_none() && self.position(other).distance(self.position(leader)) <= within
                {
                    *place = Some(leader);
                }
            }
            places[leader as usize] = Some(leader);
        }
        // The first of those that belong together carries them, at the leader's position.
        places
            .into_iter()
            .zip(0..)
            .map(|(place, i)| place.unwrap_or(i))
            .collect()
    }

    /// Returns a node's place.
    fn position(&self, node: u32) -> DVec3 {
        self.nodes[node as usize].position
    }

    /// Leads limbs through the nodes that they pass within a distance.
    fn lead_through(&mut self, within: f64) -> Result<(), Error> {
        let reach = DVec3::splat(within);
        let boxes: Vec<Aabb> = self
            .limbs
            .iter()
            .map(|limb| {
                let [a, b] = limb.ends.map(|end| self.nodes[end as usize].position);
                let bounds = Aabb::of_points([a, b]);
                Aabb::of_points([bounds.min - reach, bounds.max + reach])
            })
            .collect();
        let bvh = Bvh::new(&boxes);
        let mut passes: Vec<(u32, f64, u32)> = Vec::new();
        let mut comparisons = 0;
        for (node, i) in self.nodes.iter().zip(0..) {
            for index in bvh.overlapping(&Aabb::of_points([node.position])) {
                comparisons += 1;
                let limb = self.limbs[index as usize];
                if limb.ends.contains(&i) {
                    continue;
                }
                let [a, b] = limb.ends.map(|end| self.nodes[end as usize].position);
                let share = (node.position - a).dot(b - a) / (b - a).length_squared();
                let foot = a + (b - a) * share;
                if share > 0.0 && share < 1.0 && foot.distance(node.position) <= within {
                    passes.push((index, share, i));
                }
            }
            if comparisons > MOST_COMPARISONS || passes.len() > MAX_LISTED {
                *self = Self::default();
                return fail(format!(
                    "too many limbs are within {within} of each other to be joined: join lines \
                     within less"
                ));
            }
        }
        passes.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut limbs: Vec<Limb> = Vec::with_capacity(self.limbs.len() + passes.len());
        let mut passes = passes.into_iter().peekable();
        for (limb, index) in self.limbs.iter().zip(0..) {
            let [start, end] = limb.radii;
            let (mut from, mut radius) = (limb.ends[0], start);
            while let Some((_, share, node)) = passes.next_if(|pass| pass.0 == index) {
                let thickness = start + (end - start) * share;
                limbs.push(Limb {
                    ends: [from, node],
                    radii: [radius, thickness],
                    ..*limb
                });
                (from, radius) = (node, thickness);
            }
            limbs.push(Limb {
                ends: [from, limb.ends[1]],
                radii: [radius, end],
                ..*limb
            });
        }
        self.limbs = limbs;
        Ok(())
    }
}

/// Orders places by their coordinates.
pub(crate) fn compare(a: DVec3, b: DVec3) -> std::cmp::Ordering {
    let axes = a.to_array().into_iter().zip(b.to_array());
    axes.map(|(a, b)| a.total_cmp(&b))
        .find(|order| order.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}
