//! OBJ: lines with the radii in texture coordinates.

use super::Written;
use crate::graph::Graph;
use crate::read::RADII_IN_VT;
use std::fmt::Write as _;

impl Graph {
    /// Writes an OBJ file of lines, with the names of groups as materials. Radii stand in `vt`, of
    /// which OBJ's other readers make nothing.
    #[must_use]
    pub fn write_obj(&self) -> Written {
        let mut written = Written {
            text: format!("{RADII_IN_VT}\n"),
            remarks: Vec::new(),
        };
        let out = &mut written.text;
        // Writing to a string does not fail.
        for node in &self.nodes {
            let [x, y, z] = node.position.to_array();
            let _ = writeln!(out, "v {x} {y} {z}");
        }
        let mut radii = 0;
        let mut group = None;
        for chain in self.chains() {
            let mut line = String::from("l");
            let mut last = None;
            for ((index, is_forward), (from, to)) in chain
                .limbs
                .iter()
                .zip(chain.nodes.iter().zip(&chain.nodes[1..]))
            {
                let limb = &self.limbs[*index as usize];
                if group != Some(limb.group) {
                    group = Some(limb.group);
                    let name = &self.groups[limb.group as usize].name;
                    let _ = writeln!(out, "usemtl {name}");
                }
                let [a, b] = match is_forward {
                    true => limb.radii,
                    false => [limb.radii[1], limb.radii[0]],
                };
                if last.is_none() {
                    let _ = writeln!(out, "vt {a}");
                    radii += 1;
                    let _ = write!(line, " {}/{radii}", from + 1);
                }
                let _ = writeln!(out, "vt {b}");
                radii += 1;
                let _ = write!(line, " {}/{radii}", to + 1);
                last = Some(b);
            }
            let _ = writeln!(out, "{line}");
        }
        let balls = self.nodes.iter().filter(|node| node.is_ball).count();
        written.remark_count(balls, "balls are left out: OBJ has lines only");
        written
    }
}
