//! A planar polygon with holes, in the plane z = 0: its edges keep its inside on their left.
//!
//! Every formula for a polygon is a sum over its edges (Green's theorem), so neither convexity nor
//! the number of its rings matters.
use super::Triangle;

/// An edge, prepared. For a point whose foot in the plane is q, `along·q − start` is the foot's
/// position on the edge's line measured from the edge's start, and `along×q − offset` the signed
/// distance of q from that line, positive on the left, inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge<S> {
    /// Unit direction.
    pub along: [S; 2],
    /// Length.
    pub length: S,
    /// `along·start`.
    pub start: S,
    /// `inward·start`.
    pub offset: S,
}

impl Edge<f64> {
    /// Prepares an edge from its ends. They may coincide.
    pub(crate) fn between(a: [f64; 2], b: [f64; 2]) -> Self {
        let d = [b[0] - a[0], b[1] - a[1]];
        let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
        let along = if length > 0.0 {
            [d[0] / length, d[1] / length]
        } else {
            [1.0, 0.0]
        };
        Self {
            along,
            length,
            start: along[0] * a[0] + along[1] * a[1],
            offset: along[0] * a[1] - along[1] * a[0],
        }
    }
}

impl<S: Copy> Edge<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Edge<Q> {
        Edge {
            along: self.along.map(f),
            length: f(self.length),
            start: f(self.start),
            offset: f(self.offset),
        }
    }
}

/// A polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon<S> {
    /// The edges of all rings.
    pub edges: Vec<Edge<S>>,
    /// Triangles from the polygon's first corner over each edge, with the sign that their
    /// orientation gives them: their signed sum is the polygon. Positive terms everywhere if the
    /// polygon is convex.
    pub fan: Vec<(S, Triangle<S>)>,
    /// The area.
    pub area: S,
}

impl Polygon<f64> {
    /// Prepares a polygon from its rings, the outer one first. Holes may run either way round.
    pub(crate) fn new(mut rings: Vec<Vec<[f64; 2]>>) -> Self {
        for (i, ring) in rings.iter_mut().enumerate() {
            if (double_area(ring) < 0.0) == (i == 0) {
                ring.reverse();
            }
        }
        let (mut edges, mut fan, mut area) = (Vec::new(), Vec::new(), 0.0);
        let apex = rings.first().and_then(|ring| ring.first()).copied();
        for ring in &rings {
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                edges.push(Edge::between(a, b));
                let Some(o) = apex else { continue };
                let twice = (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
                area += twice / 2.0;
                if twice > 0.0 {
                    fan.push((1.0, Triangle::new([o, a, b])));
                } else if twice < 0.0 {
                    fan.push((-1.0, Triangle::new([o, b, a])));
                }
            }
        }
        Self { edges, fan, area }
    }
}

/// Twice the signed area of a ring.
fn double_area(ring: &[[f64; 2]]) -> f64 {
    (0..ring.len())
        .map(|i| {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            a[0] * b[1] - a[1] * b[0]
        })
        .sum()
}

impl<S: Copy> Polygon<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Polygon<Q> {
        Polygon {
            edges: self.edges.iter().map(|edge| edge.cast(f)).collect(),
            fan: self
                .fan
                .iter()
                .map(|(sign, triangle)| (f(*sign), triangle.cast(f)))
                .collect(),
            area: f(self.area),
        }
    }
}
