//! Triangular metaballs: the Euclidean distance from a whole facet.

use field::Real;
use field::real::Scalar;
use glam::DVec3;

/// Triangle in its own coordinates, in one precision: the longest side runs along the first axis
/// from the origin, the third corner lies at y ≥ 0, the third axis is the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle<S> {
    origin: [S; 3],
    axes: [[S; 3]; 3],
    /// The start of each side, counterclockwise, and the way to its end.
    sides: [([S; 2], [S; 2]); 3],
    /// 1 over the squared length of each side; 0 where that is 0.
    inverse: [S; 3],
}

impl<S: Scalar> Triangle<S> {
    pub fn new(corners: &[DVec3; 3]) -> Self {
        let lengths = [0, 1, 2].map(|i| corners[i].distance_squared(corners[(i + 1) % 3]));
        let first = (1..3).fold(
            0,
            |best, i| if lengths[i] > lengths[best] { i } else { best },
        );
        let [a, b, c] = [0, 1, 2].map(|i| corners[(first + i) % 3]);
        let x = (b - a).try_normalize().unwrap_or(DVec3::X);
        let height = (c - a) - x * (c - a).dot(x);
        let y = height
            .try_normalize()
            .map(|y| (y - x * y.dot(x)).normalize())
            .unwrap_or_else(|| x.any_orthonormal_vector());
        let flat = [
            [0.0; 2],
            [a.distance(b), 0.0],
            [(c - a).dot(x), (c - a).dot(y)],
        ];
        let mut inverse = [0.0; 3];
        let sides = core::array::from_fn(|i| {
            let (from, to): ([f64; 2], [f64; 2]) = (flat[i], flat[(i + 1) % 3]);
            let way = [to[0] - from[0], to[1] - from[1]];
            let square = way[0] * way[0] + way[1] * way[1];
            // In single precision the inverse of a number below 10⁻³⁸ is none.
            inverse[i] = if square > 1e-36 { 1.0 / square } else { 0.0 };
            (from.map(S::round), way.map(S::round))
        });
        Self {
            origin: a.to_array().map(S::round),
            axes: [x, y, x.cross(y)].map(|axis| axis.to_array().map(S::round)),
            sides,
            inverse: inverse.map(S::round),
        }
    }

    /// Returns the vector to a point from the nearest point of the triangle.
    #[inline(always)]
    pub fn offset<R: Real<Scalar = S>>(&self, point: [R; 3]) -> [R; 3] {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let offset: [R; 3] = core::array::from_fn(|i| point[i] - R::lift(self.origin[i]));
        let axes = self.axes.map(|axis| axis.map(R::lift));
        let [x, y, z] =
            axes.map(|axis| axis[0] * offset[0] + axis[1] * offset[1] + axis[2] * offset[2]);
        let mut least = R::splat(f64::from(f32::MAX));
        let mut nearest = [x, y];
        let mut inside = zero.lt(one);
        for ((from, way), inverse) in self.sides.iter().zip(self.inverse) {
            let [fx, fy] = from.map(R::lift);
            let [wx, wy] = way.map(R::lift);
            let (px, py) = (x - fx, y - fy);
            let t = ((px * wx + py * wy) * R::lift(inverse)).max(zero).min(one);
            let (dx, dy) = (px - t * wx, py - t * wy);
            let square = dx * dx + dy * dy;
            let nearer = square.lt(least);
            least = R::select(nearer, square, least);
            nearest = [
                R::select(nearer, dx, nearest[0]),
                R::select(nearer, dy, nearest[1]),
            ];
            inside = R::both(inside, zero.lt(wx * py - wy * px));
        }
        let [dx, dy] = nearest.map(|d| R::select(inside, zero, d));
        core::array::from_fn(|i| dx * axes[0][i] + dy * axes[1][i] + z * axes[2][i])
    }
}

/// The point of a triangle nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The point.
    pub point: DVec3,
    /// Weights of the corners whose mean it is; ≥ 0, their sum is 1.
    pub weights: [f64; 3],
}

/// Returns the point of a triangle that is nearest to a point, with its weights.
///
/// ```
/// use glam::DVec3;
///
/// let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let nearest = metaballs::nearest(&triangle, DVec3::new(0.25, 0.5, 7.0));
/// assert_eq!(nearest.weights, [0.25, 0.25, 0.5]);
/// ```
#[must_use]
pub fn nearest(corners: &[DVec3; 3], point: DVec3) -> Nearest {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let square = normal.length_squared();
    let parts = [(b, c), (c, a), (a, b)]
        .map(|(from, to)| (to - from).cross(point - from).dot(normal) / square);
    if parts.iter().all(|part| *part > 0.0) {
        let sum: f64 = parts.iter().sum();
        let weights = parts.map(|part| part / sum);
        return at(corners, weights);
    }
    let mut best = at(corners, [1.0, 0.0, 0.0]);
    for [i, j] in [[0, 1], [1, 2], [2, 0]] {
        let way = corners[j] - corners[i];
        let length = way.length_squared();
        let t = if length > 0.0 {
            ((point - corners[i]).dot(way) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mut weights = [0.0; 3];
        (weights[i], weights[j]) = (1.0 - t, t);
        let found = at(corners, weights);
        if found.point.distance_squared(point) < best.point.distance_squared(point) {
            best = found;
        }
    }
    best
}

fn at(corners: &[DVec3; 3], weights: [f64; 3]) -> Nearest {
    let point = (0..3).map(|i| corners[i] * weights[i]).sum();
    Nearest { point, weights }
}
