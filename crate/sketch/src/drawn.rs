//! The skeletons of the compiled text, as places in the picture where the user draws.

use crate::Block;
use crate::Sight;
use emath::{Pos2, Vec2};
use glam::{DAffine3, DVec3};
use rats::{Compiled, Project};
use scene::{Form, Shape};
use skeleton::{Node, Scheme, Skeleton};
use std::ops::Range;

/// Most skeletons that are drawn on: a loop may make thousands.
const MOST: usize = 200;

/// A `skeleton` command of the text. Places are in the world, unless they are the skeleton's own.
pub struct Drawn {
    /// Index of the element.
    pub element: usize,
    /// Index of the file.
    pub file: usize,
    /// Bytes of the command.
    pub span: Range<usize>,
    /// The command's block; `None` if drawing cannot change it, as a loop or an instance made it.
    pub block: Option<Block>,
    /// Nodes and curves in coordinates of its own.
    pub skeleton: Skeleton,
    /// Map from those to the world.
    pub to_world: DAffine3,
    /// Factor by which the map enlarges radii.
    pub growth: f64,
    /// The colour of its material.
    pub colour: scene::Rgb,
    /// The place at which each node is held, on its curve if possible, and how far the node moves
    /// for that place to move by 1.
    pub knobs: Vec<(DVec3, f64)>,
    /// The refined curves' points with their radii.
    points: Vec<(DVec3, f64)>,
    pieces: Vec<Piece>,
    /// The number of curves' segments that meet at each node: 1 at a free end.
    meetings: Vec<usize>,
}

/// A piece of a refined curve.
struct Piece {
    /// Indices of the points.
    ends: [usize; 2],
    curve: usize,
    span: usize,
    /// Places of the ends between the two nodes, 0 … 1.
    shares: [f64; 2],
}

/// A place on a skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The skeleton's index.
    pub drawn: usize,
    /// The curve.
    pub curve: usize,
    /// The place is between the curve's node of this number and the next.
    pub span: usize,
    /// Place between them, 0 … 1.
    pub share: f64,
    /// The place on the curve.
    pub place: DVec3,
    /// The radius there.
    pub radius: f64,
    /// The place on the flesh around it that is seen.
    pub surface: DVec3,
    /// Distance of the curve from the pointer, points of the screen.
    pub off: f32,
}

impl Drawn {
    /// Finds the skeletons of a compiled text, at most [`MOST`].
    #[must_use]
    pub fn all(project: &Project, compiled: &Compiled) -> Vec<Self> {
        let scene = &compiled.scene;
        let elements = scene.elements.iter().zip(&compiled.placements).enumerate();
        let mut all: Vec<Self> = Vec::new();
        for (element, (shape, placement)) in elements {
            let Shape::Function(function) = &shape.shape else {
                continue;
            };
            let Form::Skeleton(curves) = &function.form else {
                continue;
            };
            let Some(polyline) = curves.polyline() else {
                continue;
            };
            if all.len() >= MOST {
                break;
            }
            let origin = shape.origin;
            let (file, span) = (
                origin.file as usize,
                origin.start as usize..origin.end as usize,
            );
            let text = project.files.get(file).map_or("", |file| &file.text);
            let block = Block::read(text, span.clone())
                .filter(|block| !placement.repeated && is_of(block, &curves.skeleton));
            let to_world = function.to_world;
            let growth = placement.growth;
            let points: Vec<_> = polyline
                .vertices
                .iter()
                .map(|v| (to_world.transform_point3(v.position), v.radius * growth))
                .collect();
            let mut pieces: Vec<Piece> = Vec::new();
            let spans = polyline
                .segments
                .chunk_by(|s, t| (s.curve, s.span) == (t.curve, t.span));
            for span in spans {
                for (i, segment) in span.iter().enumerate() {
                    pieces.push(Piece {
                        ends: segment.ends,
                        curve: segment.curve,
                        span: segment.span,
                        shares: [i, i + 1].map(|i| i as f64 / span.len() as f64),
                    });
                }
            }
            let mut meetings = vec![0; curves.skeleton.nodes.len()];
            for along in &curves.skeleton.curves {
                for ends in along.windows(2) {
                    meetings[ends[0]] += 1;
                    meetings[ends[1]] += 1;
                }
            }
            let colour = scene
                .finishes
                .get(shape.finish as usize)
                .map_or([0.5; 3], |finish| finish.diffuse);
            let mut drawn = Self {
                element,
                file,
                span,
                block,
                skeleton: curves.skeleton.clone(),
                to_world,
                growth,
                colour,
                knobs: Vec::new(),
                points,
                pieces,
                meetings,
            };
            drawn.knobs = drawn.knobs_of(curves.scheme);
            all.push(drawn);
        }
        all
    }

    /// Returns [`Self::knobs`].
    fn knobs_of(&self, scheme: Scheme) -> Vec<(DVec3, f64)> {
        let nodes = &self.skeleton.nodes;
        let mut knobs: Vec<_> = nodes
            .iter()
            .map(|node| (self.to_world.transform_point3(node.position), 1.0))
            .collect();
        if scheme != Scheme::Cubic {
            return knobs;
        }
        // A node within a curve attracts it: the limit's point there is (a + 4b + c) / 6.
        for (number, along) in self.skeleton.curves.iter().enumerate() {
            for (i, &node) in along.iter().enumerate().take(along.len() - 1).skip(1) {
                let is_alone = self.meetings[node] == 2;
                let piece = self
                    .pieces
                    .iter()
                    .find(|piece| (piece.curve, piece.span) == (number, i));
                if let Some(piece) = piece.filter(|_| is_alone) {
                    knobs[node] = (self.points[piece.ends[0]].0, 1.5);
                }
            }
        }
        knobs
    }

    /// Whether a node is an open end: one curve ends there and nothing goes on, except for limbs
    /// beside the mirror x = 0 if the curve lies in it.
    #[must_use]
    pub fn is_end(&self, node: usize) -> bool {
        self.before(node).is_some()
    }

    /// Returns the node before an open end; `None` if the node is no open end.
    #[must_use]
    pub fn before(&self, node: usize) -> Option<usize> {
        let pairs = self
            .skeleton
            .curves
            .iter()
            .flat_map(|along| along.windows(2));
        let beside = pairs.filter_map(|ends| match (ends[0] == node, ends[1] == node) {
            (true, false) => Some(ends[1]),
            (false, true) => Some(ends[0]),
            _ => None,
        });
        let is_flat = self.is_flat(node);
        let mut along =
            beside.filter(|other| self.meetings[node] == 1 || is_flat && self.is_flat(*other));
        let before = along.next();
        before.filter(|_| along.next().is_none())
    }

    /// Whether a node lies in the mirror x = 0.
    #[must_use]
    pub fn is_flat(&self, node: usize) -> bool {
        let own = self.skeleton.nodes[node];
        own.position.x.abs() <= 0.05 * own.radius
    }

    /// Returns a node's radius in the world.
    #[must_use]
    pub fn radius(&self, node: usize) -> f64 {
        self.skeleton.nodes[node].radius * self.growth
    }

    /// Returns the refined curves' pieces, each as two points with their radii.
    pub fn limbs(&self) -> impl Iterator<Item = [(DVec3, f64); 2]> + '_ {
        self.pieces
            .iter()
            .map(|piece| piece.ends.map(|end| self.points[end]))
    }

    /// Returns the pieces of a curve, each as two points with their radii.
    pub fn limbs_of(&self, curve: usize) -> impl Iterator<Item = [(DVec3, f64); 2]> + '_ {
        self.pieces
            .iter()
            .filter(move |piece| piece.curve == curve)
            .map(|piece| piece.ends.map(|end| self.points[end]))
    }

    /// Returns the middle of the box around all points.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (point, _) in &self.points {
            (low, high) = (low.min(*point), high.max(*point));
        }
        if low.is_finite() && high.is_finite() {
            0.5 * (low + high)
        } else {
            DVec3::ZERO
        }
    }

    /// Maps a place of the world to coordinates of the skeleton.
    #[must_use]
    pub fn to_own(&self, place: DVec3) -> DVec3 {
        self.to_world.inverse().transform_point3(place)
    }

    /// Returns the node nearest to a place in coordinates of the skeleton, within `reach`.
    #[must_use]
    pub fn node_near(&self, own: DVec3, reach: f64) -> Option<usize> {
        let nodes = self.skeleton.nodes.iter().enumerate();
        let near = nodes.map(|(i, node)| (node.position.distance(own), i));
        near.filter(|(distance, _)| *distance <= reach)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, i)| i)
    }

    /// Returns the place on the curves that is nearest to one in the world, within `reach`.
    #[must_use]
    pub fn spot_near(&self, index: usize, place: DVec3, reach: f64) -> Option<Spot> {
        let mut best: Option<(f64, Spot)> = None;
        for piece in &self.pieces {
            let [(a, r), (b, s)] = piece.ends.map(|end| self.points[end]);
            let along = b - a;
            let square = along.length_squared();
            let t = if square > 0.0 {
                ((place - a).dot(along) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let on = a + along * t;
            let distance = on.distance(place);
            if distance <= reach && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                let spot = Spot {
                    drawn: index,
                    curve: piece.curve,
                    span: piece.span,
                    share: piece.shares[0] + (piece.shares[1] - piece.shares[0]) * t,
                    place: on,
                    radius: r + (s - r) * t,
                    surface: on,
                    off: 0.0,
                };
                best = Some((distance, spot));
            }
        }
        best.map(|(_, spot)| spot)
    }

    /// Returns the node that a spot is so near to that it counts as the node.
    #[must_use]
    pub fn node_at_spot(&self, spot: &Spot) -> Option<usize> {
        let along = self.skeleton.curves.get(spot.curve)?;
        let ends = [*along.get(spot.span)?, *along.get(spot.span + 1)?];
        let node = if spot.share < 0.5 { ends[0] } else { ends[1] };
        let (knob, factor) = self.knobs[node];
        // At a node beside its curve a branch would pull the curve aside.
        let beside = self
            .to_world
            .transform_point3(self.skeleton.nodes[node].position)
            .distance(knob);
        let near = knob.distance(spot.place) <= 0.6 * spot.radius;
        (near && (factor == 1.0 || beside < 0.25 * spot.radius)).then_some(node)
    }

    /// Returns a new node at a spot, in coordinates of the skeleton.
    #[must_use]
    pub fn node_of(&self, spot: &Spot) -> Node {
        Node {
            position: self.to_own(spot.place),
            radius: spot.radius / self.growth.max(f64::MIN_POSITIVE),
        }
    }
}

/// Whether a block may have made a skeleton: they have as many nodes and curves.
fn is_of(block: &Block, skeleton: &Skeleton) -> bool {
    block.nodes.len() == skeleton.nodes.len() && block.curves.len() == skeleton.curves.len()
}

/// Returns skeleton and node of the knob nearest to a place of the screen, within `reach` points.
/// With `ends` only open ends count, each of which reaches at least as far as half of its flesh.
#[must_use]
pub fn node_at(
    all: &[Drawn],
    sight: &Sight,
    at: Pos2,
    reach: f32,
    ends: bool,
) -> Option<(usize, usize)> {
    let mut best: Option<(f32, (usize, usize))> = None;
    for (index, drawn) in all.iter().enumerate() {
        if drawn.block.is_none() {
            continue;
        }
        for (node, (knob, _)) in drawn.knobs.iter().enumerate() {
            if ends && !drawn.is_end(node) {
                continue;
            }
            let Some(seen) = sight.screen(*knob) else {
                continue;
            };
            let flesh = (drawn.radius(node) / sight.point(*knob)) as f32;
            let reach = if ends { reach.max(0.5 * flesh) } else { reach };
            let distance = seen.distance(at);
            if distance <= reach && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, (index, node)));
            }
        }
    }
    best.map(|(_, found)| found)
}

/// Returns the place of a curve whose flesh is seen at a place of the screen, the nearest to the
/// eye; else that of the nearest flesh at most `extra` points beside it.
#[must_use]
pub fn spot_at(all: &[Drawn], sight: &Sight, at: Pos2, extra: f32) -> Option<Spot> {
    let mut best: Option<((bool, f64), Spot)> = None;
    for (index, drawn) in all.iter().enumerate() {
        for piece in &drawn.pieces {
            let [(a, r), (b, s)] = piece.ends.map(|end| drawn.points[end]);
            let (Some(p), Some(q)) = (sight.screen(a), sight.screen(b)) else {
                continue;
            };
            let (t, off) = nearest(p, q, at);
            let t = f64::from(t);
            let place = a + (b - a) * t;
            let radius = r + (s - r) * t;
            let point = sight.point(place);
            let flesh = (radius / point) as f32;
            if off > flesh + extra {
                continue;
            }
            let is_inside = off <= flesh;
            // Distance from the curve's place to the surface of a ball around it, towards the eye.
            let bulge = f64::from((flesh * flesh - off * off).max(0.0).sqrt()) * point;
            let depth = sight.depth(place) - bulge;
            let rank = (
                !is_inside,
                if is_inside {
                    depth
                } else {
                    f64::from(off - flesh)
                },
            );
            if best
                .as_ref()
                .is_none_or(|(least, _)| (rank.0, rank.1) < (least.0, least.1))
            {
                let ray = sight.direction(at);
                let axis = -sight.projection.world_from_view.z_axis;
                let surface =
                    sight.projection.eye + ray * (depth / ray.dot(axis).max(1e-6)).max(0.0);
                let spot = Spot {
                    drawn: index,
                    curve: piece.curve,
                    span: piece.span,
                    share: piece.shares[0] + (piece.shares[1] - piece.shares[0]) * t,
                    place,
                    radius,
                    surface,
                    off,
                };
                best = Some((rank, spot));
            }
        }
    }
    best.map(|(_, spot)| spot)
}

/// Returns the place at which a line across the screen first crosses a curve that drawing can
/// change.
#[must_use]
pub fn crossing(all: &[Drawn], sight: &Sight, line: &[Pos2]) -> Option<Spot> {
    for ends in line.windows(2) {
        let mut best: Option<(f64, Spot)> = None;
        for (index, drawn) in all.iter().enumerate() {
            if drawn.block.is_none() {
                continue;
            }
            for piece in &drawn.pieces {
                let [(a, r), (b, s)] = piece.ends.map(|end| drawn.points[end]);
                let (Some(p), Some(q)) = (sight.screen(a), sight.screen(b)) else {
                    continue;
                };
                let Some(t) = intersect(p, q, ends[0], ends[1]) else {
                    continue;
                };
                let t = f64::from(t);
                let place = a + (b - a) * t;
                let depth = sight.depth(place);
                if best.as_ref().is_none_or(|(least, _)| depth < *least) {
                    let spot = Spot {
                        drawn: index,
                        curve: piece.curve,
                        span: piece.span,
                        share: piece.shares[0] + (piece.shares[1] - piece.shares[0]) * t,
                        place,
                        radius: r + (s - r) * t,
                        surface: place,
                        off: 0.0,
                    };
                    best = Some((depth, spot));
                }
            }
        }
        if let Some((_, spot)) = best {
            return Some(spot);
        }
    }
    None
}

/// Returns the place on a line nearest to a point, 0 … 1, and the distance.
fn nearest(p: Pos2, q: Pos2, at: Pos2) -> (f32, f32) {
    let along = q - p;
    let square = along.length_sq();
    let t = if square > 0.0 {
        ((at - p).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (t, at.distance(p + along * t))
}

fn cross(u: Vec2, v: Vec2) -> f32 {
    u.x * v.y - u.y * v.x
}

/// Returns the place on the line from p to q, 0 … 1, at which the one from a to b crosses it.
fn intersect(p: Pos2, q: Pos2, a: Pos2, b: Pos2) -> Option<f32> {
    let (along, other) = (q - p, b - a);
    let slope = cross(along, other);
    if slope == 0.0 {
        return None;
    }
    let t = cross(a - p, other) / slope;
    let u = cross(a - p, along) / slope;
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some(t)
}
