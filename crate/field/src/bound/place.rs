//! Skeletons prepared for bounds: distances from balls.
//!
//! Points and segments are stored in [`Place`] itself, since a scene may have a million of them;
//! other kinds are boxed.
use crate::skeleton::{halves, nearest_on_segment, orthonormal};
use crate::{Cut, Primitive, Skeleton};
use core::f64::consts::{PI, TAU};
use glam::DVec3;

/// Skeleton in the form from which distances are computed.
#[derive(Clone, Debug)]
pub enum Place {
    /// A point.
    Point(DVec3),
    /// A line segment.
    Segment {
        /// Start.
        base: DVec3,
        /// Unit vector from the start to the end; 0 without a length.
        axis: DVec3,
        /// Length.
        length: f64,
    },
    /// An infinite plane.
    Plane {
        /// Point of the plane.
        point: DVec3,
        /// Unit normal.
        normal: DVec3,
    },
    /// A circular arc.
    Arc(Box<Sweep>),
    /// A triangle: corners and unit normal.
    Triangle(Box<([DVec3; 3], DVec3)>),
    /// A polygon.
    Polygon(Box<Skeleton>),
    /// A curve.
    Curve(Vec<Chord>),
}

/// Position of a ball's middle relative to a skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Distance from the skeleton, or less.
    pub distance: f64,
    /// Ratio of the integral over an arc to that over its tangent line, see
    /// [`Nearness`](super::Nearness).
    pub arc_factor: f64,
    /// Distance of the ball from an arc's axis; 0 for other skeletons.
    pub axis_distance: f64,
}

/// An arc `center + radius·(cos t·u + sin t·v)`, `0 ≤ t ≤ angle`; u, v and axis are orthonormal.
#[derive(Clone, Debug)]
pub struct Sweep {
    center: DVec3,
    u: DVec3,
    v: DVec3,
    axis: DVec3,
    radius: f64,
    angle: f64,
    /// Sine and cosine of the angle.
    turn: (f64, f64),
    /// sin(φ/2)/(φ/2) for the largest φ, see [`Sweep::nearness`].
    sag: f64,
}

/// A piece of a curve: all of it is within a distance of its chord.
#[derive(Clone, Copy, Debug)]
pub struct Chord {
    base: DVec3,
    apex: DVec3,
    sag: f64,
}

/// Largest distance of a curve's piece from its chord, in kernel widths, unless that takes more
/// than [`MOST_CHORDS`].
const SAG: f64 = 0.01;
/// Largest number of chords of a curve.
const MOST_CHORDS: u32 = 16;

impl Place {
    /// Prepares the skeleton of a primitive whose kernel has this width parameter.
    pub fn of(primitive: &Primitive, width: f64) -> Self {
        match &primitive.skeleton {
            Skeleton::Point { center } => Self::Point(*center),
            Skeleton::Segment { base, apex } => Self::Segment {
                base: *base,
                axis: (*apex - *base).normalize_or_zero(),
                length: (*apex - *base).length(),
            },
            Skeleton::Arc {
                center,
                u,
                v,
                radius,
                angle,
            } => Self::Arc(Box::new(Sweep::new(*center, [*u, *v], *radius, *angle))),
            Skeleton::Triangle { corners } => {
                let [a, b, c] = *corners;
                let normal = (b - a).cross(c - a).normalize_or_zero();
                Self::Triangle(Box::new((*corners, normal)))
            }
            polygon @ Skeleton::Polygon { .. } => Self::Polygon(Box::new(polygon.clone())),
            Skeleton::Plane { point, normal } => Self::Plane {
                point: *point,
                normal: normal.try_normalize().unwrap_or(DVec3::Z),
            },
            line => {
                let cubics = line.cubics(0.0).into_iter();
                Self::Curve(cubics.flat_map(|c| chords(c, SAG / width)).collect())
            }
        }
    }

    /// Returns how near the middle of a ball is to the skeleton.
    pub fn nearness(&self, center: DVec3, radius: f64) -> Near {
        let distance = match self {
            Self::Point(point) => center.distance(*point),
            Self::Segment { base, axis, length } => {
                let d = center - *base;
                let along = d.dot(*axis).clamp(0.0, *length);
                d.distance(*axis * along)
            }
            Self::Arc(sweep) => return sweep.nearness(center, radius),
            Self::Triangle(triangle) => triangle_distance(&triangle.0, triangle.1, center),
            Self::Polygon(skeleton) => skeleton.distance(center),
            Self::Curve(chords) => {
                let distance = chords.iter().map(|chord| chord.distance(center));
                return Near {
                    distance: distance.fold(f64::INFINITY, f64::at_most).at_least(0.0),
                    arc_factor: f64::INFINITY,
                    axis_distance: 0.0,
                };
            }
            Self::Plane { point, normal } => (center - *point).dot(*normal).abs(),
        };
        Near {
            distance,
            arc_factor: 1.0,
            axis_distance: 0.0,
        }
    }
}

impl Sweep {
    fn new(center: DVec3, [u, v]: [DVec3; 2], radius: f64, angle: f64) -> Self {
        // The orthonormal axes are those of the field.
        let (u, v) = orthonormal(u, v);
        let angle = angle.clamp(0.0, TAU);
        let half = 0.5 * angle.min(PI);
        Self {
            center,
            u,
            v,
            axis: u.cross(v),
            radius,
            angle,
            turn: libm::sincos(angle),
            sag: if half > 1e-9 {
                libm::sin(half) / half
            } else {
                1.0
            },
        }
    }

    fn nearness(&self, center: DVec3, radius: f64) -> Near {
        let (sweep, angle) = (self.radius, self.angle);
        let d = center - self.center;
        let (x, y, z) = (d.dot(self.u), d.dot(self.v), d.dot(self.axis));
        let rho = (x * x + y * y).sqrt();
        let (sin, cos) = self.turn;
        let before = x * sin - y * cos >= 0.0;
        let swept = if angle > PI {
            y >= 0.0 || before
        } else {
            y >= 0.0 && before
        };
        let (distance, arc_factor) = if swept {
            // A point of the arc at angle φ from the foot is no nearer than if the arc
            // were straight but shorter by the factor sin(φ/2)/(φ/2)·√(ρ/sweep).
            let shrink = self.sag * ((rho - radius).at_least(0.0) / sweep).sqrt();
            let off = rho - sweep;
            ((off * off + z * z).sqrt(), (1.0 / shrink).at_least(1.0))
        } else {
            let start = (x - sweep) * (x - sweep) + y * y;
            let (ex, ey) = (x - sweep * cos, y - sweep * sin);
            let distance = (start.at_most(ex * ex + ey * ey) + z * z).sqrt();
            (distance, f64::INFINITY)
        };
        Near {
            distance,
            arc_factor,
            axis_distance: (rho - radius).at_least(0.0),
        }
    }
}

impl Chord {
    fn of([a, b, c, d]: [DVec3; 4]) -> Self {
        // The piece is in the hull of its control points.
        let [off_b, off_c] = [b, c].map(|p| p.distance(nearest_on_segment(p, a, d)));
        Self {
            base: a,
            apex: d,
            sag: off_b.max(off_c) * (1.0 + 1e-9),
        }
    }

    fn distance(&self, point: DVec3) -> f64 {
        point.distance(nearest_on_segment(point, self.base, self.apex)) - self.sag
    }
}

/// The chords of a Bézier curve.
fn chords(control: [DVec3; 4], sag: f64) -> Vec<Chord> {
    let mut count = 1;
    loop {
        let mut rest = control;
        let chords: Vec<Chord> = (0..count)
            .map(|i| {
                let (piece, next) = halves(rest, 1.0 / f64::from(count - i));
                rest = next;
                Chord::of(piece)
            })
            .collect();
        if count >= MOST_CHORDS || chords.iter().all(|chord| chord.sag <= sag) {
            return chords;
        }
        count *= 2;
    }
}

fn triangle_distance(corners: &[DVec3; 3], normal: DVec3, p: DVec3) -> f64 {
    let mut inside = true;
    let mut nearest = f64::INFINITY;
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        let edge = b - a;
        let d = p - a;
        inside &= edge.cross(d).dot(normal) >= 0.0;
        let along = (d.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        nearest = nearest.at_most(d.distance_squared(edge * along));
    }
    if inside {
        (p - corners[0]).dot(normal).abs()
    } else {
        nearest.sqrt()
    }
}
