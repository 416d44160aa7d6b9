//! Graphs in the making: what all readers end with.

use crate::error::{Error, Remark, fail};
use crate::graph::{Clip, Graph, Group, Limb, Node};
use crate::limits::{
    MAX_COORDINATE, MAX_GROUPS, MAX_LIMBS, MAX_LISTED, MAX_NAME, MAX_NODES, MAX_POINTS, MAX_REMARKS,
};
use glam::DVec3;
use std::collections::HashMap;
use std::collections::VecDeque;

/// Radius of a node or an end whose file gives none that is above 0.
pub(crate) const UNKNOWN: f64 = 0.0;

/// Graph that a reader is still adding to: limbs may be listed twice, have no length, or lack
/// radii.
#[derive(Default)]
pub(crate) struct Draft {
    graph: Graph,
    groups: HashMap<String, u32>,
    remarks: usize,
}

impl Draft {
    /// Returns an empty draft of a unit, in millimetres.
    pub(crate) fn new(millimetres: Option<f64>) -> Self {
        let graph = Graph {
            millimetres,
            ..Graph::default()
        };
        Self {
            graph,
            ..Self::default()
        }
    }

    /// Adds a node, and returns its index. A radius that is no number above 0 is [`UNKNOWN`].
    pub(crate) fn node(&mut self, position: DVec3, radius: f64, group: u32) -> Result<u32, Error> {
        if self.graph.nodes.len() == MAX_POINTS {
            return fail(format!("more than {MAX_POINTS} points"));
        }
        if !position.is_finite() || position.abs().max_element() > MAX_COORDINATE {
            return fail(format!(
                "coordinates must be numbers within ±{MAX_COORDINATE:e}"
            ));
        }
        if radius.is_nan() || radius.abs() > MAX_COORDINATE {
            return fail(format!(
                "a radius must be a number up to {MAX_COORDINATE:e}"
            ));
        }
        self.graph.nodes.push(Node {
            position,
            radius: radius.max(UNKNOWN),
            group,
            is_ball: false,
            is_guessed: false,
        });
        Ok(self.graph.nodes.len() as u32 - 1)
    }

    /// Returns the number of nodes so far.
    pub(crate) fn count(&self) -> usize {
        self.graph.nodes.len()
    }

    /// Whether there are neither limbs nor balls.
    pub(crate) fn is_bare(&self) -> bool {
        self.graph.limbs.is_empty() && !self.graph.nodes.iter().any(|node| node.is_ball)
    }

    /// Returns a node's position.
    pub(crate) fn position(&self, node: u32) -> DVec3 {
        self.graph.nodes[node as usize].position
    }

    /// Returns a node's radius.
    pub(crate) fn radius(&self, node: u32) -> f64 {
        self.graph.nodes[node as usize].radius
    }

    /// Makes a node as thick as a radius, if it is thinner.
    pub(crate) fn widen(&mut self, node: u32, radius: f64) {
        let own = &mut self.graph.nodes[node as usize].radius;
        *own = own.max(radius);
    }

    /// Puts a ball around a node.
    pub(crate) fn ball(&mut self, node: u32) {
        self.graph.nodes[node as usize].is_ball = true;
    }

    /// Adds a limb.
    pub(crate) fn add(&mut self, limb: Limb) -> Result<(), Error> {
        if self.graph.limbs.len() == MAX_LISTED {
            return fail(format!("more than {MAX_LISTED} limbs"));
        }
        self.graph.limbs.push(limb);
        Ok(())
    }

    /// Adds a clipping mesh, and returns its index.
    pub(crate) fn clip(&mut self, clip: Clip) -> u32 {
        self.graph.clips.push(clip);
        self.graph.clips.len() as u32 - 1
    }

    /// Returns the index of the group of a name, which is made if there is none.
    pub(crate) fn group(&mut self, name: &str, color: Option<[f32; 3]>) -> Result<u32, Error> {
        let name = &name[..name.floor_char_boundary(MAX_NAME)];
        if let Some(group) = self.groups.get(name) {
            return Ok(*group);
        }
        if self.graph.groups.len() == MAX_GROUPS {
            return fail(format!("more than {MAX_GROUPS} types or materials"));
        }
        let group = self.graph.groups.len() as u32;
        self.groups.insert(name.into(), group);
        self.graph.groups.push(Group {
            name: name.into(),
            color,
        });
        Ok(group)
    }

    /// Adds a remark, and only counts those beyond the first [`MAX_REMARKS`].
    pub(crate) fn remark(&mut self, line: Option<usize>, text: impl Into<String>) {
        self.remarks += 1;
        if self.remarks <= MAX_REMARKS {
            let text = text.into();
            self.graph.remarks.push(Remark { line, text });
        }
    }

    /// Adds a remark about some limbs or nodes, if there are any. `text` follows on their number.
    pub(crate) fn remark_count(&mut self, count: usize, text: &str) {
        if count > 0 {
            self.remark(None, format!("{count} {text}"));
        }
    }

    /// Joins nodes at the very same place into the first of them.
    pub(crate) fn weld(&mut self) {
        let mut first: HashMap<[u64; 3], u32> = HashMap::new();
        let nodes = self.graph.nodes.iter().zip(0..);
        let places: Vec<u32> = nodes
            .map(|(node, i)| {
                // A zero has no sign.
                let key = (node.position + DVec3::ZERO).to_array().map(f64::to_bits);
                *first.entry(key).or_insert(i)
            })
            .collect();
        self.graph.join(&places);
    }

    /// Returns the graph: limbs without length are drawn together to a node, those that are listed
    /// twice count once, radii that are not known are those of the nearest node along the limbs, or
    /// the default.
    ///
    /// # Errors
    /// If no radius is known, or the graph is empty or over a limit.
    pub(crate) fn finish(mut self, default: Option<f64>) -> Result<Graph, Error> {
        let short = self.graph.contract();
        self.remark_count(short, "limbs have no length and are left out");
        let twice = self.graph.drop_doubles();
        self.remark_count(
            twice,
            "limbs are listed more than once: each counts once, the thickest of them",
        );
        self.graph.drop_lonely_nodes();
        let Graph { nodes, limbs, .. } = &self.graph;
        if nodes.is_empty() {
            return fail("there are no limbs in this file");
        }
        if limbs.len() > MAX_LIMBS || nodes.len() > MAX_NODES {
            return fail(format!(
                "this skeleton has {} limbs between {} nodes; {MAX_LIMBS} limbs and {MAX_NODES} \
                 nodes are the limit: cut it into parts, or simplify it where it was made",
                limbs.len(),
                nodes.len()
            ));
        }
        self.fill(default)?;
        let more = self.remarks.saturating_sub(MAX_REMARKS);
        if more > 0 {
            let text = format!("and {more} more remarks of such kinds");
            self.graph.remarks.push(Remark { line: None, text });
        }
        Ok(self.graph)
    }

    /// Gives radii to the nodes and ends that have none.
    fn fill(&mut self, default: Option<f64>) -> Result<(), Error> {
        let graph = &mut self.graph;
        for limb in &graph.limbs {
            for (end, radius) in limb.ends.into_iter().zip(limb.radii) {
                let node = &mut graph.nodes[end as usize];
                if node.radius <= UNKNOWN {
                    node.radius = radius;
                }
            }
        }
        let unknown = graph
            .nodes
            .iter()
            .filter(|node| node.radius <= UNKNOWN)
            .count();
        if unknown > 0 {
            let known = (0..)
                .zip(&graph.nodes)
                .filter(|(_, node)| node.radius > UNKNOWN);
            let mut queue: VecDeque<u32> = known.map(|(i, _)| i).collect();
            let none_known = queue.is_empty();
            let around = graph.around();
            while let Some(i) = queue.pop_front() {
                let radius = graph.nodes[i as usize].radius;
                for limb in &around[i as usize] {
                    for end in graph.limbs[*limb as usize].ends {
                        let node = &mut graph.nodes[end as usize];
                        if node.radius <= UNKNOWN {
                            node.radius = radius;
                            queue.push_back(end);
                        }
                    }
                }
            }
            for node in graph.nodes.iter_mut().filter(|node| node.radius <= UNKNOWN) {
                let Some(radius) = default else {
                    return fail(
                        "this file gives no radii above 0: give the material, or the skeleton, a \
                         radius",
                    );
                };
                node.radius = radius;
                node.is_guessed = true;
            }
            if !none_known {
                self.remark_count(
                    unknown,
                    "nodes have no radius above 0 and get that of the nearest one along the limbs",
                );
            }
        }
        let Graph { nodes, limbs, .. } = &mut self.graph;
        for limb in limbs {
            for (end, radius) in limb.ends.into_iter().zip(&mut limb.radii) {
                if *radius <= UNKNOWN {
                    *radius = nodes[end as usize].radius;
                }
            }
        }
        Ok(())
    }
}
