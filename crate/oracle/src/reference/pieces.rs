//! Bounds of the reference on the field in a ball, from bones cut into pieces, each in a ball of
//! its own.
//!
//! A piece is at least as far from a point as its ball's near side and at most as far as its far
//! side, so that its part of the field, its slope and its curvature are at most the piece's mass
//! times those of the kernel in that shell ([`largest`]). A piece whose ball is large compared to
//! its distance is halved. Halves are made at first use and kept.
use super::shell::largest;
use super::waves::Factor;
use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton};
use glam::DVec3;

/// Bounds on magnitudes of some terms of the field in a ball.
#[derive(Clone, Copy, Debug, Default)]
pub struct Magnitudes {
    /// Bound on the sum of the positive terms.
    pub above: f64,
    /// Bound on the sum of the sizes of the negative terms.
    pub below: f64,
    /// Bound on the first derivative in any direction (where no profile jumps).
    pub slope: f64,
    /// Bound on the second derivative in any direction (where all profiles are smooth).
    pub curvature: f64,
}

/// A part of a bone.
#[derive(Clone, Debug)]
enum Piece {
    Point(DVec3),
    Line(DVec3, DVec3),
    /// Centre, axes as long as the radius, angles.
    Arc(DVec3, [DVec3; 2], [f64; 2]),
    Triangle([DVec3; 3]),
    Curve([DVec3; 4]),
    /// A part of another bone.
    Part(Skeleton),
    /// A square of a polygon's plane: centre, half its sides, and whether all of it is in the
    /// polygon.
    Cell(DVec3, [DVec3; 2], bool),
}

#[derive(Clone, Debug)]
struct Node {
    piece: Piece,
    center: DVec3,
    radius: f64,
    /// Length or area.
    measure: f64,
    /// Start and end on the bone, as fractions of its length.
    share: [f64; 2],
    /// Smallest and largest width parameter.
    widths: [f64; 2],
    /// Largest |height|.
    height: f64,
    depth: u8,
    /// First part and number of parts; [`UNCUT`] until they are made.
    parts: (u32, u32),
}

/// Number in place of the first part of a node whose parts are not made yet.
const UNCUT: u32 = u32::MAX;

/// Largest number of halvings: kernels with a pole need balls as small as 10⁻⁵.
const DEEPEST_PIECE: u8 = 48;
/// Ratio of a ball's radius to its distance up to which the ball is small enough.
const SMALL_BALL: f64 = 0.2;
/// Ratio of a ball's radius to the kernel's width up to which the ball is small enough, unless the
/// kernel has a pole.
const SMALL_WIDTH: f64 = 0.08;
/// Most pieces of all bones together.
const MOST_PIECES: usize = 1 << 21;
/// Factor on bounds for their rounding, and for tapers, which are fitted within 10⁻⁹.
const BOUND_SLACK: f64 = 1.0 + 1e-6;

/// A term of the field.
#[derive(Clone, Debug)]
struct Body {
    kernel: Kernel,
    adds: bool,
    factor: Factor,
    taper: Option<Shaping>,
    skeleton: Skeleton,
    /// The bone's first piece; `None` for a plane.
    root: Option<u32>,
    /// Normal and first pieces of the edges, for a triangle or a polygon.
    rim: Option<(DVec3, Vec<u32>)>,
    primitive: usize,
}

/// The pieces of all terms.
#[derive(Clone, Debug)]
pub struct Pieces {
    bodies: Vec<Body>,
    nodes: Vec<Node>,
    stack: Vec<u32>,
}

impl Pieces {
    /// Prepares these primitives.
    pub fn new(primitives: &[Primitive]) -> Self {
        let mut pieces = Self {
            bodies: Vec::new(),
            nodes: Vec::new(),
            stack: Vec::new(),
        };
        for (number, p) in primitives.iter().enumerate() {
            let piece = match &p.skeleton {
                Skeleton::Point { center } => Some(Piece::Point(*center)),
                Skeleton::Segment { base, apex } => Some(Piece::Line(*base, *apex)),
                Skeleton::Arc {
                    center,
                    u,
                    v,
                    radius,
                    angle,
                } => {
                    let x = u.try_normalize().unwrap_or(DVec3::X);
                    let y = (*v - x * x.dot(*v))
                        .try_normalize()
                        .unwrap_or_else(|| x.any_orthonormal_vector());
                    let turn = [0.0, angle.clamp(0.0, core::f64::consts::TAU)];
                    Some(Piece::Arc(*center, [x * *radius, y * *radius], turn))
                }
                Skeleton::Triangle { corners } => Some(Piece::Triangle(*corners)),
                Skeleton::Curve { control } => Some(Piece::Curve(*control)),
                Skeleton::Polygon { rings } => Some(around(rings)),
                other => other.bounding_sphere().map(|_| Piece::Part(other.clone())),
            };
            let mut body = Body {
                kernel: p.kernel,
                adds: p.height > 0.0,
                factor: Factor::of(p),
                taper: p.tapered.as_deref().copied(),
                skeleton: p.skeleton.clone(),
                root: None,
                rim: None,
                primitive: number,
            };
            if let Some(piece) = piece {
                let (widths, height) = ([p.width; 2], p.height.abs());
                let node = body.node(piece, [0.0, 1.0], 0, widths, height);
                body.root = Some(pieces.keep(node));
                if let Some((normal, edges)) = flat(&p.skeleton) {
                    let mut rim = Vec::with_capacity(edges.len());
                    for (a, b) in edges {
                        let node = body.node(Piece::Line(a, b), [0.0, 1.0], 0, widths, height);
                        rim.push(pieces.keep(node));
                    }
                    body.rim = Some((normal, rim));
                }
            }
            pieces.bodies.push(body);
        }
        pieces
    }

    /// Adds a node; returns its number.
    fn keep(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// Returns bounds on the whole field in a ball; that on the second derivative is along a unit
    /// vector, if one is given, else in any direction.
    pub fn extent(
        &mut self,
        primitives: &[Primitive],
        center: DVec3,
        radius: f64,
        along: Option<DVec3>,
    ) -> Magnitudes {
        let mut sum = Magnitudes::default();
        for number in 0..self.bodies.len() {
            let mut most = match self.bodies[number].root {
                Some(root) => self.gather(number, root, center, radius),
                None => {
                    let body = &self.bodies[number];
                    plane(&primitives[body.primitive], center, radius, along)
                }
            };
            if let Some(along) = along {
                most[2] = most[2].min(self.flat_curvature(number, center, radius, along, most[2]));
            }
            let body = &self.bodies[number];
            let [size, slope, bend] = body.factor.largest;
            let value = size * most[0] * BOUND_SLACK;
            // A factor changes sign only if it `turns`.
            if body.adds || body.factor.turns {
                sum.above += value;
            }
            if !body.adds || body.factor.turns {
                sum.below += value;
            }
            sum.slope += BOUND_SLACK * (size * most[1] + slope * most[0]);
            sum.curvature +=
                BOUND_SLACK * (size * most[2] + 2.0 * slope * most[1] + bend * most[0]);
        }
        sum
    }

    /// Bounds the second derivative of a flat bone's term along a vector with the cosine c to its
    /// normal: in its plane derivatives are integrals of first derivatives over the rim alone
    /// (Gauss' theorem), so that it is at most `c²·curvature + (2c+1)·(slopes over the rim)`. Rays
    /// along a face need this bound.
    fn flat_curvature(
        &mut self,
        number: usize,
        center: DVec3,
        radius: f64,
        along: DVec3,
        curvature: f64,
    ) -> f64 {
        let Some((normal, edges)) = &self.bodies[number].rim else {
            return curvature;
        };
        let cosine = normal.dot(along).abs() + 1e-9;
        if cosine > 0.3 {
            return curvature;
        }
        let edges = edges.clone();
        let rim = edges
            .into_iter()
            .map(|edge| self.gather(number, edge, center, radius)[1]);
        let rim: f64 = rim.sum();
        cosine * cosine * curvature + (2.0 * cosine + 1.0) * rim
    }

    /// Bounds magnitude, slope and curvature of one term, before its factor.
    fn gather(&mut self, number: usize, root: u32, center: DVec3, radius: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let has_pole = self.bodies[number].kernel.has_pole();
        self.stack.clear();
        self.stack.push(root);
        while let Some(index) = self.stack.pop() {
            let node = &self.nodes[index as usize];
            let between = center.distance(node.center);
            let near = (between - radius - node.radius).max(0.0) * (1.0 - 1e-12);
            let far = (between + radius + node.radius) * (1.0 + 1e-12);
            let body = &self.bodies[number];
            if body.kernel.is_compact() && near * node.widths[0] >= 1.0 {
                continue;
            }
            let small = node.radius <= SMALL_BALL * (between - node.radius).max(radius)
                || (!has_pole && node.radius * node.widths[1] <= SMALL_WIDTH);
            let tapers = body.taper.is_some() && node.widths[0] < 0.8 * node.widths[1];
            let last = node.depth >= DEEPEST_PIECE
                || self.nodes.len() >= MOST_PIECES
                || node.radius == 0.0;
            if (small && !tapers) || last {
                let [low, high] = node.widths;
                let most = largest(body.kernel, near * low, far * high);
                let mass = node.height * node.measure;
                sum[0] += mass * most.value;
                sum[1] += mass * high * most.slope;
                sum[2] += mass * high * high * most.curvature;
                continue;
            }
            let (first, count) = self.parts(number, index);
            self.stack.extend(first..first + count);
        }
        sum
    }

    /// Returns the first part of a node and the number of its parts, made at first use.
    fn parts(&mut self, number: usize, index: u32) -> (u32, u32) {
        let node = &self.nodes[index as usize];
        if node.parts.0 != UNCUT {
            return node.parts;
        }
        let body = &self.bodies[number];
        let made = body.halves(node);
        let parts = (self.nodes.len() as u32, made.len() as u32);
        self.nodes.extend(made);
        self.nodes[index as usize].parts = parts;
        parts
    }
}

impl Body {
    /// Makes the node of a piece, given the parameters of the node that it is a part of.
    fn node(
        &self,
        piece: Piece,
        share: [f64; 2],
        depth: u8,
        mut widths: [f64; 2],
        mut height: f64,
    ) -> Node {
        let (center, radius, measure) = piece.hull();
        if let Some(shaping) = &self.taper {
            (widths, height) = range(shaping, &self.skeleton, share, widths, height);
        }
        Node {
            piece,
            center,
            radius: radius * BOUND_SLACK,
            measure: measure * BOUND_SLACK,
            share,
            widths,
            height,
            depth,
            parts: (UNCUT, 0),
        }
    }

    /// Divides a node.
    fn halves(&self, node: &Node) -> Vec<Node> {
        let depth = node.depth + 1;
        let [from, to] = node.share;
        let middle = 0.5 * (from + to);
        let two = |a: Piece, b: Piece, at: [f64; 2]| {
            let (widths, height) = (node.widths, node.height);
            vec![
                self.node(a, [from, at[1]], depth, widths, height),
                self.node(b, [at[0], to], depth, widths, height),
            ]
        };
        let same = |piece: Piece| self.node(piece, node.share, depth, node.widths, node.height);
        match &node.piece {
            Piece::Point(_) => Vec::new(),
            Piece::Line(a, b) => {
                let m = a.lerp(*b, 0.5);
                two(Piece::Line(*a, m), Piece::Line(m, *b), [middle; 2])
            }
            Piece::Arc(c, axes, [a, b]) => {
                let m = 0.5 * (a + b);
                let [left, right] = [[*a, m], [m, *b]].map(|turn| Piece::Arc(*c, *axes, turn));
                two(left, right, [middle; 2])
            }
            Piece::Triangle([a, b, c]) => {
                // Across the longest side.
                let sides = [(a, b, c), (b, c, a), (c, a, b)];
                let longest = sides.into_iter().max_by(|p, q| {
                    let [p, q] = [p, q].map(|side| side.0.distance_squared(*side.1));
                    p.total_cmp(&q)
                });
                let (p, q, r) = longest.unwrap_or((a, b, c));
                let m = p.lerp(*q, 0.5);
                [[*p, m, *r], [m, *q, *r]]
                    .map(|corners| same(Piece::Triangle(corners)))
                    .into()
            }
            Piece::Curve([a, b, c, d]) => {
                let (ab, bc, cd) = (halfway(*a, *b), halfway(*b, *c), halfway(*c, *d));
                let (abc, bcd) = (halfway(ab, bc), halfway(bc, cd));
                let m = halfway(abc, bcd);
                let (left, right) = ([*a, ab, abc, m], [m, bcd, cd, *d]);
                // Fraction of the length at the middle: bounds from chords and control polygons.
                let (least, most) = (|p: &[DVec3; 4]| p[0].distance(p[3]), outline);
                let share = |l: f64, r: f64| from + (to - from) * (l / (l + r).max(1e-300));
                let at = [
                    share(least(&left), most(&right)),
                    share(most(&left), least(&right)),
                ];
                two(Piece::Curve(left), Piece::Curve(right), at)
            }
            Piece::Part(part) => {
                let parts = part.part(0.0, 0.5).zip(part.part(0.5, 1.0));
                let Some((left, right)) = parts else {
                    // A part that cannot be cut is as small as can be.
                    let depth = DEEPEST_PIECE;
                    return vec![Node {
                        depth,
                        ..node.clone()
                    }];
                };
                let [l, r] = [&left, &right].map(Skeleton::measure);
                let at = from + (to - from) * (l / (l + r).max(1e-300));
                two(Piece::Part(left), Piece::Part(right), [at; 2])
            }
            Piece::Cell(c, [x, y], full) => {
                let (x, y) = (*x * 0.5, *y * 0.5);
                [(-x, -y), (x, -y), (-x, y), (x, y)]
                    .into_iter()
                    .filter_map(|(dx, dy)| {
                        let center = *c + dx + dy;
                        let reach = (x.length_squared() + y.length_squared()).sqrt();
                        let full = *full || {
                            let Skeleton::Polygon { rings } = &self.skeleton else {
                                return None;
                            };
                            let clear = edge_distance(rings, center) > reach * BOUND_SLACK;
                            let within = self.skeleton.distance(center) <= reach * BOUND_SLACK;
                            if !within {
                                return None;
                            }
                            clear
                        };
                        Some(same(Piece::Cell(center, [x, y], full)))
                    })
                    .collect()
            }
        }
    }
}

/// Computes the middle of two points.
fn halfway(a: DVec3, b: DVec3) -> DVec3 {
    a.lerp(b, 0.5)
}

impl Piece {
    /// Returns centre and radius of a ball around the piece, and its length or area (or more).
    fn hull(&self) -> (DVec3, f64, f64) {
        match self {
            Self::Point(c) => (*c, 0.0, 1.0),
            Self::Line(a, b) => {
                let length = a.distance(*b);
                (a.lerp(*b, 0.5), 0.5 * length, length)
            }
            Self::Arc(center, [x, y], [a, b]) => {
                let (r, half) = (x.length(), 0.5 * (b - a));
                let (sine, cosine) = libm::sincos(a + half);
                let measure = r * (b - a);
                if half >= core::f64::consts::FRAC_PI_2 {
                    return (*center, r, measure);
                }
                let (reach, along) = libm::sincos(half);
                let middle = *center + (*x * cosine + *y * sine) * along;
                // The chord's half, or for tiny ones the arc's.
                (middle, (r * reach).max(r * (1.0 - along)), measure)
            }
            Self::Triangle(corners) => {
                let [a, b, c] = *corners;
                let center = a + ((b - a) + (c - a)) / 3.0;
                let area = 0.5 * (b - a).cross(c - a).length();
                (center, furthest(center, corners), area)
            }
            Self::Curve(control) => {
                let [a, b, c, d] = *control;
                let center = 0.25 * ((a + b) + (c + d));
                (center, furthest(center, control), outline(control))
            }
            Self::Part(part) => {
                let (center, radius) = part
                    .bounding_sphere()
                    .unwrap_or((part.middle(), f64::INFINITY));
                (center, radius, part.most_length())
            }
            Self::Cell(c, [x, y], _) => {
                let reach = (x.length_squared() + y.length_squared()).sqrt();
                (*c, reach, 4.0 * x.length() * y.length())
            }
        }
    }
}

/// Computes the distance of the furthest of some points.
fn furthest(from: DVec3, points: &[DVec3]) -> f64 {
    let far = points.iter().map(|p| p.distance(from));
    far.fold(0.0, f64::max)
}

/// Returns the length of a control polygon.
fn outline(control: &[DVec3; 4]) -> f64 {
    control.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// Returns a square around a polygon, in its plane.
fn around(rings: &[Vec<DVec3>]) -> Piece {
    let mut points = rings.iter().flatten();
    let origin = points.next().copied().unwrap_or_default();
    let x = rings
        .iter()
        .flatten()
        .map(|p| *p - origin)
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .and_then(DVec3::try_normalize)
        .unwrap_or(DVec3::X);
    // The corner furthest from the line along x determines the plane.
    let y = rings
        .iter()
        .flatten()
        .map(|p| (*p - origin) - x * x.dot(*p - origin))
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .and_then(DVec3::try_normalize)
        .unwrap_or_else(|| x.any_orthonormal_vector());
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in rings.iter().flatten() {
        for (k, axis) in [x, y].into_iter().enumerate() {
            low[k] = low[k].min(axis.dot(*p - origin));
            high[k] = high[k].max(axis.dot(*p - origin));
        }
    }
    let [cx, cy] = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
    let [hx, hy] = [0, 1].map(|k| 0.5 * (high[k] - low[k]).max(0.0) * BOUND_SLACK);
    Piece::Cell(origin + x * cx + y * cy, [x * hx, y * hy], false)
}

/// Returns normal and edges of a triangle or polygon; `None` for other bones.
fn flat(skeleton: &Skeleton) -> Option<(DVec3, Vec<(DVec3, DVec3)>)> {
    match skeleton {
        Skeleton::Triangle { corners: [a, b, c] } => {
            let normal = (*b - *a).cross(*c - *a).try_normalize()?;
            Some((normal, vec![(*a, *b), (*b, *c), (*c, *a)]))
        }
        Skeleton::Polygon { rings } => {
            let Piece::Cell(_, [x, y], _) = around(rings) else {
                return None;
            };
            Some((x.cross(y).try_normalize()?, edges(rings).collect()))
        }
        _ => None,
    }
}

/// Returns a polygon's edges.
fn edges(rings: &[Vec<DVec3>]) -> impl Iterator<Item = (DVec3, DVec3)> {
    rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()])))
}

/// Returns the distance of a point from a polygon's edges.
fn edge_distance(rings: &[Vec<DVec3>], point: DVec3) -> f64 {
    edges(rings)
        .map(|(a, b)| {
            let d = b - a;
            let along = (point - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE);
            point.distance(a + d * along.clamp(0.0, 1.0))
        })
        .fold(f64::INFINITY, f64::min)
}

/// Returns the smallest and the largest width parameter and the largest height of a taper between
/// two shares of its length. Both follow from radius and relative blobbiness alone: the width falls
/// with the one and rises with the other.
fn range(
    shaping: &Shaping,
    skeleton: &Skeleton,
    [from, to]: [f64; 2],
    widths: [f64; 2],
    height: f64,
) -> ([f64; 2], f64) {
    // A little more on either side, as lengths along curves are rounded.
    let ends = [(from - 1e-6).max(0.0), (to + 1e-6).min(1.0)].map(|at| shaping.at(at));
    let [a, b] = ends.map(|s| s.radius);
    let (thin, thick) = (a.min(b), a.max(b));
    let [a, b] = ends.map(|s| s.blobbiness);
    let (mut low, mut high) = (a.min(b), a.max(b));
    if shaping.blob_scale == BlobScale::Absolute {
        low *= thin * thin;
        high *= thick * thick;
    }
    let of = |radius: f64, blobbiness: f64| Shaping {
        radius,
        blobbiness,
        blob_scale: BlobScale::Relative,
        taper: None,
        ..*shaping
    };
    let least = of(thick, low).width().unwrap_or(widths[0]);
    let most = of(thin, high).width().unwrap_or(widths[1]);
    // The height of a line is s/L(x), with L the field of an infinite line at x = s·R.
    let unit = of(1.0, high);
    let tall = match (unit.height(skeleton), unit.width()) {
        (Some(h), Some(x)) => h.abs() * most / x,
        _ => height,
    };
    (
        [least / BOUND_SLACK, most * BOUND_SLACK],
        tall * BOUND_SLACK,
    )
}

/// Bounds magnitude, slope and curvature of a plane's term in a ball. With `P(z) = π∫G` from z² on,
/// the slope is `2πzG` and the curvature at most `2πG + 4πz²|G′|`; along a vector with the cosine c
/// to the normal they are c and c² times that.
fn plane(primitive: &Primitive, center: DVec3, radius: f64, along: Option<DVec3>) -> [f64; 3] {
    let Skeleton::Plane { point, normal } = primitive.skeleton else {
        return [f64::INFINITY; 3];
    };
    let n = normal.try_normalize().unwrap_or(DVec3::Z);
    let away = (center - point).dot(n).abs();
    let rounding = 1e-12 * (away + center.length() + point.length());
    let near = (away - radius - rounding).max(0.0);
    let far = away + radius + rounding;
    let s = primitive.width;
    let height = primitive.height.abs();
    let size = Factor::of(primitive).largest[0];
    let at = (point + n * near).to_array();
    let value = if size > 0.0 {
        primitive.value(at).abs() / size
    } else {
        0.0
    };
    let most = largest(primitive.kernel, near * s, far * s);
    let cosine = along.map_or(1.0, |v| v.dot(n).abs() + 1e-12);
    let round = core::f64::consts::TAU * height;
    [
        value * (1.0 + 1e-6),
        cosine * round * far * most.value,
        cosine * cosine * round * (most.value + far * s * most.slope),
    ]
}
