//! SWC: a tree of nodes.

use super::Written;
use crate::graph::Graph;
use crate::read::TYPES;
use std::fmt::Write as _;

impl Graph {
    /// Writes an SWC file, in the graph's own unit. Groups whose names are none of the format's
    /// types are 7 and above, as a comment tells.
    #[must_use]
    pub fn write_swc(&self) -> Written {
        let mut written = Written {
            text: String::from("# id type x y z radius parent\n"),
            remarks: Vec::new(),
        };
        let out = &mut written.text;
        let mut others = 7..;
        let types: Vec<usize> = self
            .groups
            .iter()
            .map(|group| {
                let known = TYPES.iter().position(|name| *name == group.name);
                known.unwrap_or_else(|| {
                    let own = others.next().unwrap_or(7);
                    // Writing to a string does not fail.
                    let _ = writeln!(out, "# type {own}: {}", group.name);
                    own
                })
            })
            .collect();
        let around = self.around();
        let mut ids = vec![0; self.nodes.len()];
        let mut id = 0;
        let (mut cuts, mut jumps) = (0, 0);
        // Somas are roots, then free ends, then what is left: cycles.
        let mut roots: Vec<u32> = (0..self.nodes.len() as u32).collect();
        roots.sort_by_key(|node| {
            let node = *node as usize;
            (!self.nodes[node].is_ball, around[node].len() != 1)
        });
        let mut is_used = vec![false; self.limbs.len()];
        for root in roots {
            // A node to be written, the limb that leads to it, and the id and radius it comes from.
            let mut to_do: Vec<(u32, Option<u32>, i64, f64)> = vec![(root, None, -1, 0.0)];
            if ids[root as usize] != 0 {
                continue;
            }
            while let Some((node, limb, parent, thickness)) = to_do.pop() {
                if let Some(limb) = limb
                    && std::mem::replace(&mut is_used[limb as usize], true)
                {
                    continue;
                }
                let own = &self.nodes[node as usize];
                let mut kind = types[own.group as usize];
                let mut radius = own.radius;
                if let Some(limb) = limb.map(|limb| &self.limbs[limb as usize]) {
                    let side = usize::from(limb.ends[1] == node);
                    kind = types[limb.group as usize];
                    radius = limb.radii[side];
                    let before = &self.nodes[limb.ends[1 - side] as usize];
                    let is_jump = thickness != limb.radii[1 - side];
                    jumps += usize::from(is_jump && !before.is_ball);
                }
                if own.is_ball {
                    (kind, radius) = (1, own.radius);
                }
                id += 1;
                let [x, y, z] = own.position.to_array();
                let _ = writeln!(out, "{id} {kind} {x} {y} {z} {radius} {parent}");
                if std::mem::replace(&mut ids[node as usize], id) != 0 {
                    cuts += 1;
                    continue;
                }
                for next in around[node as usize].iter().rev() {
                    let [a, b] = self.limbs[*next as usize].ends;
                    to_do.push((if a == node { b } else { a }, Some(*next), id, radius));
                }
            }
        }
        written.remark_count(
            cuts,
            "cycles are cut, each at a node that is written twice: SWC has trees",
        );
        written.remark_count(
            jumps,
            "limbs begin with another radius than their node: SWC has one at a node",
        );
        written
    }
}
