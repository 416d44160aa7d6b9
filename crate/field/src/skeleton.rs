//! The bones: geometry of dimension 0, 1 and 2. All that is known of one stands in its file.
mod arc;
mod curve;
mod plane;
mod point;
mod polygon;
mod segment;
mod triangle;

pub(crate) use arc::orthonormal;
pub use curve::{cubic, halves};
use curve::{length, nearest_along};
pub use polygon::{area_vector, ring_vector};
pub(crate) use segment::nearest as nearest_on_segment;

use crate::Kernel;
use crate::bone::{self, Bone};
use crate::term::{Frame, frame};
use glam::{DAffine3, DMat3, DVec3};
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

/// Writes the trait of a bone's geometry, which the file of each bone implements, and the methods
/// of [`Skeleton`] that ask it.
macro_rules! geometry {
    (
        each {$(
            $(#[$doc:meta])*
            $vis:vis fn $name:ident(&$own:ident $(, $arg:ident: $type:ty)*) -> $out:ty;
        )+}
        most {$(
            $(#[$doc_:meta])*
            $vis_:vis fn $name_:ident(&$own_:ident $(, $arg_:ident: $type_:ty)*) -> $out_:ty
            $body:block
        )+}
    ) => {
        /// Geometry of a bone.
        trait Geometry {
            $($(#[$doc])* fn $name(&$own $(, $arg: $type)*) -> $out;)+
            $($(#[$doc_])* fn $name_(&$own_ $(, $arg_: $type_)*) -> $out_ $body)+
        }

        impl Skeleton {
            $($(#[$doc])* #[must_use]
            $vis fn $name(&$own $(, $arg: $type)*) -> $out {
                $own.with(|bone| bone.$name($($arg),*))
            })+
            $($(#[$doc_])* #[must_use]
            $vis_ fn $name_(&$own_ $(, $arg_: $type_)*) -> $out_ {
                $own_.with(|bone| bone.$name_($($arg_),*))
            })+
        }
    };
}

geometry! {
    each {
        /// Returns the bone's name: "point", "segment" …
        pub fn name(&self) -> &'static str;
        /// Returns 0 for points, 1 for segments, arcs and curves, 2 for triangles, polygons and
        /// planes.
        pub fn dimension(&self) -> u8;
        /// Returns a place in the bone's middle.
        pub fn middle(&self) -> DVec3;
        /// Returns the points by which it is given, or by which a person knows it, with their
        /// names.
        pub fn landmarks(&self) -> Vec<(DVec3, &'static str)>;
        /// Maps the bone.
        pub fn transform(&self, map: &dyn Map) -> Skeleton;
    }

    most {
        /// Computes length or area; 1 for a point, infinite for a plane.
        pub fn measure(&self) -> f64 {
            self.cubics(0.0).into_iter().map(length).sum()
        }

        /// Computes the point nearest to `point` (one of them, where there are several).
        pub fn nearest(&self, point: DVec3) -> DVec3 {
            nearest_along(|share| self.at(share), point)
        }

        /// Returns a sphere (centre, radius) that holds the bone; `None` for a plane.
        pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
            Some(ball_around(self.cubics(0.0).iter().flatten()))
        }

        /// Computes a length that is not less than [`Skeleton::measure`], and fast: that of a
        /// curve's control polygon.
        pub fn most_length(&self) -> f64 {
            self.measure()
        }

        /// Returns a length that with the width parameter tells how many kernel widths large it is.
        pub(crate) fn size(&self) -> f64 {
            self.bounding_sphere().map_or(0.0, |(_, radius)| 2.0 * radius)
        }

        /// Returns the lowest and the highest corner of a box that holds all within `radius` of the
        /// bone; `None` for a plane. NaN if a coordinate is NaN.
        pub fn bounds(&self, radius: f64) -> Option<(DVec3, DVec3)> {
            let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let points: Vec<DVec3> = if self.is_numeric() {
                self.cubics(0.0).into_iter().flatten().collect()
            } else {
                self.landmarks().into_iter().map(|(p, _)| p).collect()
            };
            for p in points {
                if p.is_nan() {
                    return Some((DVec3::NAN, DVec3::NAN));
                }
                (low, high) = (low.min(p - radius), high.max(p + radius));
            }
            Some((low, high))
        }

        /// Whether its field is integrated numerically with every kernel, from its cubics.
        pub fn is_numeric(&self) -> bool {
            false
        }

        /// Whether no coordinate or radius is larger than a limit, or not finite.
        pub fn is_within(&self, limit: f64) -> bool {
            self.landmarks().iter().all(|(p, _)| fits(*p, limit))
        }

        /// Whether all its numbers are finite and its radius, if any, is not negative.
        pub fn is_finite(&self) -> bool {
            self.is_within(f64::MAX)
        }

        /// Returns how it falls short of its dimension, as what follows on "this" and a noun;
        /// `None` if it does not.
        pub fn fault(&self) -> Option<&'static str> {
            None
        }

        /// Computes the point of a line at a share of its parameter; the middle of others.
        pub fn at(&self, share: f64) -> DVec3 {
            let _ = share;
            self.middle()
        }

        /// Computes the unit tangent of a line at a share of its parameter.
        pub fn tangent(&self, share: f64) -> Option<DVec3> {
            let _ = share;
            None
        }

        /// Computes the unit normal of a face.
        pub fn normal(&self) -> Option<DVec3> {
            None
        }

        /// Returns points of the bone, as many as suit a quick look at its field.
        pub fn samples(&self) -> Vec<DVec3> {
            let steps = if self.dimension() == 1 { 8 } else { 0 };
            (0..=steps).map(|i| self.at(f64::from(i) / 8.0)).collect()
        }

        /// Returns the lines by which it is drawn, each through some points. `size` is the length
        /// of lines for bones without a size: a cross at a point (0.3 times as long), a piece of a
        /// plane.
        pub fn lines(&self, size: f64) -> Vec<Vec<DVec3>> {
            match self.dimension() {
                0 => cross(self.middle(), size),
                _ => vec![(0..=64).map(|i| self.at(f64::from(i) / 64.0)).collect()],
            }
        }

        /// Returns the piece of a line between two shares of its parameter; `None` for others.
        pub fn part(&self, from: f64, to: f64) -> Option<Skeleton> {
            let _ = (from, to);
            None
        }

        /// Computes the local frame and the bone in it, for a kernel and its width parameter s.
        pub(crate) fn place(&self, kernel: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
            let origin = self.middle();
            let [fine, coarse] = [0.0, s].map(|accuracy| -> Vec<_> {
                let cubics = self.cubics(accuracy).into_iter();
                let local = cubics.map(|control| cubic(control.map(|p| (p - origin) * s)));
                local.collect()
            });
            let curve = bone::Curve::new(kernel, &fine, &coarse, None);
            (frame(origin, DMat3::IDENTITY, s), Bone::Curve(Box::new(curve)))
        }

        /// Returns cubic Bézier curves that together are a line: as close to it as double precision
        /// needs for s = 0, as single precision needs for a width parameter s. None for others.
        pub(crate) fn cubics(&self, s: f64) -> Vec<[DVec3; 4]> {
            let _ = s;
            Vec::new()
        }
    }
}

impl Skeleton {
    /// Calls a function with the bone's geometry.
    fn with<T>(&self, f: impl FnOnce(&dyn Geometry) -> T) -> T {
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

    /// Distance of a point from the skeleton.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        (point - self.nearest(point)).length()
    }
}

/// Whether a place is finite, and no coordinate larger than a limit.
#[must_use]
pub fn fits(place: DVec3, limit: f64) -> bool {
    place.abs().max_element() <= limit && place.is_finite()
}

/// Finds the place that is nearest to a point.
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
