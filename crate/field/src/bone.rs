//! The skeleton's geometry in a primitive's local frame, with everything that does not depend on
//! the point precomputed.
//!
//! Lengths are in units of the kernel's width (metres times
//! [`Shaping::width`](crate::Shaping::width)).
pub mod arc;
pub mod curve;
pub mod polygon;
pub mod segment;
pub mod triangle;

pub use arc::Arc;
pub use curve::Curve;
pub use polygon::{Edge, Polygon};
pub use segment::Segment;
pub use triangle::Triangle;

/// Bone in its local frame. The common small kinds (points, segments, arcs) are
/// stored inline; the larger ones are boxed, so that a scene of a million points stays small.
#[derive(Clone, Debug, PartialEq)]
pub enum Bone<S> {
    /// The origin.
    Point,
    /// A segment on the x axis, its middle at the origin.
    Segment(Segment<S>),
    /// An arc in the plane z = 0.
    Arc(Arc<S>),
    /// A triangle in the plane z = 0.
    Triangle(Box<Triangle<S>>),
    /// A polygon in the plane z = 0.
    Polygon(Box<Polygon<S>>),
    /// The plane z = 0.
    Plane,
    /// A cubic curve, or anything whose width varies along it.
    Curve(Box<Curve<S>>),
}

impl<S: Copy> Bone<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Bone<Q> {
        match self {
            Self::Point => Bone::Point,
            Self::Segment(bone) => Bone::Segment(Segment { half: f(bone.half) }),
            Self::Arc(bone) => Bone::Arc(bone.cast(f)),
            Self::Triangle(bone) => Bone::Triangle(Box::new(bone.cast(f))),
            Self::Polygon(bone) => Bone::Polygon(Box::new(bone.cast(f))),
            Self::Plane => Bone::Plane,
            Self::Curve(bone) => Bone::Curve(Box::new(bone.cast(f))),
        }
    }
}
