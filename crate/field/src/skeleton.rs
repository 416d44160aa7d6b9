//! The bones: geometry of dimension 0, 1 and 2.
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Bone: a piece of skeleton.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Skeleton {
    /// A point.
    Point {
        /// Position.
        center: DVec3,
    },
    /// A line segment.
    Segment {
        /// Start.
        base: DVec3,
        /// End.
        apex: DVec3,
    },
    /// A circular arc `center + radius·(cos t·u + sin t·v)`, `0 ≤ t ≤ angle`.
    Arc {
        /// Centre of the circle.
        center: DVec3,
        /// Unit vector to the start.
        u: DVec3,
        /// Unit vector perpendicular to `u`.
        v: DVec3,
        /// Radius of the circle.
        radius: f64,
        /// Angle swept, radians, in (0, 2π].
        angle: f64,
    },
    /// A triangle.
    Triangle {
        /// Corners.
        corners: [DVec3; 3],
    },
    /// A planar polygon.
    Polygon {
        /// Corners: the outer ring, then any holes, which lie inside it. No two edges may cross,
        /// else [bounds](crate::Bound) on its field are wrong.
        rings: Vec<Vec<DVec3>>,
    },
    /// A cubic Bézier curve.
    Curve {
        /// Control points.
        control: [DVec3; 4],
    },
    /// An infinite plane.
    Plane {
        /// Point of the plane.
        point: DVec3,
        /// Unit normal.
        normal: DVec3,
    },
}

impl Skeleton {
    /// Returns 0 for points, 1 for segments, arcs and curves, 2 for triangles, polygons and planes.
    #[must_use]
    pub fn dimension(&self) -> u8 {
        match self {
            Self::Point { .. } => 0,
            Self::Segment { .. } | Self::Arc { .. } | Self::Curve { .. } => 1,
            Self::Triangle { .. } | Self::Polygon { .. } | Self::Plane { .. } => 2,
        }
    }

    /// Length or area; 1 for a point, infinite for a plane.
    #[must_use]
    pub fn measure(&self) -> f64 {
        match *self {
            Self::Point { .. } => 1.0,
            Self::Segment { base, apex } => (apex - base).length(),
            Self::Arc { radius, angle, .. } => radius * angle.clamp(0.0, core::f64::consts::TAU),
            Self::Triangle { corners: [a, b, c] } => (b - a).cross(c - a).length() / 2.0,
            Self::Polygon { ref rings } => (area_vector(rings).length() / 2.0).abs(),
            Self::Curve { control } => {
                let c = cubic(control);
                let breaks: Vec<f64> = (0..=8).map(|i| f64::from(i) / 8.0).collect();
                crate::integral::integral(
                    &mut |t| (c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])).length(),
                    &breaks,
                    1e-12,
                )
            }
            Self::Plane { .. } => f64::INFINITY,
        }
    }

    /// Distance of a point from the skeleton.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        (point - self.nearest(point)).length()
    }

    /// The point of the skeleton nearest to `point` (one of them, where there are several).
    #[must_use]
    pub fn nearest(&self, point: DVec3) -> DVec3 {
        match *self {
            Self::Point { center } => center,
            Self::Segment { base, apex } => nearest_on_segment(point, base, apex),
            Self::Arc {
                center,
                u,
                v,
                radius,
                angle,
            } => {
                let (u, v) = orthonormal(u, v);
                let half = angle.clamp(0.0, core::f64::consts::TAU) / 2.0;
                let d = point - center;
                // Azimuth from the arc's middle: the nearer end is then found by clamping.
                let (sine, cosine) = libm::sincos(half);
                let (x, y) = (u * cosine + v * sine, v * cosine - u * sine);
                let azimuth = libm::atan2(d.dot(y), d.dot(x)).clamp(-half, half);
                let (sine, cosine) = libm::sincos(azimuth);
                center + radius * (x * cosine + y * sine)
            }
            Self::Triangle { corners: [a, b, c] } => {
                let (e1, e2) = (b - a, c - a);
                let normal = e1.cross(e2);
                let area = normal.length_squared();
                let d = point - a;
                let v = normal.dot(e1.cross(d)) / area;
                let u = normal.dot(d.cross(e2)) / area;
                // The edges are tested in any case: for a needle's interior u and v are uncertain.
                let inside = area > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
                [(a, b), (b, c), (c, a)]
                    .map(|(p, q)| nearest_on_segment(point, p, q))
                    .into_iter()
                    .chain(inside.then(|| a + e1 * u + e2 * v))
                    .min_by(|p, q| {
                        p.distance_squared(point)
                            .total_cmp(&q.distance_squared(point))
                    })
                    .unwrap_or(a)
            }
            Self::Polygon { ref rings } => {
                let n = area_vector(rings).try_normalize();
                let foot = n.zip(rings.first().and_then(|ring| ring.first()));
                let inside = foot
                    .map(|(n, o)| point - n * (point - *o).dot(n))
                    .filter(|q| n.is_some_and(|n| is_inside(rings, n, *q)));
                edges(rings)
                    .map(|(p, q)| nearest_on_segment(point, p, q))
                    .chain(inside)
                    .min_by(|p, q| {
                        p.distance_squared(point)
                            .total_cmp(&q.distance_squared(point))
                    })
                    .unwrap_or(DVec3::ZERO)
            }
            Self::Curve { control } => nearest_on_cubic(point, control),
            Self::Plane { point: p, normal } => {
                let n = normal.try_normalize().unwrap_or(DVec3::Z);
                point - n * n.dot(point - p)
            }
        }
    }

    /// Returns a sphere (centre, radius) that holds the skeleton; `None` for a plane.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        match *self {
            Self::Point { center } => Some((center, 0.0)),
            Self::Segment { base, apex } => {
                Some(((base + apex) / 2.0, (apex - base).length() / 2.0))
            }
            Self::Arc {
                center,
                u,
                v,
                radius,
                angle,
            } => {
                if angle >= core::f64::consts::PI {
                    return Some((center, radius));
                }
                // Up to a half circle the sphere over the chord holds the arc.
                let (u, v) = orthonormal(u, v);
                let (sine, cosine) = libm::sincos(angle.max(0.0) / 2.0);
                let middle = center + (u * cosine + v * sine) * (radius * cosine);
                Some((middle, radius * sine))
            }
            Self::Triangle { corners: [a, b, c] } => {
                // Over the longest side, if the opposite corner is in that sphere, else around.
                let (p, q, r) = [(a, b, c), (b, c, a), (c, a, b)]
                    .into_iter()
                    .max_by(|x, y| {
                        x.0.distance_squared(x.1)
                            .total_cmp(&y.0.distance_squared(y.1))
                    })
                    .unwrap_or((a, b, c));
                let middle = (p + q) / 2.0;
                let half = (q - p).length() / 2.0;
                if r.distance(middle) <= half {
                    return Some((middle, half));
                }
                let (e1, e2) = (q - p, r - p);
                let normal = e1.cross(e2);
                let offset = (e1.length_squared() * e2.cross(normal)
                    + e2.length_squared() * normal.cross(e1))
                    / (2.0 * normal.length_squared());
                Some((p + offset, offset.length() * (1.0 + 1e-12)))
            }
            Self::Polygon { ref rings } => Some(ball_around(rings.iter().flatten())),
            // The curve lies in the hull of its control points.
            Self::Curve { control } => Some(ball_around(control.iter())),
            Self::Plane { .. } => None,
        }
    }

    /// Whether all its numbers are finite and its radius, if any, is not negative.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match *self {
            Self::Point { center } => center.is_finite(),
            Self::Segment { base, apex } => base.is_finite() && apex.is_finite(),
            Self::Arc {
                center,
                u,
                v,
                radius,
                angle,
            } => {
                center.is_finite()
                    && u.is_finite()
                    && v.is_finite()
                    && radius.is_finite()
                    && radius >= 0.0
                    && angle.is_finite()
            }
            Self::Triangle { corners } => corners.iter().all(|p| p.is_finite()),
            Self::Polygon { ref rings } => rings.iter().flatten().all(|p| p.is_finite()),
            Self::Curve { control } => control.iter().all(|p| p.is_finite()),
            Self::Plane { point, normal } => point.is_finite() && normal.is_finite(),
        }
    }
}

/// The edges of all rings.
fn edges(rings: &[Vec<DVec3>]) -> impl Iterator<Item = (DVec3, DVec3)> {
    rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])))
}

/// Normal of a polygon, twice as long as its area is large: of the outer ring less the holes, which
/// may run either way round.
#[must_use]
pub fn area_vector(rings: &[Vec<DVec3>]) -> DVec3 {
    let Some((outer, holes)) = rings.split_first() else {
        return DVec3::ZERO;
    };
    let whole = ring_vector(outer);
    holes.iter().fold(whole, |sum, hole| {
        let hole = ring_vector(hole);
        if hole.dot(whole) > 0.0 {
            sum - hole
        } else {
            sum + hole
        }
    })
}

/// Normal of a ring, twice as long as its area is large.
fn ring_vector(ring: &[DVec3]) -> DVec3 {
    let o = ring.first().copied().unwrap_or_default();
    ring.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum()
}

/// Whether a point of the polygon's plane lies inside: an odd number of edges crosses a line from
/// it.
fn is_inside(rings: &[Vec<DVec3>], normal: DVec3, point: DVec3) -> bool {
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let mut inside = false;
    for (a, b) in edges(rings) {
        let (a, b) = (a - point, b - point);
        let (ay, by) = (a.dot(y), b.dot(y));
        if (ay > 0.0) != (by > 0.0) && a.dot(x) + (b - a).dot(x) * (ay / (ay - by)) > 0.0 {
            inside = !inside;
        }
    }
    inside
}

/// Centre of the bounding box, and the distance of the furthest point.
fn ball_around<'a>(points: impl Iterator<Item = &'a DVec3> + Clone) -> (DVec3, f64) {
    let low = points.clone().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = points
        .clone()
        .fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    let center = (low + high) / 2.0;
    let radius = points.fold(0.0, |r: f64, p| r.max(p.distance(center)));
    (center, radius * (1.0 + 1e-12))
}

/// Computes a Bézier curve's coefficients in powers of t.
#[must_use]
pub fn cubic([a, b, c, d]: [DVec3; 4]) -> [DVec3; 4] {
    [
        a,
        (b - a) * 3.0,
        (a - b * 2.0 + c) * 3.0,
        d - a + (b - c) * 3.0,
    ]
}

/// Cuts a Bézier curve at t (de Casteljau).
#[must_use]
pub fn halves([a, b, c, d]: [DVec3; 4], t: f64) -> ([DVec3; 4], [DVec3; 4]) {
    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
    let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
    let m = abc.lerp(bcd, t);
    ([a, ab, abc, m], [m, bcd, cd, d])
}

/// Steps of the parameter between which the nearest point of a curve is looked for.
const SAMPLES: i32 = 128;

/// The point of a Bézier curve nearest to `point`: the best of samples, improved by bisection of
/// the steps to either side.
fn nearest_on_cubic(point: DVec3, control: [DVec3; 4]) -> DVec3 {
    let c = cubic(control);
    let at = |t: f64| c[0] + t * (c[1] + t * (c[2] + t * c[3]));
    let distance = |t: f64| at(t).distance_squared(point);
    let mut best = (0..=SAMPLES)
        .map(|i| f64::from(i) / f64::from(SAMPLES))
        .min_by(|s, t| distance(*s).total_cmp(&distance(*t)))
        .unwrap_or(0.0);
    let mut step = 1.0 / f64::from(SAMPLES);
    while step > 1e-12 {
        step *= 0.5;
        for t in [(best - step).max(0.0), (best + step).min(1.0)] {
            if distance(t) < distance(best) {
                best = t;
            }
        }
    }
    at(best)
}

/// The point of a segment nearest to `point`.
pub(crate) fn nearest_on_segment(point: DVec3, base: DVec3, apex: DVec3) -> DVec3 {
    let d = apex - base;
    let square = d.length_squared();
    if square == 0.0 {
        return base;
    }
    base + d * ((point - base).dot(d) / square).clamp(0.0, 1.0)
}

/// Unit vectors in the plane of u and v, the first along u.
pub(crate) fn orthonormal(u: DVec3, v: DVec3) -> (DVec3, DVec3) {
    let u = u.try_normalize().unwrap_or(DVec3::X);
    let v = (v - u * u.dot(v))
        .try_normalize()
        .unwrap_or_else(|| u.any_orthonormal_vector());
    (u, v)
}
