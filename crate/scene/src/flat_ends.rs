//! Flat ends of limbs, in skeletons and by themselves: they go on beyond their ends, and are cut at
//! a plane.

use crate::curves::MOST_FLAT;
use crate::{Curves, Element, Ends, Function, Scene, Shape, limbs};
use field::shaping::SLIMMEST;
use field::sliced::{Plane, Sliced};
use field::{Implicit, Primitive, Shaping, Skeleton, Sum, Taper};
use glam::DVec3;
use std::sync::Arc;

/// Length of the piece beyond a flat end, in radii, so that the limb is as thick at the plane as
/// before it.
const BEYOND: f64 = 2.0;
/// Length of the limb that is cut, in radii of its end: what is farther away hardly reaches the
/// plane.
const OWN: f64 = 3.0;
/// Steepness with which the field ends beyond the plane, over the inverse radius.
const STEEPNESS: f64 = 32.0;

/// Plane in which the surface of a limb ends, in the world's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatEnd {
    /// Place of the free end, in the plane.
    pub at: DVec3,
    /// Unit vector across the plane, away from the limb.
    pub outward: DVec3,
    /// Radius of the limb there.
    pub radius: f64,
    /// Whether meshes have a hole there.
    pub is_open: bool,
}

/// Piece of a skeleton that is cut at one or two flat ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stump {
    /// Indices of its segments among those that have a length.
    segments: Vec<usize>,
    /// Flat ends, in the skeleton's own coordinates.
    ends: Vec<FlatEnd>,
}

/// Line with its shaping.
type Limb = (Skeleton, Shaping);

/// Piece of a bone that is cut at one or two flat ends.
struct Slice {
    piece: Skeleton,
    shaping: Shaping,
    ends: Vec<FlatEnd>,
}

impl Curves {
    /// Returns the pieces that end flat. No segment is in two of them.
    pub(crate) fn stumps(&self) -> Vec<Stump> {
        let Some(polyline) = self.polyline().filter(|_| self.local.is_none()) else {
            return Vec::new();
        };
        if self.flat.is_empty() {
            return Vec::new();
        }
        // The index of each segment among those that have a length.
        let mut count = 0;
        let places: Vec<usize> = polyline
            .segments
            .iter()
            .map(|segment| {
                count += usize::from(segment.length > 0.0);
                count.saturating_sub(1)
            })
            .collect();
        let mut vertex_of = vec![None; self.skeleton.nodes.len()];
        for (vertex, i) in polyline.vertices.iter().zip(0..) {
            if let Some(node) = vertex.node {
                vertex_of[node] = Some(i);
            }
        }
        let mut stumps: Vec<Stump> = Vec::new();
        for node in self.flat.iter().take(MOST_FLAT) {
            let Some(mut at) = vertex_of.get(*node as usize).copied().flatten() else {
                continue;
            };
            let &[first] = polyline.around(at) else {
                continue;
            };
            let (end, mut segment): (usize, usize) = (at, first);
            let radius = polyline.vertices[end].radius;
            let mut stump = Stump::default();
            let mut length = 0.0;
            loop {
                let own = &polyline.segments[segment];
                let next = if own.ends[0] == at {
                    own.ends[1]
                } else {
                    own.ends[0]
                };
                if own.length > 0.0 {
                    if stump.ends.is_empty() {
                        let [from, to] = [next, end].map(|v| polyline.vertices[v].position);
                        let outward = (to - from).normalize_or_zero();
                        stump.ends.push(FlatEnd {
                            at: to,
                            outward,
                            radius,
                            is_open: self.is_open,
                        });
                    }
                    stump.segments.push(places[segment]);
                }
                length += own.length;
                let &[a, b] = polyline.around(next) else {
                    break;
                };
                if length >= OWN * radius {
                    break;
                }
                (at, segment) = (next, if a == segment { b } else { a });
            }
            // A short limb may be flat at both ends.
            let shared = stumps.iter().position(|other| {
                let mut segments = other.segments.iter();
                segments.any(|segment| stump.segments.contains(segment))
            });
            match shared {
                Some(other) => {
                    let other = &mut stumps[other];
                    stump.segments.retain(|s| !other.segments.contains(s));
                    other.segments.append(&mut stump.segments);
                    other.ends.append(&mut stump.ends);
                }
                None => stumps.push(stump),
            }
        }
        stumps.retain(|stump| !stump.ends.is_empty());
        stumps
    }

    /// Returns whether each segment that has a length is part of a piece that ends flat.
    pub(crate) fn is_in_stump(&self) -> Vec<bool> {
        let mut is_in = vec![false; self.pieces().count()];
        for segment in self.stumps().into_iter().flat_map(|stump| stump.segments) {
            is_in[segment] = true;
        }
        is_in
    }
}

impl Function {
    /// Returns a flat end in the world's coordinates; `None` if it has no direction there.
    fn place_end(&self, end: &FlatEnd) -> Option<FlatEnd> {
        Some(FlatEnd {
            at: self.to_world.transform_point3(end.at),
            outward: self
                .to_world
                .transform_vector3(end.outward)
                .try_normalize()?,
            radius: end.radius * self.growth(),
            ..*end
        })
    }
}

impl Scene {
    /// Lists the planes in which the soft surface of a body ends, in the order of its elements.
    #[must_use]
    pub fn flat_ends(&self, body: u32) -> Vec<FlatEnd> {
        let own = self.elements.iter();
        let own = own.filter(|element| element.body == body && self.is_soft(element));
        let mut all = Vec::new();
        for element in own {
            if let Shape::Function(function) = &element.shape {
                let stumps = function.curves().into_iter().flat_map(Curves::stumps);
                let ends = stumps.flat_map(|stump| stump.ends);
                all.extend(ends.filter_map(|end| function.place_end(&end)));
            } else if let Some((_, slices)) = self.cut_bone(element) {
                all.extend(slices.into_iter().flat_map(|slice| slice.ends));
            }
        }
        all
    }

    /// Returns the functions of the pieces of an element's curves that end flat, in the world's
    /// coordinates.
    pub(crate) fn slice(&self, element: &Element, function: &Function) -> Vec<Arc<dyn Implicit>> {
        let (Some(curves), Some(flesh)) = (function.curves(), self.flesh_in_world(element)) else {
            return Vec::new();
        };
        let stumps = curves.stumps();
        if stumps.is_empty() {
            return Vec::new();
        }
        let limbs: Vec<(Skeleton, Shaping)> = self.segments_of(element, function, &flesh).collect();
        let stumps = stumps.into_iter().map(|stump| {
            let own = stump.segments.iter().map(|segment| limbs[*segment].clone());
            let own = own.flat_map(|(skeleton, shaping)| limbs::cut(skeleton, shaping));
            let own =
                own.filter_map(|(skeleton, shaping)| Primitive::new(skeleton, &shaping, None));
            let ends = stump.ends.iter().filter_map(|end| function.place_end(end));
            cut_flat(own.collect(), &limbs[stump.segments[0]].1, ends.collect())
        });
        stumps.collect()
    }

    /// Cuts a soft bone with flat ends into what is convolved as other bones are, and the pieces
    /// that are cut; `None` if none of its ends is flat. A short or waving limb is cut as a whole.
    fn cut_bone(&self, element: &Element) -> Option<(Option<Limb>, Vec<Slice>)> {
        let bone = element.shape.bone()?;
        if bone.soft_ends == [Ends::Round; 2] {
            return None;
        }
        let flesh = self.flesh_in_world(element)?;
        let line = &bone.skeleton;
        let shaping = self.shaping(element, &flesh, self.radius(element));
        let length = line.measure();
        let radii = [0.0, 1.0].map(|share| shaping.at(share).radius);
        let thickest = radii[0].max(radii[1]);
        let ends = [0, 1].map(|side| {
            let is_tip = radii[side] <= 2.0 * SLIMMEST * thickest;
            if bone.soft_ends[side] == Ends::Round || is_tip {
                return None;
            }
            let share = side as f64;
            Some(FlatEnd {
                at: line.at(share),
                outward: line.tangent(share)? * (2.0 * share - 1.0),
                radius: radii[side],
                is_open: bone.soft_ends[side] == Ends::Open,
            })
        });
        if length <= 0.0 || line.dimension() != 1 || ends.iter().all(Option::is_none) {
            return None;
        }
        let shares = [0, 1].map(|side| match ends[side] {
            Some(end) => OWN * end.radius / length,
            None => 0.0,
        });
        let is_short = shares[0] + shares[1] >= 1.0;
        let is_whole = flesh.profile.is_some()
            || is_short && matches!(line, Skeleton::Segment { .. })
            || shares.iter().any(|share| share.is_nan());
        if is_whole {
            let ends = ends.into_iter().flatten().collect();
            let piece = line.clone();
            return Some((
                None,
                vec![Slice {
                    piece,
                    shaping,
                    ends,
                }],
            ));
        }
        let shares = shares.map(|share| share.min(if is_short { 0.5 } else { 1.0 }));
        let ranges = [[0.0, shares[0]], [1.0 - shares[1], 1.0]];
        let slices = ends.into_iter().zip(ranges).filter_map(|(end, range)| {
            let (piece, shaping) = part_of(line, &shaping, range)?;
            let ends = vec![end?];
            Some(Slice {
                piece,
                shaping,
                ends,
            })
        });
        let rest = part_of(line, &shaping, [shares[0], 1.0 - shares[1]]);
        Some((rest, slices.collect()))
    }

    /// Returns the functions of the pieces of a bone that end flat.
    pub(crate) fn slice_bone(&self, element: &Element) -> Vec<Arc<dyn Implicit>> {
        let slices = self.cut_bone(element).map(|(_, slices)| slices);
        let slices = slices.into_iter().flatten().map(|slice| {
            let own = self.primitives_along(element, slice.piece, slice.shaping);
            cut_flat(own.collect(), &slice.shaping, slice.ends)
        });
        slices.collect()
    }

    /// Returns what of a bone is convolved as it is, with its shaping: all of it if no end is flat.
    pub(crate) fn between_flat_ends(
        &self,
        element: &Element,
        skeleton: Skeleton,
        shaping: Shaping,
    ) -> Option<(Skeleton, Shaping)> {
        match self.cut_bone(element) {
            Some((middle, _)) => middle,
            None => Some((skeleton, shaping)),
        }
    }
}

/// Returns the field of limbs that goes on beyond flat ends and is cut there; `shaping` is that of
/// one of them. It is not cut where a plane is not usable.
fn cut_flat(mut field: Sum, shaping: &Shaping, ends: Vec<FlatEnd>) -> Arc<dyn Implicit> {
    let whole = field.clone();
    let mut planes = Vec::new();
    let mut thinnest = f64::INFINITY;
    for end in ends {
        thinnest = thinnest.min(end.radius);
        planes.push(Plane {
            at: end.at,
            inward: -end.outward,
        });
        let beyond = Skeleton::Segment {
            base: end.at,
            apex: end.at + end.outward * (BEYOND * end.radius),
        };
        let shaping = Shaping {
            radius: end.radius,
            taper: None,
            ..*shaping
        };
        field
            .primitives
            .extend(Primitive::new(beyond, &shaping, None));
    }
    match Sliced::new(field, planes, STEEPNESS / thinnest) {
        Some(sliced) => Arc::new(sliced),
        None => Arc::new(whole),
    }
}
/// Returns a part of a line, between two shares of it, with its own taper; `None` if there is none.
fn part_of(line: &Skeleton, shaping: &Shaping, [from, to]: [f64; 2]) -> Option<Limb> {
    let taper = shaping.taper.map(|_| {
        let Shaping {
            radius, blobbiness, ..
        } = shaping.at(to);
        Taper { radius, blobbiness }
    });
    let own = shaping.at(from);
    let piece = line.part(from, to).filter(|_| from < to)?;
    Some((piece, Shaping { taper, ..own }))
}
