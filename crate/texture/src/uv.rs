//! Texture coordinates u, v of points on or near primitives, with their gradients.
//!
//! A soft primitive's texture coordinates are those of its bounding volume; they are functions of
//! space, so a point of a blended surface has coordinates for each element near it.
//!
//! - Sphere: u is the longitude about y, to the right as seen from outside, ½ towards +z; v is the
//!   latitude, 0 at −y, 1 at +y. Seams: u towards −z, and the poles.
//! - Segment, capsule, cylinder, cone: u runs along the axis, base 0, apex 1, cut beyond; v around
//!   it, ½ towards its front. Seam: v at the back.
//! - Arc, torus, piece of a torus: u runs along the arc, cut in the gap; v around the tube, ½ away
//!   from the centre. Seams: v towards the centre; u where the gap, or the arc's ends, are.
//! - Triangle, prism: u is the share of the second corner, v of the third, both cut.
//! - Plane, slab, polygon: u runs along world x made perpendicular to the normal N (y if N ∥ x), v
//!   along N × that.
//! - Box: u runs across each face, v up each face. Seams: the edges.
//!
//! u runs along a bone, as it does for profiles of its strength. The *front* of an axis is the
//! direction +z made perpendicular to it, or +y if it is parallel to z. An image on an upright
//! sphere thus stands upright and faces a viewer at +z; on an upright cylinder it lies on its side,
//! as its width runs along the axis.
//!
//! No function returns NaN for finite input; where a direction is undefined (at poles, on axes) the
//! gradient is 0 and the coordinate ½.

use core::f64::consts::{PI, TAU};
use glam::{DVec2, DVec3};

/// Texture coordinates at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uv {
    /// u and v.
    pub at: DVec2,
    /// The gradients of u and of v in the space of the point; 0 where they are cut or undefined.
    pub gradient: [DVec3; 2],
}

/// Coordinate and its gradient.
type Coordinate = (f64, DVec3);

impl Uv {
    fn new(u: Coordinate, v: Coordinate) -> Self {
        Self {
            at: DVec2::new(u.0, v.0),
            gradient: [u.1, v.1],
        }
    }

    /// The coordinates of a piece of a longer bone, which goes from `from` to `to` of the bone's u.
    #[must_use]
    pub fn of_piece(self, from: f64, to: f64) -> Self {
        Self {
            at: DVec2::new(from + (to - from) * self.at.x, self.at.y),
            gradient: [(to - from) * self.gradient[0], self.gradient[1]],
        }
    }
}

/// `direction` made perpendicular to a unit `axis`, of length 1; `other` if the two are parallel.
fn upright(direction: DVec3, other: DVec3, axis: DVec3) -> DVec3 {
    let [first, second] = [direction, other].map(|d| d - axis * d.dot(axis));
    if first.length_squared() > 1e-12 {
        first.normalize()
    } else {
        second.normalize_or(other)
    }
}

/// Cuts to [0, 1]; beyond, the gradient is 0.
fn cut((x, gradient): Coordinate) -> Coordinate {
    if x > 0.0 && x < 1.0 {
        (x, gradient)
    } else if x >= 1.0 {
        (1.0, DVec3::ZERO)
    } else {
        (0.0, DVec3::ZERO)
    }
}

/// The angle of (x, y) from the x axis, divided by 2π, plus ½; x and y are given with their
/// gradients.
fn turn(x: Coordinate, y: Coordinate) -> Coordinate {
    let square = x.0 * x.0 + y.0 * y.0;
    if !(square > f64::MIN_POSITIVE && square < f64::INFINITY) {
        return (0.5, DVec3::ZERO);
    }
    let gradient = (x.0 * y.1 - y.0 * x.1) / (square * TAU);
    (libm::atan2(y.0, x.0) / TAU + 0.5, gradient)
}

/// Longitude and latitude on spheres around `center`.
///
/// ```
/// use glam::{DVec2, DVec3};
/// assert_eq!(texture::uv::sphere(DVec3::ZERO, DVec3::Z).at, DVec2::splat(0.5));
/// assert_eq!(texture::uv::sphere(DVec3::ZERO, DVec3::X).at, DVec2::new(0.75, 0.5));
/// assert_eq!(texture::uv::sphere(DVec3::ZERO, DVec3::Y).at.y, 1.0);
/// ```
#[must_use]
pub fn sphere(center: DVec3, point: DVec3) -> Uv {
    let d = point - center;
    let u = turn((d.z, DVec3::Z), (d.x, DVec3::X));
    let around = (d.x * d.x + d.z * d.z).sqrt();
    let square = d.length_squared();
    let v = if square > f64::MIN_POSITIVE && square < f64::INFINITY {
        let outward = if around > 0.0 {
            DVec3::new(d.x, 0.0, d.z) / around
        } else {
            DVec3::ZERO
        };
        (
            libm::atan2(d.y, around) / PI + 0.5,
            (around * DVec3::Y - d.y * outward) / (square * PI),
        )
    } else {
        (0.5, DVec3::ZERO)
    };
    Uv::new(u, v)
}

/// Along and around the segment from `base` to `apex`; of one without length u is 0 and v goes
/// around y.
///
/// ```
/// use glam::{DVec2, DVec3};
/// let uv = texture::uv::segment(DVec3::ZERO, 4.0 * DVec3::Y, DVec3::new(0.0, 1.0, 0.2));
/// assert_eq!(uv.at, DVec2::new(0.25, 0.5)); // a quarter up, in front
/// ```
#[must_use]
pub fn segment(base: DVec3, apex: DVec3, point: DVec3) -> Uv {
    let axis = apex - base;
    let length = axis.length();
    let (unit, along) = if length > 0.0 && length < f64::INFINITY {
        (axis / length, 1.0 / length)
    } else {
        (DVec3::Y, 0.0)
    };
    let d = point - base;
    let front = upright(DVec3::Z, DVec3::Y, unit);
    let side = unit.cross(front);
    let u = cut((d.dot(unit) * along, unit * along));
    Uv::new(u, turn((d.dot(front), front), (d.dot(side), side)))
}

/// An arc: the points `center + sweep·(cos t·u + sin t·v)`, 0 ≤ t ≤ angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre of the circle.
    pub center: DVec3,
    /// Unit vector towards the start.
    pub u: DVec3,
    /// Unit vector perpendicular to `u`, towards which the arc turns.
    pub v: DVec3,
    /// Radius of the circle.
    pub sweep: f64,
    /// Angle swept, radians, in (0, 2π].
    pub angle: f64,
}

/// Along and around an arc. u jumps from 1 to 0 in the middle of the gap, or where a whole circle
/// closes.
#[must_use]
pub fn arc(arc: &Arc, point: DVec3) -> Uv {
    let d = point - arc.center;
    let axis = arc.u.cross(arc.v);
    let (x, y, z) = (d.dot(arc.u), d.dot(arc.v), d.dot(axis));
    // Measured from the middle of the arc, so that the jump is opposite.
    let half = 0.5 * arc.angle;
    let (s, c) = libm::sincos(half);
    let (middle, beyond) = (c * arc.u + s * arc.v, c * arc.v - s * arc.u);
    let (mx, my) = (d.dot(middle), d.dot(beyond));
    let (angle, slope) = turn((mx, middle), (my, beyond));
    let u = if arc.angle > 0.0 && arc.angle < f64::INFINITY {
        let share = TAU / arc.angle;
        cut(((angle - 0.5) * share + 0.5, slope * share))
    } else {
        (0.0, DVec3::ZERO)
    };
    // In the half plane through the axis: out from the circle, and up along the axis.
    let around = (x * x + y * y).sqrt();
    let outward = if around > 0.0 {
        (x * arc.u + y * arc.v) / around
    } else {
        DVec3::ZERO
    };
    Uv::new(u, turn((around - arc.sweep, outward), (z, axis)))
}

/// Barycentric shares of the second and third corner, of the point's foot in the triangle's plane.
/// 0 if the triangle has no area.
#[must_use]
pub fn triangle(corners: [DVec3; 3], point: DVec3) -> Uv {
    let [a, b, c] = corners;
    let (right, up) = (b - a, c - a);
    let across = right.cross(up);
    let area = across.length_squared();
    if !(area > f64::MIN_POSITIVE && area < f64::INFINITY) {
        return Uv::default();
    }
    let gradients = [up.cross(across) / area, across.cross(right) / area];
    let d = point - a;
    Uv::new(
        cut((d.dot(gradients[0]), gradients[0])),
        cut((d.dot(gradients[1]), gradients[1])),
    )
}

/// Distances in a plane from `origin`, in units of space, not cut: an image repeats once a unit.
#[must_use]
pub fn plane(origin: DVec3, normal: DVec3, point: DVec3) -> Uv {
    let normal = normal.normalize_or(DVec3::Y);
    let right = upright(DVec3::X, DVec3::Y, normal);
    let up = normal.cross(right);
    let d = point - origin;
    Uv::new((d.dot(right), right), (d.dot(up), up))
}

/// Flat sheet whose coordinates are those of [`plane`], stretched so that they go from 0 to 1 over
/// the rectangle around given corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Point at which u and v are 0.
    origin: DVec3,
    gradient: [DVec3; 2],
}

impl Sheet {
    /// The sheet around a polygon's corners. `None` if there are no corners or they have no extent
    /// in one direction.
    #[must_use]
    pub fn around(corners: &[DVec3], normal: DVec3) -> Option<Self> {
        let first = *corners.first()?;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &corner in corners {
            let at = plane(first, normal, corner).at;
            (low, high) = (low.min(at), high.max(at));
        }
        let size = high - low;
        let [u, v] = plane(first, normal, first).gradient;
        (size.min_element() > 0.0 && size.is_finite()).then(|| Self {
            origin: first + low.x * u + low.y * v,
            gradient: [u / size.x, v / size.y],
        })
    }

    /// Coordinates of a point's foot on the sheet, not cut.
    #[must_use]
    pub fn uv(&self, point: DVec3) -> Uv {
        let d = point - self.origin;
        Uv {
            at: DVec2::new(d.dot(self.gradient[0]), d.dot(self.gradient[1])),
            gradient: self.gradient,
        }
    }
}

/// Coordinates from 0 to 1 over each face of a box, the points `center + Σ sᵢ·axisᵢ`, −1 ≤ sᵢ ≤ 1.
/// The face is the one nearest in shares of the axes; seen from outside, with the second axis up, u
/// goes to the right. On the faces of the second axis the third goes down. 0 if the axes span no
/// volume.
#[must_use]
pub fn cuboid(center: DVec3, axes: [DVec3; 3], point: DVec3) -> Uv {
    let [a, b, c] = axes;
    let volume = a.dot(b.cross(c));
    if !(volume != 0.0 && volume.is_finite()) {
        return Uv::default();
    }
    let gradients = [b.cross(c), c.cross(a), a.cross(b)].map(|g| g / volume);
    let s = gradients.map(|g| g.dot(point - center));
    let size = s.map(f64::abs);
    let share = |i: usize, sign: f64| cut((0.5 + 0.5 * sign * s[i], 0.5 * sign * gradients[i]));
    if size[2] >= size[0] && size[2] >= size[1] {
        Uv::new(share(0, f64::signum(s[2])), share(1, 1.0))
    } else if size[0] >= size[1] {
        Uv::new(share(2, -f64::signum(s[0])), share(1, 1.0))
    } else {
        Uv::new(share(0, 1.0), share(2, -f64::signum(s[1])))
    }
}
