//! The block form of the language of scenes.

use super::Written;
use crate::graph::{Graph, Limb, Node};
use std::collections::HashMap;
use std::fmt::Write as _;

impl Graph {
    /// Writes `skeleton` commands: one for each material, and a `sphere` for each ball.
    ///
    /// `materials` gives the materials of groups by their names; `otherwise` is the one of all
    /// others. The command of the material `otherwise` has the name `name`, others `name` with the
    /// material behind it.
    #[must_use]
    pub fn write_block(&self, otherwise: &str, name: &str, materials: &[(&str, &str)]) -> Written {
        let mut written = Written {
            text: String::new(),
            remarks: Vec::new(),
        };
        let out = &mut written.text;
        // The material of each group.
        let own: Vec<&str> = self
            .groups
            .iter()
            .map(|group| {
                let given = materials.iter().find(|(name, _)| *name == group.name);
                given.map_or(otherwise, |(_, material)| *material)
            })
            .collect();
        let mut names: Vec<&str> = vec![otherwise];
        for (_, material) in materials {
            if !names.contains(material) {
                names.push(material);
            }
        }
        for sn in names {
            let limbs = self
                .limbs
                .iter()
                .filter(|limb| own[limb.group as usize] == sn);
            let part = self.part(limbs);
            if !part.limbs.is_empty() {
                let behind = if sn == otherwise { "" } else { sn };
                let gap = if behind.is_empty() { "" } else { "_" };
                // Writing to a string does not fail.
                let _ = writeln!(out, "skeleton {sn}, {name}{gap}{behind} subdivide 0 {{");
                part.write_lines(out);
                out.push_str("}\n");
            }
            let balls = self.nodes.iter().filter(|node| node.is_ball);
            for ball in balls.filter(|ball| own[ball.group as usize] == sn) {
                let [x, y, z] = ball.position.to_array();
                let _ = writeln!(out, "sphere {sn} {} <{x} {y} {z}>", ball.radius);
            }
        }
        let flat = self.limbs.iter().flat_map(|limb| limb.caps);
        let flat = flat.filter(|cap| *cap == crate::Cap::Flat).count();
        written.remark_count(flat, "ends are flat in the file and become round");
        written
    }

    /// Returns a graph of some limbs in which each node has the radius of all its limbs: a node at
    /// which radii jump is there once for each.
    fn part<'a>(&self, limbs: impl Iterator<Item = &'a Limb>) -> Self {
        let mut part = Self::default();
        let mut places: HashMap<(u32, u64), u32> = HashMap::new();
        for limb in limbs {
            let ends = [0, 1].map(|side| {
                let (node, radius) = (limb.ends[side], limb.radii[side]);
                *places.entry((node, radius.to_bits())).or_insert_with(|| {
                    part.nodes.push(Node {
                        radius,
                        is_ball: false,
                        ..self.nodes[node as usize]
                    });
                    part.nodes.len() as u32 - 1
                })
            });
            part.limbs.push(Limb {
                ends,
                group: 0,
                clip: None,
                ..*limb
            });
        }
        part
    }

    /// Writes nodes and curves.
    fn write_lines(&self, out: &mut String) {
        for (node, i) in self.nodes.iter().zip(0_u32..) {
            let [x, y, z] = node.position.to_array();
            let _ = writeln!(out, "  node n{i} <{x} {y} {z}> radius {}", node.radius);
        }
        for chain in self.chains() {
            out.push_str("  curve");
            for node in chain.nodes {
                let _ = write!(out, " n{node}");
            }
            out.push('\n');
        }
    }
}
