//! Ray intervals within a skeleton's depth of influence: the bounding volumes of the thesis's
//! section 4.2, in the primitive's local frame.
//!
//! Each volume holds all points within distance d of the skeleton. Intervals are conservative: a
//! point of the ray outside its interval is outside the volume.
use crate::bone::Bone;
use glam::DVec3;

/// An interval of the ray's parameter; empty if its first number is larger than its second.
type Interval = [f64; 2];

const ALL: Interval = [f64::NEG_INFINITY, f64::INFINITY];
const NONE: Interval = [f64::INFINITY, f64::NEG_INFINITY];

/// The interval of `origin + t·direction` (local) that contains all points within `d` of the form.
pub(crate) fn interval(
    bone: &Bone<f64>,
    d: f64,
    origin: DVec3,
    direction: DVec3,
) -> Option<Interval> {
    // Rounding must not cut anything off.
    let d = d * (1.0 + 1e-9) + 1e-12;
    let ray = Ray { origin, direction };
    let found = match bone {
        Bone::Point => ray.ball(DVec3::ZERO, d),
        Bone::Segment(segment) => ray.capsule(segment.half, d),
        Bone::Arc(arc) => {
            let r = arc.radius;
            let (near, far) = (r - r * arc.versine, r);
            // Measured from the centre, x towards the arc's middle or its gap's.
            let ray = Ray {
                origin: origin + DVec3::X * r,
                direction,
            };
            let (left, right) = if arc.side > 0.0 {
                (near, far)
            } else {
                (-far, near)
            };
            let width = if arc.side > 0.0 { r * arc.sine } else { r };
            let hull = meet(
                meet(ray.slab(2, -d, d), ray.slab(0, left - d, right + d)),
                meet(ray.slab(1, -width - d, width + d), ray.tube(r + d)),
            );
            // The hole of the ring: parts of the interval's ends that lie in it are cut off.
            if r > d {
                let inner = (r - d) * (1.0 - 1e-9);
                cut(hull, ray.tube(inner))
            } else {
                hull
            }
        }
        Bone::Triangle(triangle) => {
            let mut hull = ray.slab(2, -d, d);
            for axis in 0..2 {
                let c = triangle.corners.map(|corner| corner[axis]);
                let low = c[0].min(c[1]).min(c[2]);
                let high = c[0].max(c[1]).max(c[2]);
                hull = meet(hull, ray.slab(axis, low - d, high + d));
            }
            for edge in &triangle.edges {
                if edge.length > 0.0 {
                    let inward = DVec3::new(-edge.along[1], edge.along[0], 0.0);
                    hull = meet(hull, ray.above(inward, edge.offset - d));
                }
            }
            hull
        }
        Bone::Polygon(polygon) => {
            let mut hull = ray.slab(2, -d, d);
            for axis in 0..2 {
                // An edge starts at `start·along + offset·left`.
                let ends = polygon.edges.iter().map(|edge| match axis {
                    0 => edge.start * edge.along[0] - edge.offset * edge.along[1],
                    _ => edge.start * edge.along[1] + edge.offset * edge.along[0],
                });
                let low = ends.clone().fold(f64::INFINITY, f64::min);
                let high = ends.fold(f64::NEG_INFINITY, f64::max);
                hull = meet(hull, ray.slab(axis, low - d, high + d));
            }
            hull
        }
        Bone::Curve(curve) if let Some(half) = curve.capsule => ray.capsule(half, d),
        Bone::Curve(curve) => {
            let mut hull = NONE;
            for piece in &curve.piece_bounds {
                hull = join(hull, ray.ball(piece.center, piece.radius + d));
            }
            hull
        }
        Bone::Plane => ray.slab(2, -d, d),
    };
    (found[0] <= found[1]).then_some(found)
}

fn meet(a: Interval, b: Interval) -> Interval {
    [a[0].max(b[0]), a[1].min(b[1])]
}

fn join(a: Interval, b: Interval) -> Interval {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Removes from `a` the parts of `hole` that contain an end of it.
fn cut(a: Interval, hole: Interval) -> Interval {
    let [mut low, mut high] = a;
    if hole[0] <= low && low <= hole[1] {
        low = hole[1];
    }
    if hole[0] <= high && high <= hole[1] {
        high = hole[0];
    }
    [low, high]
}

struct Ray {
    origin: DVec3,
    direction: DVec3,
}

impl Ray {
    fn ball(&self, center: DVec3, radius: f64) -> Interval {
        round(self.origin - center, self.direction, radius)
    }

    /// The infinite cylinder around the z axis.
    fn tube(&self, radius: f64) -> Interval {
        let flat = |v: DVec3| DVec3::new(v.x, v.y, 0.0);
        round(flat(self.origin), flat(self.direction), radius)
    }

    fn capsule(&self, half: f64, radius: f64) -> Interval {
        let flat = |v: DVec3| DVec3::new(0.0, v.y, v.z);
        let side = meet(
            round(flat(self.origin), flat(self.direction), radius),
            self.slab(0, -half, half),
        );
        let ends = join(
            self.ball(DVec3::X * half, radius),
            self.ball(DVec3::X * -half, radius),
        );
        if side[0] <= side[1] {
            join(side, ends)
        } else {
            ends
        }
    }

    /// Interval on which `low ≤ x ≤ high` in coordinate `axis`.
    fn slab(&self, axis: usize, low: f64, high: f64) -> Interval {
        let mut n = DVec3::ZERO;
        n[axis] = 1.0;
        meet(self.above(n, low), self.above(-n, -high))
    }

    /// Interval on which `n·p ≥ level`.
    fn above(&self, n: DVec3, level: f64) -> Interval {
        let height = n.dot(self.origin) - level;
        let rate = n.dot(self.direction);
        if rate == 0.0 {
            return if height >= 0.0 { ALL } else { NONE };
        }
        let t = -height / rate;
        if rate > 0.0 {
            [t, f64::INFINITY]
        } else {
            [f64::NEG_INFINITY, t]
        }
    }
}

/// Interval on which `|o + t·d| ≤ radius`, solved from the ray's nearest point, which keeps the
/// digits for far origins.
fn round(o: DVec3, d: DVec3, radius: f64) -> Interval {
    let square = d.length_squared();
    if square == 0.0 {
        return if o.length_squared() <= radius * radius {
            ALL
        } else {
            NONE
        };
    }
    let nearest = -o.dot(d) / square;
    let gap = radius * radius - (o + d * nearest).length_squared();
    if gap < 0.0 {
        return NONE;
    }
    let half = (gap / square).sqrt();
    [nearest - half, nearest + half]
}
