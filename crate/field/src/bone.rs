//! The skeleton's geometry in a primitive's local frame, with all that its formulas want prepared.
//!
//! Lengths are in units of the kernel's width (metres times [`Shaping::width`](crate::Shaping::width)).
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

/// A skeletal element in its local frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Bone<S> {
    /// The origin.
    Point,
    /// A segment on the x axis, its middle at the origin.
    Segment(Segment<S>),
    /// An arc in the plane z = 0.
    Arc(Arc<S>),
    /// A triangle in the plane z = 0.
    Triangle(Triangle<S>),
    /// A polygon in the plane z = 0.
    Polygon(Polygon<S>),
    /// The plane z = 0.
    Plane,
    /// A cubic curve, or anything whose width varies along it.
    Curve(Curve<S>),
}

impl<S: Copy> Bone<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Bone<Q> {
        match self {
            Self::Point => Bone::Point,
            Self::Segment(bone) => Bone::Segment(Segment { half: f(bone.half) }),
            Self::Arc(bone) => Bone::Arc(bone.cast(f)),
            Self::Triangle(bone) => Bone::Triangle(bone.cast(f)),
            Self::Polygon(bone) => Bone::Polygon(bone.cast(f)),
            Self::Plane => Bone::Plane,
            Self::Curve(bone) => Bone::Curve(bone.cast(f)),
        }
    }
}
