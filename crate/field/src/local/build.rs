//! Making the local convolution of a skeleton: segments, the pieces within their reach, and
//! distances along the skeleton.
use super::cells::Cells;
use super::graph::Graph;
use super::groups::Group;
use super::planes::Swept;
use super::window::Window;
use super::{Link, Local, Piece, Segment};
use crate::{Bound, Primitive};
use glam::DVec3;
use std::collections::BTreeMap;

/// The most pairs of a segment and a piece within its reach.
pub const MOST_LINKS: usize = 1 << 22;

/// A segment of a skeleton, for [`Local::new`].
#[derive(Clone, Debug)]
pub struct Limb {
    /// Numbers of the points at its ends, which it shares with its neighbours.
    pub ends: [u32; 2],
    /// Segment that goes on from each end, if one does.
    pub next: [Option<u32>; 2],
    /// Pieces, one after the other along the segment, as primitives with their lengths. Their
    /// fields are positive.
    pub pieces: Vec<(Primitive, f64)>,
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
    fn length(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.1).sum()
    }

    fn is_sound(&self, points: usize) -> bool {
        let [a, b] = self.ends;
        a != b
            && (a.max(b) as usize) < points
            && !self.pieces.is_empty()
            && self.pieces.iter().all(|(primitive, length)| {
                let bound = Bound::new(primitive);
                length.is_finite() && *length > 0.0 && !bound.carves() && !bound.has_profile()
            })
    }
}

impl Local {
    /// The local convolution of segments between points, with the reach D.
    ///
    /// # Errors
    /// If a number is not usable or too many pieces are within reach of each other.
    pub fn new(points: &[DVec3], limbs: &[Limb], reach: f64) -> Result<Self, LocalError> {
        let count = limbs.len() as u32;
        let sound = reach.is_finite()
            && reach > 0.0
            && points.iter().all(|p| p.is_finite())
            && limbs.iter().all(|limb| {
                let mut next = limb.next.iter().flatten();
                limb.is_sound(points.len()) && next.all(|next| *next < count)
            });
        if !sound {
            return Err(LocalError::Unusable);
        }
        // Two graphs: of the points alone, and with those at which limbs are cut into pieces.
        let (mut joints, mut cuts) = (Graph::new(points.len()), Graph::new(points.len()));
        let mut pieces = Vec::new();
        let mut ends = Vec::new();
        for limb in limbs {
            joints.join(limb.ends, limb.length());
            let mut before = limb.ends[0];
            for (i, (primitive, length)) in limb.pieces.iter().enumerate() {
                let last = i + 1 == limb.pieces.len();
                let after = if last { limb.ends[1] } else { cuts.add() };
                cuts.join([before, after], *length);
                ends.push(([before, after], *length));
                pieces.push(Piece {
                    bound: Bound::new(primitive),
                    primitive: primitive.clone(),
                });
                before = after;
            }
        }
        let groups: Option<Vec<Group>> = pieces.iter().map(Piece::group).collect();
        let groups = groups.ok_or(LocalError::Unusable)?;
        let mut pairs = 0;
        let mut distances = |graph: &Graph, reach: f64| -> Result<Vec<_>, LocalError> {
            let each = (0..points.len() as u32).map(|point| {
                let near = graph.within(point, reach, MOST_LINKS);
                pairs += near.len();
                (pairs <= MOST_LINKS).then_some(near)
            });
            each.collect::<Option<_>>().ok_or(LocalError::Reach)
        };
        let near = distances(&joints, 2.0 * reach)?;
        let near = near.into_iter().map(|near| near.into_iter().collect());
        let within = distances(&cuts, reach)?;
        let mut local = Self {
            window: Window::new(reach),
            segments: Vec::new(),
            links: Vec::new(),
            nodes: Vec::new(),
            tree: Vec::new(),
            terms: Vec::new(),
            cells: Cells::new(points, reach),
            near: near.collect(),
            pieces,
        };
        local.connect(points, limbs, &ends, &within, &groups)?;
        local.plant(&groups, [0, groups.len() as u32]);
        local.terms = (0..(local.segments.len() + local.nodes.len()) as u32).collect();
        Ok(local)
    }

    /// Makes the segments with their links.
    fn connect(
        &mut self,
        points: &[DVec3],
        limbs: &[Limb],
        ends: &[([u32; 2], f64)],
        within: &[BTreeMap<u32, f64>],
        groups: &[Group],
    ) -> Result<(), LocalError> {
        let mut owners: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (piece, (ends, _)) in (0..).zip(ends) {
            for end in ends {
                owners.entry(*end).or_default().push(piece);
            }
        }
        let mut known = BTreeMap::new();
        let mut first = 0;
        for (index, limb) in (0..).zip(limbs) {
            let own = first..first + limb.pieces.len() as u32;
            first = own.end;
            let start = self.links.len();
            let mut place = 0.0;
            for piece in own.clone() {
                let (_, length) = ends[piece as usize];
                self.links.push(Link {
                    piece,
                    length,
                    distances: [[place; 2], [place + length; 2]],
                    own: true,
                });
                place += length;
            }
            let [a, b] = limb.ends.map(|end| &within[end as usize]);
            let mut others: Vec<u32> = (a.keys().chain(b.keys()))
                .flat_map(|node| owners.get(node).into_iter().flatten().copied())
                .filter(|piece| !own.contains(piece))
                .collect();
            others.sort_unstable();
            others.dedup();
            let far =
                |map: &BTreeMap<u32, f64>, node: u32| *map.get(&node).unwrap_or(&f64::INFINITY);
            for piece in others {
                let (ends, length) = ends[piece as usize];
                self.links.push(Link {
                    piece,
                    length,
                    distances: ends.map(|end| [far(a, end), far(b, end)]),
                    own: false,
                });
            }
            if self.links.len() > MOST_LINKS {
                return Err(LocalError::Reach);
            }
            let links = start..self.links.len();
            let reached = self.links[links.clone()]
                .iter()
                .map(|l| groups[l.piece as usize]);
            let group = reached.reduce(Group::join).ok_or(LocalError::Unusable)?;
            let normals = [0, 1].map(|end| normal(points, limbs, limb, end));
            self.segments.push(Segment {
                ends: limb.ends,
                next: limb.next,
                swept: Swept::new(limb.ends.map(|end| points[end as usize]), normals),
                length: limb.length(),
                links,
                group,
            });
            for end in [0, 1] {
                // One of the segments that meet at a branch stands for all.
                if limb.next[end].is_none() && known.insert(limb.ends[end], ()).is_none() {
                    self.nodes.push((index, end));
                }
            }
        }
        Ok(())
    }
}

/// The normal of the plane at an end of a limb: half-way to the direction of the one that goes on
/// there, else its own direction.
fn normal(points: &[DVec3], limbs: &[Limb], limb: &Limb, end: usize) -> DVec3 {
    let direction = |limb: &Limb| {
        let [a, b] = limb.ends.map(|end| points[end as usize]);
        (b - a).normalize_or(DVec3::X)
    };
    let own = direction(limb);
    let Some(next) = limb.next[end].and_then(|next| limbs.get(next as usize)) else {
        return own;
    };
    // Both in the sense of this one.
    let other = if next.ends[1 - end] == limb.ends[end] {
        direction(next)
    } else {
        -direction(next)
    };
    let sum = own + other;
    // A fold back has the same plane for both.
    if sum.length() > 1e-6 {
        sum.normalize()
    } else {
        own
    }
}
