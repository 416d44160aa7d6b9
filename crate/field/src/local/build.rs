//! Making the local convolution of a skeleton: its pieces, and the weights of each in the stretches
//! around the others.
use super::cells::Cells;
use super::graph::Graph;
use super::tree::Tree;
use super::window::Window;
use super::{Local, Piece, Run};
use crate::{Bound, Primitive};
use glam::DVec3;

/// The most pairs of pieces within three times the reach of each other.
pub const MOST_LINKS: usize = 1 << 23;

/// A limb of a skeleton between two of its points, for [`Local::new`].
#[derive(Clone, Debug)]
pub struct Limb {
    /// Numbers of the points at its ends, which it shares with its neighbours.
    pub ends: [u32; 2],
    /// Pieces, one after the other along the limb.
    pub pieces: Vec<LimbPiece>,
}

/// A piece of a limb.
#[derive(Clone, Debug)]
pub struct LimbPiece {
    /// Primitives, one after the other along the limb. Their fields are positive.
    pub primitives: Vec<Primitive>,
    /// Length of all of them.
    pub length: f64,
    /// Mean radius of the primitives.
    pub radius: f64,
}

/// Reasons why there is no local convolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalError {
    /// A number is not usable, or a field is not positive.
    Unusable,
    /// Too many pieces are within the reach of each other, see [`MOST_LINKS`].
    Reach,
}

impl Limb {
    fn is_sound(&self, points: usize) -> bool {
        let [a, b] = self.ends;
        (a.max(b) as usize) < points
            && !self.pieces.is_empty()
            && self.pieces.iter().all(|piece| {
                let mut bounds = piece.primitives.iter().map(Bound::new);
                let is_plain = bounds.all(|bound| !bound.carves() && !bound.has_profile());
                let mut sizes = [piece.length, piece.radius].into_iter();
                let is_sound = sizes.all(|size| size.is_finite() && size > 0.0);
                is_sound && is_plain && !piece.primitives.is_empty()
            })
    }
}

impl Local {
    /// Makes the local convolution of limbs between points, with the reach D.
    ///
    /// # Errors
    /// If a number is not usable or too many pieces are within reach of each other.
    pub fn new(points: &[DVec3], limbs: &[Limb], reach: f64) -> Result<Self, LocalError> {
        let is_sound = reach.is_finite()
            && reach > 0.0
            && points.iter().all(|p| p.is_finite())
            && limbs.iter().all(|limb| limb.is_sound(points.len()));
        if !is_sound {
            return Err(LocalError::Unusable);
        }
        let mut graph = Graph::new(points.len());
        let mut pieces = Vec::new();
        // The nodes at the ends of each piece, and the pieces at each node.
        let mut ends: Vec<[u32; 2]> = Vec::new();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
        for limb in limbs {
            let mut before = limb.ends[0];
            for (i, piece) in limb.pieces.iter().enumerate() {
                let after = if i + 1 == limb.pieces.len() {
                    limb.ends[1]
                } else {
                    around.push(Vec::new());
                    graph.add()
                };
                graph.join([before, after], piece.length);
                for node in [before, after] {
                    around[node as usize].push(ends.len() as u32);
                }
                ends.push([before, after]);
                pieces.push(Piece {
                    parts: (piece.primitives.iter())
                        .map(|primitive| (primitive.clone(), Bound::new(primitive)))
                        .collect(),
                    length: piece.length,
                    thickness: piece.radius / piece.length,
                    links: 0..0,
                    near: 0..0,
                });
                before = after;
            }
        }
        let mut local = Self {
            window: Window::new(reach),
            tree: Tree::new(&pieces).ok_or(LocalError::Unusable)?,
            pieces,
            runs: Vec::new(),
            weights: Vec::new(),
            near: Vec::new(),
            level: None,
            cells: Cells::new(points, reach),
        };
        local.connect(&graph, &ends, &around)?;
        Ok(local)
    }

    /// Finds the weights of all pieces in the stretches around each.
    fn connect(
        &mut self,
        graph: &Graph,
        ends: &[[u32; 2]],
        around: &[Vec<u32>],
    ) -> Result<(), LocalError> {
        let mut linked: Vec<u32> = Vec::new();
        for own in 0..self.pieces.len() {
            let length = self.pieces[own].length;
            let from = ends[own].map(|end| (end, 0.5 * length));
            let within = graph.within(&from, 3.0 * self.window.reach, MOST_LINKS);
            linked.clear();
            linked.push(own as u32);
            linked.extend(within.keys().flat_map(|node| &around[*node as usize]));
            linked.sort_unstable();
            linked.dedup();
            if self.near.len() + linked.len() > MOST_LINKS {
                return Err(LocalError::Reach);
            }
            let (first, nearest) = (self.runs.len() as u32, self.near.len() as u32);
            for &other in &linked {
                let length = self.pieces[other as usize].length;
                let distances = ends[other as usize]
                    .map(|end| within.get(&end).copied().unwrap_or(f64::INFINITY));
                let (weight, between) = if other as usize == own {
                    (self.window.mean_around(length), 0.0)
                } else {
                    let between = distances[0].min(distances[1]) + 0.5 * length;
                    (self.window.mean(distances, length), between)
                };
                let apart = self.window.apart(between);
                if apart < 1.0 {
                    self.near.push((other, apart));
                }
                if weight > 0.0 {
                    let is_next = self.runs.len() > first as usize
                        && (self.runs.last()).is_some_and(|run| run.first + run.count == other);
                    match self.runs.last_mut().filter(|_| is_next) {
                        Some(run) => run.count += 1,
                        None => self.runs.push(Run {
                            first: other,
                            count: 1,
                            weights: self.weights.len() as u32,
                        }),
                    }
                    self.weights.push(weight);
                }
            }
            let piece = &mut self.pieces[own];
            piece.links = first..self.runs.len() as u32;
            piece.near = nearest..self.near.len() as u32;
        }
        Ok(())
    }
}
