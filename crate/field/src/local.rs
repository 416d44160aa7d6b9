//! Local convolution: of a skeleton only the stretch near a point counts, so that its folds do not blend.
//!
//! Along each segment of the skeleton planes sweep from one end to the other, see [`planes`](self::planes). A point lies in some of
//! them; each is a *place* on the skeleton. The field of a place is that of the skeleton within an arc length D of it, which runs
//! through branches into every curve that meets there, and fades towards its ends, see [`window`](self::window). The field at the
//! point is the largest of those of its places, of the skeleton's free ends and of its branches:
//!
//! `F(p) = max W(s, p)`, `W(s, p) = Σᵢ wᵢ(s)·fᵢ(p)`, wᵢ(s) the window's mean over the piece i, fᵢ the piece's field.
//!
//! So each piece keeps its closed form, its taper and its bounds. Pieces are to be short compared with D.
//!
//! **Continuity.** While one place leads, F has a continuous gradient `∇F = W_p + W_s∇s` within the planes of a segment. Where two
//! places tie, and where planes change from one segment to the next (or at a branch), the gradient jumps: by `W_s` times the jump of
//! ∇s there, as W_s counts only what is in the fading parts of the window. The value is continuous but where a place vanishes that
//! leads: where planes of a bend meet, at its centre of curvature or beyond it. [`Local::enclose`] knows all of these: bounds that
//! do not hold are infinite.
//!
//! Bounds, in a ball of radius r for the places `s₀ ≤ s ≤ s₁` whose planes meet it: with `d·(p−r(u)) = 0` we have
//! `∇u = −d/g`, `g = ∂(d·(p−r))/∂u`, and `|∇²u| ≤ (|g_u||∇u|² + 2|d_u||∇u|)/|g|`; wᵢ changes by at most `1.5/δ`, and its
//! derivative by `6/δ²`, and only where a piece is in a fading part.
pub mod graph;
pub mod planes;
pub mod window;

use crate::{Ball, Bound, Enclosure, Implicit, Jet, Kernel, Primitive, Real, THRESHOLD};
use glam::DVec3;
use graph::Graph;
use planes::{Places, Swept};
use std::collections::BTreeMap;
use wide::f32x8;
use window::{Weight, Window};

/// The most pairs of a segment and a piece within its reach.
pub const MOST_LINKS: usize = 1 << 22;

/// A segment of a skeleton, for [`Local::new`].
#[derive(Clone, Debug)]
pub struct Limb {
    /// Numbers of the points at its ends, which it shares with its neighbours.
    pub ends: [u32; 2],
    /// For each end the segment that goes on from it, if one does.
    pub next: [Option<u32>; 2],
    /// Its pieces, one after the other along it, as primitives with their lengths. Their fields are positive.
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

/// The local convolution of a skeleton.
///
/// It has one element, and is its own [`Implicit`]. See the [module](self) for its definition.
#[derive(Clone, Debug)]
pub struct Local {
    window: Window,
    pieces: Vec<Piece>,
    segments: Vec<Segment>,
    links: Vec<Link>,
    /// Ends and branches: a segment, and which of its ends.
    nodes: Vec<(u32, usize)>,
    /// For each point of the skeleton those within twice the reach, and their distances.
    near: Vec<BTreeMap<u32, f64>>,
    /// All pieces, halved again and again: after a group its first half, and where its second one starts.
    tree: Vec<(Group, Node)>,
}

#[derive(Clone, Debug)]
struct Piece {
    primitive: Primitive,
    bound: Bound,
}

#[derive(Clone, Debug)]
struct Segment {
    ends: [u32; 2],
    next: [Option<u32>; 2],
    swept: Swept,
    length: f64,
    /// The links to its own pieces and to all others within reach.
    links: core::ops::Range<usize>,
    /// A ball around all pieces within reach, and bounds on their fields.
    group: Group,
}

/// From a segment to a piece.
#[derive(Clone, Copy, Debug)]
struct Link {
    piece: u32,
    length: f64,
    /// For both ends of the piece their distances from both ends of the segment. A piece of the segment itself: its ends' distances
    /// from the segment's start.
    distances: [[f64; 2]; 2],
    own: bool,
}

/// Some pieces: their field is at most `mass` times the kernel at their distance.
#[derive(Clone, Copy, Debug)]
struct Group {
    ball: Ball,
    mass: f64,
    width: f64,
    kernel: Kernel,
}

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
enum Node {
    /// Pieces.
    Leaf([u32; 2]),
    /// The number of its second half; the first one follows.
    Halves(u32),
}

/// A place on the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The segment.
    pub segment: u32,
    /// Arc length from its start.
    pub along: f64,
}

/// The field of a place.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    place: Place,
    jet: Jet<f64>,
}

/// The fields of the stretches of interest in a ball, see [`Local::two`] for what they are.
#[derive(Clone, Copy, Debug)]
pub struct Two {
    /// The largest stretch.
    pub first: Enclosure,
    /// The largest one that is far from it; `None` if there is none.
    pub second: Option<Enclosure>,
}

/// The places in an interval of a segment whose planes may meet a ball, or an end or a branch.
#[derive(Clone, Debug)]
struct Candidate {
    segment: u32,
    parts: [f64; 2],
    rate: f64,
    /// Bounds on W for all of the places and the ball.
    bounds: Enclosure,
    /// Whether W has been looked at closely.
    known: bool,
    /// Number of the first one of those that go on in each other.
    chain: usize,
    /// Whether the value is continuous in the ball.
    solid: bool,
    /// Whether there is a place for every point of the ball.
    lasting: bool,
    /// Whether it goes on in another interval, where the gradient jumps.
    joined: bool,
}

/// Fields below this are not looked at closely.
const FAINT: f64 = 0.05;
/// Pieces of a leaf of the tree.
const LEAF: usize = 4;
/// A group is opened if its radius is more than this part of its distance.
const NEAR: f64 = 0.35;

impl Group {
    /// An upper bound on its field at a distance from its ball.
    fn most(&self, distance: f64) -> f64 {
        self.mass * self.kernel.value(distance.max(0.0) * self.width)
    }

    fn join(self, other: Self) -> Self {
        Self {
            ball: self.ball.around(&other.ball),
            mass: self.mass + other.mass,
            width: self.width.min(other.width),
            ..self
        }
    }

    /// Distance of a ball from its own.
    fn distance(&self, ball: &Ball) -> f64 {
        (self.ball.center.distance(ball.center) - self.ball.radius - ball.radius).max(0.0)
    }
}

impl Piece {
    fn group(&self) -> Option<Group> {
        let (center, radius) = self.primitive.skeleton.bounding_sphere()?;
        let [mass, width] = self.bound.far();
        Some(Group {
            ball: Ball {
                center,
                radius: radius * (1.0 + 1e-12),
            },
            mass,
            width,
            kernel: self.primitive.kernel,
        })
    }
}

impl Limb {
    fn length(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.1).sum()
    }

    fn is_sound(&self, points: usize) -> bool {
        let [a, b] = self.ends;
        let positive = |(primitive, length): &(Primitive, f64)| {
            let bound = Bound::new(primitive);
            length.is_finite() && *length > 0.0 && !bound.carves() && !bound.has_profile()
        };
        a != b
            && (a.max(b) as usize) < points
            && !self.pieces.is_empty()
            && self.pieces.iter().all(positive)
    }
}

impl Local {
    /// The local convolution of segments between points, with the reach D.
    ///
    /// # Errors
    /// If a number is not usable or too many pieces are within reach of each other.
    pub fn new(points: &[DVec3], limbs: &[Limb], reach: f64) -> Result<Self, LocalError> {
        let count = limbs.len() as u32;
        let follows = |limb: &Limb| limb.next.iter().flatten().all(|next| *next < count);
        let sound = reach.is_finite()
            && reach > 0.0
            && points.iter().all(|p| p.is_finite())
            && limbs
                .iter()
                .all(|limb| limb.is_sound(points.len()) && follows(limb));
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
        let within = distances(&cuts, reach)?;
        let mut local = Self {
            window: Window::new(reach),
            segments: Vec::new(),
            links: Vec::new(),
            nodes: Vec::new(),
            tree: Vec::new(),
            near,
            pieces,
        };
        local.connect(points, limbs, &ends, &within, &groups)?;
        local.plant(&groups, [0, groups.len() as u32]);
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

    /// Makes the tree over some pieces; returns its number.
    fn plant(&mut self, groups: &[Group], [from, to]: [u32; 2]) -> Option<u32> {
        let own = &groups[from as usize..to as usize];
        let group = own.iter().copied().reduce(Group::join)?;
        let number = self.tree.len();
        self.tree.push((group, Node::Leaf([from, to])));
        if own.len() > LEAF {
            let middle = (from + to) / 2;
            self.plant(groups, [from, middle]);
            let second = self.plant(groups, [middle, to])?;
            self.tree[number].1 = Node::Halves(second);
        }
        Some(number as u32)
    }

    /// The reach D.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.window.reach
    }

    /// Bound on the sum of all pieces' fields in a ball, which is no less than the field.
    fn everything(&self, ball: &Ball) -> f64 {
        let mut sum = 0.0;
        let mut waiting = vec![0u32];
        while let Some(number) = waiting.pop() {
            let Some((group, node)) = self.tree.get(number as usize) else {
                continue;
            };
            let distance = group.distance(ball);
            match node {
                _ if group.ball.radius < NEAR * distance => sum += group.most(distance),
                Node::Halves(second) => waiting.extend([*second, number + 1]),
                Node::Leaf([from, to]) => {
                    for piece in &self.pieces[*from as usize..*to as usize] {
                        let near = piece.bound.nearness(ball.center, ball.radius);
                        sum += piece.bound.magnitude(near);
                    }
                }
            }
        }
        sum
    }

    /// Weight of a link for a place on its segment.
    fn weight(&self, segment: &Segment, link: &Link, along: f64) -> Weight {
        if link.own {
            let [[start, _], [end, _]] = link.distances;
            return match along {
                s if s < start => self
                    .window
                    .mean([start - s, end - s], [-1.0; 2], link.length),
                s if s > end => self
                    .window
                    .mean([s - start, s - end], [1.0; 2], link.length),
                s => self.window.mean_around([s - start, end - s], link.length),
            };
        }
        let rest = segment.length - along;
        let ways = link.distances.map(|[from_start, from_end]| {
            let (back, forth) = (along + from_start, rest + from_end);
            if back <= forth {
                (back, 1.0)
            } else {
                (forth, -1.0)
            }
        });
        let [a, b] = ways;
        // An end beyond the reach of both ways is as far as its piece is long.
        let [a, b] = [
            (
                a.0.min(b.0 + link.length),
                if a.0 <= b.0 + link.length { a.1 } else { b.1 },
            ),
            (
                b.0.min(a.0 + link.length),
                if b.0 <= a.0 + link.length { b.1 } else { a.1 },
            ),
        ];
        self.window.mean([a.0, b.0], [a.1, b.1], link.length)
    }

    /// W and its gradient at a place, with the derivative by the place.
    fn stretch(&self, place: Place, point: [f64; 3]) -> (Jet<f64>, f64) {
        let segment = &self.segments[place.segment as usize];
        let (mut sum, mut by_place) = (Jet::zero(), 0.0);
        for link in &self.links[segment.links.clone()] {
            let weight = self.weight(segment, link, place.along);
            if weight.value > 0.0 || weight.slope != 0.0 {
                let jet = self.pieces[link.piece as usize].primitive.jet(point);
                sum = sum.plus(jet.times(weight.value));
                by_place += weight.slope * jet.value;
            }
        }
        (sum, by_place)
    }

    /// F's part of a place of a segment whose plane passes through a point.
    fn swept(&self, number: u32, part: f64, point: DVec3) -> Stretch {
        let segment = &self.segments[number as usize];
        let place = Place {
            segment: number,
            along: part * segment.length,
        };
        let (mut jet, by_place) = self.stretch(place, point.to_array());
        let rate = segment.swept.rate(point, part);
        let turn = segment.swept.normal(part) * (-by_place * segment.length / rate);
        // Where planes meet there is no gradient.
        if turn.is_finite() {
            let turn = turn.to_array();
            jet.gradient = core::array::from_fn(|i| jet.gradient[i] + turn[i]);
        }
        Stretch { place, jet }
    }

    /// The place of an end or a branch.
    fn place_of(&self, (segment, end): (u32, usize)) -> Place {
        let along = if end == 0 {
            0.0
        } else {
            self.segments[segment as usize].length
        };
        Place { segment, along }
    }

    /// Calls `f` with the number of each segment, a part of it and a bound on the field there for all places of a point; ends and
    /// branches are parts beyond 1.
    fn places(&self, point: DVec3) -> Vec<(f64, u32, Option<f64>)> {
        let ball = Ball {
            center: point,
            radius: 0.0,
        };
        let mut found = Vec::new();
        for (number, segment) in (0..).zip(&self.segments) {
            segment.swept.each(point, |part| {
                let most = segment.group.most(segment.group.distance(&ball));
                found.push((most, number, Some(part)));
            });
        }
        for (node, (segment, _)) in (0..).zip(&self.nodes) {
            let group = &self.segments[*segment as usize].group;
            found.push((group.most(group.distance(&ball)), node, None));
        }
        found
    }

    /// Distance along the skeleton between two places; infinite if it is more than 2D.
    #[must_use]
    pub fn distance(&self, a: Place, b: Place) -> f64 {
        let (first, second) = (
            &self.segments[a.segment as usize],
            &self.segments[b.segment as usize],
        );
        let mut least = f64::INFINITY;
        if a.segment == b.segment {
            least = (a.along - b.along).abs();
        }
        for (i, here) in [a.along, first.length - a.along].into_iter().enumerate() {
            for (k, there) in [b.along, second.length - b.along].into_iter().enumerate() {
                let between = self.near[first.ends[i] as usize].get(&second.ends[k]);
                least = least.min(here + there + between.copied().unwrap_or(f64::INFINITY));
            }
        }
        least
    }

    /// The largest stretch at a point, and the largest one more than 2D away from it along the skeleton.
    fn two_at(&self, point: DVec3, both: bool) -> [Option<Stretch>; 2] {
        let mut places = self.places(point);
        // Those of the nearest skeleton first, so that most others need not be evaluated.
        let near = |&(_, number, part): &(f64, u32, Option<f64>)| {
            let at = match part {
                Some(part) => self.segments[number as usize].swept.at(part),
                None => {
                    let (segment, end) = self.nodes[number as usize];
                    self.segments[segment as usize].swept.at(end as f64)
                }
            };
            at.distance_squared(point)
        };
        let mut order: Vec<(f64, usize)> = places.iter().map(near).zip(0..).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut known: Vec<Option<Stretch>> = vec![None; places.len()];
        let evaluate = |(_, number, part): (f64, u32, Option<f64>)| match part {
            Some(part) => self.swept(number, part, point),
            None => {
                let place = self.place_of(self.nodes[number as usize]);
                let (jet, _) = self.stretch(place, point.to_array());
                Stretch { place, jet }
            }
        };
        let mut first: Option<Stretch> = None;
        for &(_, i) in &order {
            if first.is_none_or(|first| places[i].0 >= first.jet.value) {
                let stretch = evaluate(places[i]);
                known[i] = Some(stretch);
                if first.is_none_or(|first| stretch.jet.value > first.jet.value) {
                    first = Some(stretch);
                }
            }
        }
        let (Some(leader), true) = (first, both) else {
            return [first, None];
        };
        let mut second: Option<Stretch> = None;
        let far = 2.0 * self.window.reach;
        for &(_, i) in &order {
            let place = match (places[i].1, places[i].2) {
                (segment, Some(part)) => Place {
                    segment,
                    along: part * self.segments[segment as usize].length,
                },
                (node, None) => self.place_of(self.nodes[node as usize]),
            };
            if self.distance(leader.place, place) <= far {
                places[i].0 = f64::NEG_INFINITY;
                continue;
            }
            if second.is_none_or(|second| places[i].0 >= second.jet.value) {
                let stretch = known[i].unwrap_or_else(|| evaluate(places[i]));
                if second.is_none_or(|second| stretch.jet.value > second.jet.value) {
                    second = Some(stretch);
                }
            }
        }
        [first, second]
    }

    /// Value and gradient of the largest stretch at a point, and of the largest one more than 2D away from it along the skeleton, if
    /// there is one.
    #[must_use]
    pub fn two(&self, point: DVec3) -> (Jet<f64>, Option<Jet<f64>>) {
        let [first, second] = self.two_at(point, true);
        let jet = |stretch: Stretch| stretch.jet;
        (first.map_or_else(Jet::zero, jet), second.map(jet))
    }
}

/// The normal of the plane at an end of a limb: half-way to the direction of the one that goes on there, else its own direction.
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

impl Local {
    /// Bounds on W for the places of a candidate in a ball.
    fn bounded(&self, candidate: &Candidate, ball: &Ball) -> Enclosure {
        let segment = &self.segments[candidate.segment as usize];
        let [low, high] = candidate.parts;
        let mut middle = 0.5 * (low + high);
        segment.swept.each(ball.center, |part| {
            if part >= low && part <= high {
                middle = part;
            }
        });
        let along = middle * segment.length;
        let span = (high - middle).max(middle - low) * segment.length;
        let point = ball.center.to_array();
        let [steep, bent] = self.window.steepest();
        let (mut value, mut slope, mut curvature) = (0.0, 0.0, 0.0);
        // By the place, twice by the place, and by the place and the point.
        let (mut by_place, mut by_places, mut mixed) = (0.0, 0.0, 0.0);
        for link in &self.links[segment.links.clone()] {
            let [nearest, farthest] = self.reach_of(segment, link, along);
            if nearest - span >= self.window.reach {
                continue;
            }
            let weight = self.weight(segment, link, along);
            let piece = &self.pieces[link.piece as usize];
            let near = piece.bound.nearness(ball.center, ball.radius);
            let steepness = piece.bound.slope(near);
            slope += steepness;
            curvature += piece.bound.curvature(near);
            if weight.value > 0.0 {
                value += weight.value * piece.primitive.value(point);
            }
            if farthest + span > self.window.flat() {
                let most = piece.bound.magnitude(near);
                by_place += steep * most;
                // More where both ways to a piece are equally long.
                by_places += (bent + 2.0 * steep / link.length) * most;
                mixed += steep * steepness;
            }
        }
        let change = slope * ball.radius + if span > 0.0 { by_place * span } else { 0.0 };
        let change = if change.is_nan() {
            f64::INFINITY
        } else {
            change
        };
        // ∇s and ∇²s; an end stays where it is.
        let [turn, bend] = segment.swept.bends();
        let first = 1.0 / candidate.rate.abs();
        let second = (bend.abs() * first + 2.0 * turn) * first * first;
        let [once, twice] = [first, second].map(|turned| turned * segment.length);
        let times = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        Enclosure {
            value: [
                (value - change).max(0.0),
                (value + change).min(candidate.bounds.value[1]),
            ],
            slope: slope + times(by_place, once),
            curvature: curvature
                + 2.0 * times(mixed, once)
                + times(by_places, once * once)
                + times(by_place, twice),
        }
    }

    /// The least and the largest distance of a piece's points from a place of a segment, within the two ways to it.
    fn reach_of(&self, segment: &Segment, link: &Link, along: f64) -> [f64; 2] {
        if link.own {
            let [[start, _], [end, _]] = link.distances;
            let far = (along - start).abs().max((along - end).abs());
            let near = (start - along).max(along - end).max(0.0);
            return [near, far];
        }
        let rest = segment.length - along;
        let [a, b] = link.distances.map(|[s, e]| (along + s).min(rest + e));
        let near = a.min(b);
        [near, near + link.length]
    }

    /// The candidates of a ball, with rough bounds.
    fn candidates(&self, ball: &Ball) -> Vec<Candidate> {
        let mut found: Vec<Candidate> = Vec::new();
        // Which intervals reach an end of their segment: segment, end, interval.
        let mut touching: Vec<(u32, usize, usize)> = Vec::new();
        for (number, segment) in (0..).zip(&self.segments) {
            segment.swept.each_in(*ball, |Places { parts, rate }| {
                let at = found.len();
                if parts[0] <= 0.0 {
                    touching.push((number, 0, at));
                }
                if parts[1] >= 1.0 {
                    touching.push((number, 1, at));
                }
                found.push(Candidate {
                    segment: number,
                    parts,
                    rate,
                    bounds: rough(&segment.group, ball),
                    known: false,
                    chain: at,
                    solid: rate != 0.0,
                    lasting: rate != 0.0,
                    joined: false,
                });
            });
        }
        self.join(&mut found, &touching);
        for &(number, end) in &self.nodes {
            found.push(Candidate {
                segment: number,
                parts: [end as f64; 2],
                rate: f64::INFINITY,
                bounds: rough(&self.segments[number as usize].group, ball),
                known: false,
                chain: found.len(),
                solid: true,
                lasting: true,
                joined: false,
            });
        }
        found
    }

    /// Tells candidates that go on in each other: a place passes from one to the other as the point moves, if their planes turn
    /// alike.
    fn join(&self, found: &mut [Candidate], touching: &[(u32, usize, usize)]) {
        for &(number, end, at) in touching {
            let segment = &self.segments[number as usize];
            let Some(next) = segment.next[end] else {
                // Where the place leaves its segment, the end is a candidate that is as large.
                found[at].lasting = false;
                continue;
            };
            let other = self.segments.get(next as usize);
            let there = other.map_or(0, |o| usize::from(o.ends[0] != segment.ends[end]));
            let beyond = touching.iter().find(|t| (t.0, t.1) == (next, there));
            found[at].joined = true;
            match beyond.map(|t| t.2) {
                Some(beyond) if found[at].rate * found[beyond].rate > 0.0 => {
                    let [a, b] = [found[at].chain, found[beyond].chain];
                    let (first, other) = (a.min(b), a.max(b));
                    for candidate in found.iter_mut().filter(|c| c.chain == other) {
                        candidate.chain = first;
                    }
                }
                _ => found[at].solid = false,
            }
        }
        let broken = |found: &[Candidate], of: fn(&Candidate) -> bool| -> Vec<usize> {
            let broken = found.iter().filter(|c| !of(c));
            broken.map(|c| c.chain).collect()
        };
        let (loose, passing) = (broken(found, |c| c.solid), broken(found, |c| c.lasting));
        for candidate in found {
            candidate.solid &= !loose.contains(&candidate.chain);
            candidate.lasting &= candidate.solid && !passing.contains(&candidate.chain);
        }
    }

    /// Looks closely at a candidate.
    fn look(&self, candidate: &mut Candidate, ball: &Ball) {
        if candidate.known {
            return;
        }
        let bounds = self.bounded(candidate, ball);
        let unless = |not: bool, bound: f64| if not { f64::INFINITY } else { bound };
        candidate.known = true;
        candidate.bounds = Enclosure {
            value: bounds.value,
            slope: unless(!candidate.solid, bounds.slope),
            curvature: unless(!candidate.solid || candidate.joined, bounds.curvature),
        };
    }

    /// Bounds on the largest stretch in a ball and, if asked for, on the largest one more than 2D away from it along the skeleton.
    #[must_use]
    pub fn enclose_two(&self, ball: Ball, both: bool) -> Two {
        let everything = self.everything(&ball);
        let faint = |most: f64| Enclosure {
            value: [0.0, most],
            slope: f64::INFINITY,
            curvature: f64::INFINITY,
        };
        if everything < FAINT {
            return Two {
                first: faint(everything),
                second: both.then(|| faint(everything)),
            };
        }
        let [first, second] = self.two_at(ball.center, both);
        let mut all = self.candidates(&ball);
        if let Some(Stretch { place, .. }) = first {
            for candidate in all.iter_mut().filter(|c| c.segment == place.segment) {
                self.look(candidate, &ball);
            }
        }
        let floor = least(&all, |_| true);
        for candidate in &mut all {
            if candidate.bounds.value[1] >= if both { FAINT.min(floor) } else { floor } {
                self.look(candidate, &ball);
            }
        }
        let leaders = Leaders::of(&all, |_| true);
        let mut own = leaders.bounds(&all);
        own.value[1] = own.value[1].min(everything);
        let about = |own: Enclosure, stretch: Option<Stretch>| match stretch {
            Some(stretch) => own.about(&stretch.jet, ball.radius),
            None => own,
        };
        Two {
            first: about(own, first),
            second: both
                .then(|| self.second(&all, &leaders))
                .flatten()
                .map(|own| about(own, second)),
        }
    }

    /// Bounds on the largest stretch that is far from those that lead; `None` if there is none anywhere.
    fn second(&self, all: &[Candidate], leaders: &Leaders) -> Option<Enclosure> {
        let far = 2.0 * self.window.reach;
        let apart = |a: &Candidate, b: &Candidate| {
            if a.chain == b.chain {
                return [0.0; 2];
            }
            let place = |c: &Candidate| {
                let length = self.segments[c.segment as usize].length;
                let along = 0.5 * (c.parts[0] + c.parts[1]) * length;
                let segment = c.segment;
                (
                    Place { segment, along },
                    0.5 * (c.parts[1] - c.parts[0]) * length,
                )
            };
            let ((a, half_a), (b, half_b)) = (place(a), place(b));
            let distance = self.distance(a, b);
            [distance - half_a - half_b, distance + half_a + half_b]
        };
        let lead = || leaders.members.iter().map(|i| &all[*i]);
        let may = |c: &Candidate| lead().any(|leader| apart(c, leader)[1] > far);
        if !all.iter().any(may) {
            return None;
        }
        let surely = |leader: &Candidate| least(all, |c| apart(c, leader)[0] > far);
        let floor = lead().map(surely).fold(f64::INFINITY, f64::min);
        let seconds = Leaders::above(all, floor, may);
        let mut own = seconds.bounds(all);
        own.value[0] = floor;
        let sharp = seconds.members.iter().all(|i| {
            lead().all(|leader| all[*i].chain == leader.chain || apart(&all[*i], leader)[0] > far)
        });
        if !sharp || floor <= 0.0 && seconds.members.iter().any(|i| !all[*i].known) {
            own.slope = f64::INFINITY;
            own.curvature = f64::INFINITY;
        }
        if leaders.members.len() > 1 {
            own.curvature = f64::INFINITY;
        }
        Some(own)
    }
}

/// Bounds that need no look at single pieces.
fn rough(group: &Group, ball: &Ball) -> Enclosure {
    Enclosure {
        value: [0.0, group.most(group.distance(ball))],
        slope: f64::INFINITY,
        curvature: f64::INFINITY,
    }
}

/// A lower bound on the largest of some candidates: one that is there for every point of the ball, with all that it goes on in.
fn least(all: &[Candidate], of: impl Fn(&Candidate) -> bool) -> f64 {
    let mut floor = 0.0f64;
    for candidate in all.iter().filter(|c| c.lasting && c.known && of(c)) {
        let mut chain = all.iter().filter(|c| c.chain == candidate.chain);
        let whole = chain.clone().all(|c| c.known && of(c));
        let lowest = chain.try_fold(f64::INFINITY, |low, c| Some(low.min(c.bounds.value[0])));
        if let (true, Some(lowest)) = (whole, lowest) {
            floor = floor.max(lowest);
        }
    }
    floor
}

/// Those of some candidates that may be the largest.
struct Leaders {
    floor: f64,
    members: Vec<usize>,
}

impl Leaders {
    fn of(all: &[Candidate], of: impl Fn(&Candidate) -> bool) -> Self {
        Self::above(all, least(all, &of), of)
    }

    fn above(all: &[Candidate], floor: f64, of: impl Fn(&Candidate) -> bool) -> Self {
        let members = (0..all.len()).filter(|i| all[*i].bounds.value[1] >= floor && of(&all[*i]));
        Self {
            floor,
            members: members.collect(),
        }
    }

    fn bounds(&self, all: &[Candidate]) -> Enclosure {
        let mut own = Enclosure {
            value: [self.floor, self.floor],
            ..Enclosure::ZERO
        };
        for candidate in self.members.iter().map(|i| &all[*i]) {
            own.value[1] = own.value[1].max(candidate.bounds.value[1]);
            own.slope = own.slope.max(candidate.bounds.slope);
            own.curvature = own.curvature.max(candidate.bounds.curvature);
        }
        if self.members.len() > 1 {
            own.curvature = f64::INFINITY;
        }
        own
    }
}

impl Implicit for Local {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        let [first, _] = self.two_at(point, false);
        first.map_or_else(Jet::zero, |stretch| stretch.jet)
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        narrow(self.jet(DVec3::from_array(point.map(f64::from))))
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        lanes(points, |point| self.jet32(point))
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        self.enclose_two(ball, false).first
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        let [Some(Stretch { place, .. }), _] = self.two_at(point, false) else {
            return;
        };
        let (jet, _) = self.stretch(place, point.to_array());
        out.push((0, jet.value));
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        // Where no piece has more than its share of the level; a stretch has as many as a segment has links.
        let most = self.segments.iter().map(|s| s.links.len()).max()?;
        let share = level / most as f64;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for piece in &self.pieces {
            let (center, around) = piece.primitive.skeleton.bounding_sphere()?;
            let reach = around + piece.bound.distance_of(share);
            (low, high) = (low.min(center - reach), high.max(center + reach));
        }
        Some(Ball {
            center: 0.5 * (low + high),
            radius: 0.5 * low.distance(high),
        })
    }
}

/// A jet in single precision.
#[must_use]
pub fn narrow(jet: Jet<f64>) -> Jet<f32> {
    Jet {
        value: jet.value as f32,
        gradient: jet.gradient.map(|x| x as f32),
    }
}

/// Jets at eight points, one after the other.
#[must_use]
pub fn lanes(points: [f32x8; 3], jet: impl Fn([f32; 3]) -> Jet<f32>) -> Jet<f32x8> {
    let points = points.map(|x| x.to_array());
    let at = |i: usize| jet(core::array::from_fn(|k| points[k][i]));
    let jets: [Jet<f32>; 8] = core::array::from_fn(at);
    Jet {
        value: f32x8::from_lanes(|i| f64::from(jets[i].value)),
        gradient: core::array::from_fn(|k| f32x8::from_lanes(|i| f64::from(jets[i].gradient[k]))),
    }
}
