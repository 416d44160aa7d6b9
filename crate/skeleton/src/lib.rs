//! Skeletons: curves on a graph of nodes, refined by subdivision to polylines.
//!
//! A [`Skeleton`] has nodes, each with a position and a radius, and curves, each a control polygon
//! through two or more nodes. Curves that share a node branch there. [`Skeleton::polyline`] refines
//! them by a [`Scheme`] and returns a [`Polyline`]: a graph of short segments that knows radii, arc
//! lengths and neighbours.
//!
//! - A curve begins and ends at its end nodes, and passes through each node that it shares with
//!   another curve (or that it visits twice), with a continuous tangent. A curve whose first and
//!   last node are the same is closed, and passes through that node so, too. All other nodes
//!   attract it only, except in the four-point scheme, which passes through every node.
//! - All vertices lie on the scheme's limit curve, at every level: a level of detail is a coarser
//!   or finer polygon of the same curve.
//! - Radii are refined as a fourth coordinate, and kept between the least and the greatest radius
//!   of the curve's nodes.
//!
//! Only `+ − × ÷ √` are used: results have the same bits on every platform.
//!
//! ```
//! use glam::DVec3;
//! use skeleton::{Node, Scheme, Skeleton};
//!
//! let node = |x, y| Node { position: DVec3::new(x, y, 0.0), radius: 0.1 };
//! let skeleton = Skeleton {
//!     nodes: vec![node(0.0, 0.0), node(1.0, 0.0), node(2.0, 1.0), node(1.0, 2.0)],
//!     // The second curve branches off the first one at node 1.
//!     curves: vec![vec![0, 1, 2], vec![1, 3]],
//! };
//! let polyline = skeleton.polyline(Scheme::Cubic, 2)?;
//! assert_eq!(polyline.segments.len(), 4 * (2 + 1));
//! let branch = polyline.vertices.iter().position(|v| v.node == Some(1)).unwrap();
//! assert_eq!(polyline.around(branch).len(), 3);
//! # Ok::<(), skeleton::Error>(())
//! ```

mod error;
mod polyline;
mod scheme;

pub use error::Error;
pub use polyline::{Polyline, Segment, Vertex};
pub use scheme::Scheme;

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The most nodes of a skeleton.
pub const MOST_NODES: usize = 400_000;
/// The most curves of a skeleton.
pub const MOST_CURVES: usize = 200_000;
/// The most segments of a polyline.
pub const MOST_SEGMENTS: usize = 200_000;
/// The most levels of subdivision.
pub const MOST_LEVELS: u32 = 6;
/// The largest coordinate and radius of a node.
pub const LARGEST: f64 = 1e100;

/// The least weight of a node that counts.
const LEAST_WEIGHT: f64 = 1e-6;

/// Node of a skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Place in space.
    pub position: DVec3,
    /// The radius of the flesh there, at least 0.
    pub radius: f64,
}

/// Nodes, and curves through them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Skeleton {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// Indices of each curve's nodes, at least two.
    pub curves: Vec<Vec<usize>>,
}

impl Skeleton {
    /// Refines the curves by some levels of subdivision. Each level doubles the number of segments.
    ///
    /// # Errors
    /// If a curve has fewer than two nodes or names one that there is not, if a coordinate or a
    /// radius is not usable, or if a limit is passed; nothing is computed then.
    pub fn polyline(&self, scheme: Scheme, levels: u32) -> Result<Polyline, Error> {
        self.check(scheme, levels)?;
        let visits = self.visits();
        let curves = self.curves.iter().map(|curve| {
            let nodes: Vec<_> = curve.iter().map(|&index| self.nodes[index]).collect();
            let fixed: Vec<_> = curve.iter().map(|&index| visits[index] > 1).collect();
            scheme::refine(scheme, levels, &nodes, &fixed, is_closed(curve))
        });
        Ok(Polyline::new(self, curves.collect()))
    }

    /// Computes for each vertex of [`Self::polyline`] the nodes whose places it is a mean of, with
    /// their weights, which add up to 1. Weights of nodes that lie behind others on the way may be
    /// negative. Takes a third as many refinements as there are nodes.
    ///
    /// ```
    /// use glam::DVec3;
    /// use skeleton::{Node, Scheme, Skeleton};
    ///
    /// let node = |x, y| Node { position: DVec3::new(x, y, 0.0), radius: 0.1 };
    /// let nodes = vec![node(0.0, 0.0), node(1.0, 1.0), node(2.0, 0.0)];
    /// let skeleton = Skeleton { nodes, curves: vec![vec![0, 1, 2]] };
    /// let weights = skeleton.weights(Scheme::Cubic, 0)?;
    /// // The spline's point at a corner is (P + 4Q + R)/6.
    /// assert_eq!(weights[1].iter().map(|(node, _)| *node).collect::<Vec<_>>(), [0, 1, 2]);
    /// assert!((weights[1][1].1 - 4.0 / 6.0).abs() < 1e-12);
    /// # Ok::<(), skeleton::Error>(())
    /// ```
    ///
    /// # Errors
    /// Fails as [`Self::polyline`] does.
    pub fn weights(&self, scheme: Scheme, levels: u32) -> Result<Vec<Vec<(usize, f64)>>, Error> {
        let count = self.nodes.len();
        let mut weights: Vec<Vec<(usize, f64)>> = Vec::new();
        // Refinement is linear in the nodes' places, so that it is told by three nodes at a time
        // being moved along the axes.
        for start in (0..count).step_by(3) {
            let nodes = (0..count).map(|i| Node {
                position: match i.checked_sub(start) {
                    Some(axis @ 0..3) => DVec3::AXES[axis],
                    _ => DVec3::ZERO,
                },
                radius: 0.0,
            });
            let probe = Self {
                nodes: nodes.collect(),
                curves: self.curves.clone(),
            };
            let refined = probe.polyline(scheme, levels)?;
            weights.resize_with(refined.vertices.len(), Vec::new);
            for (own, vertex) in weights.iter_mut().zip(&refined.vertices) {
                for (axis, weight) in vertex.position.to_array().into_iter().enumerate() {
                    if weight.abs() > LEAST_WEIGHT {
                        own.push((start + axis, weight));
                    }
                }
            }
        }
        for own in &mut weights {
            let sum: f64 = own.iter().map(|(_, weight)| weight).sum();
            for (_, weight) in own {
                *weight /= sum;
            }
        }
        Ok(weights)
    }

    /// Counts the visits of each node. The last node of a closed curve is its first one again, and
    /// counts once more, so that the curve passes through it.
    fn visits(&self) -> Vec<u32> {
        let mut visits = vec![0; self.nodes.len()];
        for &node in self.curves.iter().flatten() {
            visits[node] += 1;
        }
        visits
    }

    fn check(&self, scheme: Scheme, levels: u32) -> Result<(), Error> {
        if self.nodes.len() > MOST_NODES {
            return Err(Error::Nodes(self.nodes.len()));
        }
        if self.curves.len() > MOST_CURVES {
            return Err(Error::Curves(self.curves.len()));
        }
        if levels > MOST_LEVELS {
            return Err(Error::Levels(levels));
        }
        for (index, node) in self.nodes.iter().enumerate() {
            let usable = node.position.abs().max_element() <= LARGEST
                && !node.position.is_nan()
                && (0.0..=LARGEST).contains(&node.radius);
            if !usable {
                return Err(Error::Node(index));
            }
        }
        let mut segments = 0;
        for (index, curve) in self.curves.iter().enumerate() {
            if curve.len() < 2 {
                return Err(Error::Short(index));
            }
            if curve.iter().any(|&node| node >= self.nodes.len()) {
                return Err(Error::Unknown(index));
            }
            // Chaikin's scheme cuts every node's corner.
            let most = match scheme {
                Scheme::Chaikin => 2 * curve.len(),
                Scheme::Cubic | Scheme::FourPoint => curve.len() - 1,
            };
            segments += most << levels;
            if segments > MOST_SEGMENTS {
                return Err(Error::Segments);
            }
        }
        Ok(())
    }
}

/// Whether a curve's end is its beginning.
fn is_closed(curve: &[usize]) -> bool {
    curve.len() > 2 && curve.first() == curve.last()
}
