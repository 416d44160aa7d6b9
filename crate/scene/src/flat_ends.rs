//! Flat ends of skeletons: the limbs there go on beyond their ends, and are cut at a plane.

use crate::curves::MOST_FLAT;
use crate::{Curves, Element, Function, Scene, Shape, limbs};
use field::sliced::{Plane, Sliced};
use field::{Implicit, Primitive, Shaping, Skeleton, Sum};
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

/// Plane in which the surface of a skeleton ends, in the world's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatEnd {
    /// Place of the free end, in the plane.
    pub at: DVec3,
    /// Unit vector across the plane, away from the limb.
    pub outward: DVec3,
    /// Radius of the limb there.
    pub radius: f64,
}

/// Piece of a skeleton that is cut at one or two flat ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stump {
    /// Indices of its segments among those that have a length.
    segments: Vec<usize>,
    /// Flat ends: place, direction outwards and radius of each.
    ends: Vec<(DVec3, DVec3, f64)>,
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
                        stump.ends.push((to, outward, radius));
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
    fn place_end(&self, (at, outward, radius): (DVec3, DVec3, f64)) -> Option<FlatEnd> {
        Some(FlatEnd {
            at: self.to_world.transform_point3(at),
            outward: self.to_world.transform_vector3(outward).try_normalize()?,
            radius: radius * self.growth(),
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
            if let Shape::Function(function) = &element.shape
                && let Some(curves) = function.curves()
            {
                let ends = curves.stumps().into_iter().flat_map(|stump| stump.ends);
                all.extend(ends.filter_map(|end| function.place_end(end)));
            }
        }
        all
    }

    /// The functions of the pieces of an element's curves that end flat, in the world's
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
        let mut functions: Vec<Arc<dyn Implicit>> = Vec::new();
        for stump in stumps {
            let mut own: Vec<(Skeleton, Shaping)> = Vec::new();
            for segment in &stump.segments {
                let (skeleton, shaping) = limbs[*segment].clone();
                own.extend(limbs::cut(skeleton, shaping));
            }
            let mut planes = Vec::new();
            let mut thinnest = f64::INFINITY;
            for end in stump.ends {
                let Some(FlatEnd {
                    at,
                    outward,
                    radius,
                }) = function.place_end(end)
                else {
                    continue;
                };
                thinnest = thinnest.min(radius);
                planes.push(Plane {
                    at,
                    inward: -outward,
                });
                let beyond = Skeleton::Segment {
                    base: at,
                    apex: at + outward * (BEYOND * radius),
                };
                let shaping = Shaping {
                    radius,
                    taper: None,
                    ..limbs[stump.segments[0]].1
                };
                own.push((beyond, shaping));
            }
            let field: Sum = own
                .into_iter()
                .filter_map(|(skeleton, shaping)| Primitive::new(skeleton, &shaping, None))
                .collect();
            if let Some(sliced) = Sliced::new(field, planes, STEEPNESS / thinnest) {
                functions.push(Arc::new(sliced));
            }
        }
        functions
    }
}
