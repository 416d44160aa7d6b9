//! The bones: geometry of dimension 0, 1 and 2. All that is known of one stands in its file.
mod arc;
mod curve;
mod plane;
mod point;
mod polygon;
mod segment;
mod triangle;

pub use curve::{cubic, halves};
pub use polygon::{area_vector, ring_vector};
pub(crate) use segment::nearest as nearest_on_segment;

use crate::Kernel;
use crate::bone::Bone;
use crate::term::Frame;
use glam::{DAffine3, DVec3};
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

/// A map of space that bones and shapes follow, each of which stays of its kind.
pub trait Map {
    /// Maps a point.
    fn point(&self, point: DVec3) -> DVec3;
    /// Maps a difference of points.
    fn vector(&self, vector: DVec3) -> DVec3;
    /// Maps the unit normal of a surface to that of its image.
    fn normal(&self, normal: DVec3) -> DVec3;
    /// Maps two unit vectors that are perpendicular to each other to two such.
    fn axes(&self, axes: [DVec3; 2]) -> [DVec3; 2];
    /// Maps a radius.
    fn length(&self, length: f64) -> f64;
    /// Returns the map of points as an affine map.
    fn affine(&self) -> DAffine3;
}

/// Geometry of a bone; see [`Skeleton`]'s methods of the same names.
pub(crate) trait Geometry {
    fn name(&self) -> &'static str;

    fn dimension(&self) -> u8;

    fn measure(&self) -> f64;

    fn most_length(&self) -> f64 {
        self.measure()
    }

    /// Returns a length from which the number of kernel widths across the bone follows.
    fn size(&self) -> f64 {
        self.bounding_sphere().map_or(0.0, |(_, r)| 2.0 * r)
    }

    fn nearest(&self, point: DVec3) -> DVec3;

    fn bounding_sphere(&self) -> Option<(DVec3, f64)>;

    fn bounds(&self, radius: f64) -> Option<(DVec3, DVec3)> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (p, _) in self.landmarks() {
            if p.is_nan() {
                return Some((DVec3::NAN, DVec3::NAN));
            }
            (low, high) = (low.min(p - radius), high.max(p + radius));
        }
        Some((low, high))
    }

    fn middle(&self) -> DVec3;

    fn landmarks(&self) -> Vec<(DVec3, &'static str)>;

    fn is_within(&self, limit: f64) -> bool {
        self.landmarks().iter().all(|(p, _)| fits(*p, limit))
    }

    fn is_finite(&self) -> bool {
        self.is_within(f64::MAX)
    }

    fn fault(&self) -> Option<&'static str> {
        None
    }

    fn at(&self, share: f64) -> DVec3 {
        let _ = share;
        self.middle()
    }

    fn tangent(&self, share: f64) -> Option<DVec3> {
        let _ = share;
        None
    }

    fn normal(&self) -> Option<DVec3> {
        None
    }

    fn samples(&self) -> Vec<DVec3> {
        (0..=8).map(|i| self.at(f64::from(i) / 8.0)).collect()
    }

    fn polyline(&self, size: f64) -> Vec<Vec<DVec3>>;

    fn mapped(&self, map: &dyn Map) -> Skeleton;

    fn part(&self, from: f64, to: f64) -> Option<Skeleton> {
        let _ = (from, to);
        None
    }

    /// Computes the local frame and the bone in it, for a kernel and its width parameter s.
    fn place(&self, kernel: Kernel, s: f64) -> (Frame<f64>, Bone<f64>);

    /// Returns cubic Bézier curves that together are a line: as close to it as double precision
    /// needs for s = 0, as single precision needs for a width parameter s. None for others.
    fn cubics(&self, s: f64) -> Vec<[DVec3; 4]> {
        let _ = s;
        Vec::new()
    }
}

impl Skeleton {
    /// Calls a function with the bone's geometry.
    pub(crate) fn with<T>(&self, f: impl FnOnce(&dyn Geometry) -> T) -> T {
        match *self {
            Self::Point { center } => f(&point::Point { center }),
            Self::Segment { base, apex } => f(&segment::Segment { base, apex }),
            Self::Arc {
                center,
                u,
                v,
                radius,
                angle,
            } => f(&arc::Arc {
                center,
                u,
                v,
                radius,
                angle,
            }),
            Self::Triangle { corners } => f(&triangle::Triangle { corners }),
            Self::Polygon { ref rings } => f(&polygon::Polygon { rings }),
            Self::Curve { control } => f(&curve::Curve { control }),
            Self::Plane { point, normal } => f(&plane::Plane { point, normal }),
        }
    }

    /// Returns the bone's name: "point", "segment" …
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.with(|bone| bone.name())
    }

    /// Returns 0 for points, 1 for segments, arcs and curves, 2 for triangles, polygons and planes.
    #[must_use]
    pub fn dimension(&self) -> u8 {
        self.with(|bone| bone.dimension())
    }

    /// Length or area; 1 for a point, infinite for a plane.
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.with(|bone| bone.measure())
    }

    /// Computes a length that is not less than [`Skeleton::measure`], and fast: that of a curve's
    /// control polygon.
    #[must_use]
    pub fn most_length(&self) -> f64 {
        self.with(|bone| bone.most_length())
    }

    /// The point of the skeleton nearest to `point` (one of them, where there are several).
    #[must_use]
    pub fn nearest(&self, point: DVec3) -> DVec3 {
        self.with(|bone| bone.nearest(point))
    }

    /// Distance of a point from the skeleton.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        (point - self.nearest(point)).length()
    }

    /// Returns a sphere (centre, radius) that holds the skeleton; `None` for a plane.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        self.with(|bone| bone.bounding_sphere())
    }

    /// Returns the lowest and the highest corner of a box that holds all within `radius` of the
    /// bone; `None` for a plane. NaN if a coordinate is NaN.
    #[must_use]
    pub fn bounds(&self, radius: f64) -> Option<(DVec3, DVec3)> {
        self.with(|bone| bone.bounds(radius))
    }

    /// Returns a place in the bone's middle.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        self.with(|bone| bone.middle())
    }

    /// Returns the points by which it is given, or by which a person knows it, each with a name.
    #[must_use]
    pub fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        self.with(|bone| bone.landmarks())
    }

    /// Whether no coordinate or radius is larger than a limit, or not finite.
    #[must_use]
    pub fn is_within(&self, limit: f64) -> bool {
        self.with(|bone| bone.is_within(limit))
    }

    /// Whether all its numbers are finite and its radius, if any, is not negative.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.with(|bone| bone.is_finite())
    }

    /// Returns how it falls short of its dimension, as what follows on "this" and a noun; `None` if
    /// it does not.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        self.with(|bone| bone.fault())
    }

    /// Computes the point of a line at a share of its parameter; the middle of others.
    #[must_use]
    pub fn at(&self, share: f64) -> DVec3 {
        self.with(|bone| bone.at(share))
    }

    /// Computes the unit tangent of a line at a share of its parameter.
    #[must_use]
    pub fn tangent(&self, share: f64) -> Option<DVec3> {
        self.with(|bone| bone.tangent(share))
    }

    /// Computes the unit normal of a face.
    #[must_use]
    pub fn normal(&self) -> Option<DVec3> {
        self.with(|bone| bone.normal())
    }

    /// Returns points of the bone, as many as suit a quick look at its field.
    #[must_use]
    pub fn samples(&self) -> Vec<DVec3> {
        self.with(|bone| bone.samples())
    }

    /// Returns the lines by which it is drawn, each through some points. `size` is the length of
    /// lines for bones without a size: half a cross at a point, a piece of a plane.
    #[must_use]
    pub fn polyline(&self, size: f64) -> Vec<Vec<DVec3>> {
        self.with(|bone| bone.polyline(size))
    }

    /// Maps the bone.
    #[must_use]
    pub fn mapped(&self, map: &dyn Map) -> Self {
        self.with(|bone| bone.mapped(map))
    }

    /// Returns the piece of a line between two shares of its parameter; `None` for others.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Option<Self> {
        self.with(|bone| bone.part(from, to))
    }
}

/// Whether a place is finite, and no coordinate larger than a limit.
fn fits(place: DVec3, limit: f64) -> bool {
    place.abs().max_element() <= limit && place.is_finite()
}

/// The one of some places that is nearest to a point.
fn nearest_of(point: DVec3, places: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    places.min_by(|p, q| {
        p.distance_squared(point)
            .total_cmp(&q.distance_squared(point))
    })
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

/// Returns three lines across each other, 0.3 times as long as `size`.
#[must_use]
pub fn cross(center: DVec3, size: f64) -> Vec<Vec<DVec3>> {
    let half = 0.15 * size;
    [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|axis| vec![center - axis * half, center + axis * half])
        .to_vec()
}
