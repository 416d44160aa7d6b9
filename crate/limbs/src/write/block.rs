//! The block form of the language of scenes.

use super::Written;
use crate::graph::Graph;
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
            let part = self.part(|limb| own[limb.group as usize] == sn);
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
