//! A triangle in the plane z = 0, its corners counter-clockwise, the origin at its centroid.
use super::Edge;

/// A triangle in the plane z = 0, counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<S> {
    /// Corners.
    pub corners: [[S; 2]; 3],
    /// Edges; edge i is opposite corner i.
    pub edges: [Edge<S>; 3],
    /// Twice the area.
    pub double_area: S,
    /// Twice the area times twice the circumcentre as seen from corner 0.
    pub circum: [S; 2],
}

impl Triangle<f64> {
    /// Prepares a triangle from its corners in counter-clockwise order. Coincident or collinear
    /// ones are allowed.
    pub(crate) fn new(corners: [[f64; 2]; 3]) -> Self {
        let edges = [0, 1, 2].map(|i| Edge::between(corners[(i + 1) % 3], corners[(i + 2) % 3]));
        let [v0, v1, v2] = corners;
        let e1 = [v1[0] - v0[0], v1[1] - v0[1]];
        let e2 = [v2[0] - v0[0], v2[1] - v0[1]];
        let (n1, n2) = (e1[0] * e1[0] + e1[1] * e1[1], e2[0] * e2[0] + e2[1] * e2[1]);
        Self {
            corners,
            edges,
            double_area: e1[0] * e2[1] - e1[1] * e2[0],
            circum: [n1 * e2[1] - n2 * e1[1], n2 * e1[0] - n1 * e2[0]],
        }
    }
}

impl<S: Copy> Triangle<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Triangle<Q> {
        Triangle {
            corners: self.corners.map(|corner| corner.map(f)),
            edges: [0, 1, 2].map(|i| self.edges[i].cast(f)),
            double_area: f(self.double_area),
            circum: self.circum.map(f),
        }
    }
}
