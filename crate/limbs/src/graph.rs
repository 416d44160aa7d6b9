//! Graphs of nodes and limbs.

use crate::error::Remark;
use glam::{DAffine3, DVec3};
use mesh::TriangleMesh;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Node of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Place, in the graph's unit.
    pub position: DVec3,
    /// Radius, > 0. Limbs have radii of their own, which differ from it at the soma of a neuron and
    /// where struts of unlike widths meet.
    pub radius: f64,
    /// Index into [`Graph::groups`].
    pub group: u32,
    /// Whether a ball of this radius stands here, as for an atom or a soma of one node.
    pub is_ball: bool,
    /// Whether neither the file nor a node along the limbs gives a radius, so that it is that of
    /// [`Reading`](crate::Reading).
    pub is_guessed: bool,
}

/// Shape of a limb's end where no other limb goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Cap {
    /// The limb reaches its node plus its radius.
    #[default]
    Round,
    /// The limb ends in the plane through its node.
    Flat,
}

/// Straight limb between two nodes, with a radius at either end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limb {
    /// Indices into [`Graph::nodes`], which differ.
    pub ends: [u32; 2],
    /// Radius at either end, > 0. Between them it varies linearly.
    pub radii: [f64; 2],
    /// Index into [`Graph::groups`].
    pub group: u32,
    /// Shape of either end.
    pub caps: [Cap; 2],
    /// Index into [`Graph::clips`] of the mesh that cuts this limb.
    pub clip: Option<u32>,
}

/// Nodes or limbs of one kind: a type of an SWC file, a material, an element.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Name; may be empty.
    pub name: String,
    /// Colour that the file gives, or custom: linear RGB with Rec. 709's primaries, 0 … 1.
    pub color: Option<[f32; 3]>,
}

/// Side of a clipping mesh on which limbs are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// Limbs are kept inside of the mesh: they are intersected with it.
    Inside,
    /// Limbs are kept outside: the mesh is subtracted.
    Outside,
}

/// Closed mesh that limbs are cut by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clip {
    /// Side that is kept.
    pub side: Side,
    /// The mesh, in the graph's unit.
    pub mesh: TriangleMesh,
}

/// Skeleton of straight limbs, as the formats give it.
///
/// No two limbs join the same two nodes, no limb has its ends at one place, and every node is at a
/// limb's end or is a ball.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Graph {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// The limbs.
    pub limbs: Vec<Limb>,
    /// Names and colours of kinds of nodes and limbs.
    pub groups: Vec<Group>,
    /// Meshes that limbs are cut by.
    pub clips: Vec<Clip>,
    /// Millimetres of the unit, where the format or the file says it.
    pub millimetres: Option<f64>,
    /// Sentences about what was left out of the file, changed or guessed.
    pub remarks: Vec<Remark>,
}

/// Counts that describe the shape of a graph as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Number of connected parts, balls without limbs included.
    pub components: usize,
    /// Number of independent cycles, limbs − nodes + components: the genus of the surface around
    /// the limbs, summed over its shells, where limbs that share no node do not touch.
    pub cycles: usize,
    /// Number of nodes at which exactly one limb ends.
    pub free_ends: usize,
    /// The most limbs at a node.
    pub valence: usize,
}

impl Graph {
    /// Counts components, cycles and free ends.
    #[must_use]
    pub fn facts(&self) -> Facts {
        let degrees = self.degrees();
        let mut sets = Sets::new(self.nodes.len());
        let mut components = self.nodes.len();
        for limb in &self.limbs {
            components -= usize::from(sets.join(limb.ends[0], limb.ends[1]));
        }
        Facts {
            components,
            cycles: self.limbs.len() + components - self.nodes.len(),
            free_ends: degrees.iter().filter(|d| **d == 1).count(),
            valence: degrees.iter().copied().max().unwrap_or(0) as usize,
        }
    }

    /// Length of a limb, > 0.
    ///
    /// # Panics
    /// If there is no such limb.
    #[must_use]
    pub fn length(&self, limb: usize) -> f64 {
        let [a, b] = self.limbs[limb]
            .ends
            .map(|end| self.nodes[end as usize].position);
        a.distance(b)
    }

    /// Multiplies positions and radii, and those of clipping meshes, by a factor > 0.
    pub fn scale(&mut self, factor: f64) {
        self.place(&DAffine3::from_scale(DVec3::splat(factor)));
    }

    /// Maps all positions. Radii are multiplied by the cube root of the map's change of volume.
    pub fn place(&mut self, map: &DAffine3) {
        let growth = growth(map);
        for node in &mut self.nodes {
            node.position = map.transform_point3(node.position);
            node.radius *= growth;
        }
        for limb in &mut self.limbs {
            limb.radii = limb.radii.map(|radius| radius * growth);
        }
        let is_mirror = map.matrix3.determinant() < 0.0;
        for mesh in self.clips.iter_mut().map(|clip| &mut clip.mesh) {
            for position in &mut mesh.positions {
                *position = map.transform_point3(*position);
            }
            for triangle in mesh.triangles.iter_mut().filter(|_| is_mirror) {
                triangle.swap(1, 2);
            }
        }
    }

    /// Adds a length to all radii. A negative one thins: limbs of which nothing is left are taken
    /// out, with a remark, and no radius falls below a thousandth of what it was.
    pub fn thicken(&mut self, by: f64) {
        let before = self.limbs.len() + self.nodes.iter().filter(|node| node.is_ball).count();
        self.limbs
            .retain(|limb| limb.radii.iter().any(|radius| radius + by > 0.0));
        for limb in &mut self.limbs {
            limb.radii = limb.radii.map(|radius| thicken(radius, by));
        }
        for node in &mut self.nodes {
            node.is_ball &= node.radius + by > 0.0;
            node.radius = thicken(node.radius, by);
        }
        let after = self.limbs.len() + self.nodes.iter().filter(|node| node.is_ball).count();
        if after < before {
            let text = format!("{} limbs or balls are thinned to nothing", before - after);
            self.remarks.push(Remark { line: None, text });
            self.drop_lonely_nodes();
        }
    }

    /// Returns a graph of some limbs in which each node has the radius of all its limbs: a node at
    /// which radii jump is there once for each.
    #[must_use]
    pub fn part(&self, is_in: impl Fn(&Limb) -> bool) -> Self {
        let mut part = Self::default();
        let mut places: HashMap<(u32, u64), u32> = HashMap::new();
        for limb in self.limbs.iter().filter(|limb| is_in(limb)) {
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

    /// Gives a radius > 0 to all nodes that have none of their own, and to the limbs' ends there.
    pub fn give_radius(&mut self, radius: f64) {
        for node in self.nodes.iter_mut().filter(|node| node.is_guessed) {
            node.radius = radius;
        }
        for limb in &mut self.limbs {
            for (own, end) in limb.radii.iter_mut().zip(limb.ends) {
                if self.nodes[end as usize].is_guessed {
                    *own = radius;
                }
            }
        }
    }

    /// Makes the caps of limbs flat at free ends that are flat in the file, or at all if asked for,
    /// and round elsewhere. Returns the number of flat ones.
    pub fn choose_caps(&mut self, are_flat: bool) -> usize {
        let degrees = self.degrees();
        let mut count = 0;
        for limb in &mut self.limbs {
            for (cap, end) in limb.caps.iter_mut().zip(limb.ends) {
                let is_free = degrees[end as usize] == 1 && !self.nodes[end as usize].is_ball;
                let is_flat = is_free && (are_flat || *cap == Cap::Flat);
                *cap = if is_flat { Cap::Flat } else { Cap::Round };
                count += usize::from(is_flat);
            }
        }
        count
    }

    /// Moves each free end on along its limb, by a multiple of its radius that its cap gives; one
    /// below 0 moves it back, by a quarter of the limb at most. The limb's radius goes on as it
    /// varies, down to a half of the end's.
    pub fn lengthen_free_ends(&mut self, by: impl Fn(Cap) -> f64) {
        let degrees = self.degrees();
        for limb in &mut self.limbs {
            let [start, end] = limb.ends.map(|end| self.nodes[end as usize].position);
            let (along, radii) = (end - start, limb.radii);
            let length = along.length();
            for (side, onwards) in [(0, -along), (1, along)] {
                let node = &mut self.nodes[limb.ends[side] as usize];
                if degrees[limb.ends[side] as usize] != 1 || node.is_ball {
                    continue;
                }
                let step = (by(limb.caps[side]) * radii[side]).max(-0.25 * length);
                let slope = (radii[side] - radii[1 - side]) / length;
                limb.radii[side] = (radii[side] + slope * step).max(0.5 * radii[side]);
                node.position += onwards * (step / length);
                node.radius = limb.radii[side];
            }
        }
    }

    /// Counts the limbs at each node.
    pub(crate) fn degrees(&self) -> Vec<u32> {
        let mut degrees = vec![0; self.nodes.len()];
        for end in self.limbs.iter().flat_map(|limb| limb.ends) {
            degrees[end as usize] += 1;
        }
        degrees
    }

    /// Lists the limbs at each node, in ascending order.
    pub(crate) fn around(&self) -> Vec<Vec<u32>> {
        let mut around = vec![Vec::new(); self.nodes.len()];
        for (limb, index) in self.limbs.iter().zip(0..) {
            for end in limb.ends {
                around[end as usize].push(index);
            }
        }
        around
    }

    /// Takes out the nodes that are neither balls nor ends of limbs.
    pub(crate) fn drop_lonely_nodes(&mut self) {
        let degrees = self.degrees();
        let mut is_kept: Vec<bool> = degrees.into_iter().map(|degree| degree > 0).collect();
        let mut count = 0;
        let mut places: Vec<u32> = Vec::with_capacity(is_kept.len());
        for (node, is_kept) in self.nodes.iter().zip(&mut is_kept) {
            *is_kept |= node.is_ball;
            places.push(count);
            count += u32::from(*is_kept);
        }
        let mut is_kept = is_kept.into_iter();
        self.nodes.retain(|_| is_kept.next() == Some(true));
        for limb in &mut self.limbs {
            limb.ends = limb.ends.map(|end| places[end as usize]);
        }
    }
}

/// Adds a length to a radius, of which a thousandth remains at least.
fn thicken(radius: f64, by: f64) -> f64 {
    (radius + by).max(1e-3 * radius)
}

/// Returns the cube root of a map's change of volume: what it does to radii.
pub(crate) fn growth(map: &DAffine3) -> f64 {
    libm::cbrt(map.matrix3.determinant().abs())
}

/// Disjoint sets of numbers.
pub(crate) struct Sets(Vec<u32>);

impl Sets {
    /// Returns sets of one number each.
    pub(crate) fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// Returns the least number of a set.
    pub(crate) fn find(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    /// Joins two sets, and returns whether they were two.
    pub(crate) fn join(&mut self, a: u32, b: u32) -> bool {
        let [a, b] = [self.find(a), self.find(b)];
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}
