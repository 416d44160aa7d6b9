//! Shapes placed in the world.
//!
//! All coordinates are world coordinates: objects and their transforms are already applied.

use crate::{Curves, Function, Quadric, Rgb};
use field::Kernel;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Shape with its softness and its look. The indices point into the lists of the
/// [`Scene`](crate::Scene).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Element {
    /// The geometry, in the world's coordinates.
    pub shape: Shape,
    /// Index into [`Scene::flesh`](crate::Scene::flesh); `None` for a hard element.
    pub flesh: Option<u32>,
    /// Index into [`Scene::finishes`](crate::Scene::finishes).
    pub finish: u32,
    /// Index into [`Scene::bodies`](crate::Scene::bodies).
    pub body: u32,
    /// Index into [`Scene::frames`](crate::Scene::frames).
    pub frame: u32,
    /// The kernel, unless the flesh names one.
    pub kernel: Kernel,
    /// Place in the text of the command that made the element.
    pub origin: Origin,
    /// Colours at the corners of a triangle or patch; `None` for other shapes, and where the finish
    /// says all.
    pub paint: Option<Box<Paint>>,
}

impl Element {
    /// Returns a hard element with the first finish, in the body without a name and the world's
    /// frame.
    #[must_use]
    pub fn new(shape: Shape) -> Self {
        Self {
            shape,
            flesh: None,
            finish: 0,
            body: 0,
            frame: 0,
            kernel: Kernel::Cauchy,
            origin: Origin::default(),
            paint: None,
        }
    }
}

/// Colours at the corners of a triangle, mixed linearly within it. [`Element::finish`] has about
/// their mean, for what cannot mix colours within a triangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Paint {
    /// Index into [`Scene::finishes`](crate::Scene::finishes): the finish whose `ambient` and
    /// `diffuse` the colours multiply.
    pub finish: u32,
    /// The colours, in the order of the shape's corners; each channel 0 to 1.
    pub corners: [Rgb; 3],
}

/// Origin of an element: a byte range of one of the project's files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Origin {
    /// Index of the file in the compiler's file list.
    pub file: u32,
    /// First byte of the command.
    pub start: u32,
    /// End of the command: one past its last byte.
    pub end: u32,
}

/// Shape. When soft, its axis, arc, face or plane is the skeleton; when hard, it is drawn as its
/// offset surface at [`Shape::radius`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// Ball. Soft: a point.
    Sphere {
        /// Centre.
        center: DVec3,
        /// Radius, > 0.
        radius: f64,
    },
    /// Cylinder with flat lids. Soft: a line segment.
    Cylinder {
        /// Start of the axis.
        base: DVec3,
        /// End of the axis.
        apex: DVec3,
        /// Radius, > 0.
        radius: f64,
    },
    /// Piece of a torus with flat lids: the points `center + sweep·(cos t·u + sin t·v)`,
    /// `0 ≤ t ≤ angle`, thickened. Soft: the arc itself.
    Arc {
        /// Centre of the circle.
        center: DVec3,
        /// Unit vector towards the start of the arc.
        u: DVec3,
        /// Unit vector perpendicular to `u`, towards which the arc turns.
        v: DVec3,
        /// Radius of the circle, > 0.
        sweep: f64,
        /// Angle swept, radians, in (0, 2π].
        angle: f64,
        /// Radius of the tube, > 0.
        radius: f64,
    },
    /// Flat triangle; hard with a blobbiness and `soft off`, a prism of thickness `2·radius`.
    Triangle {
        /// Corners.
        corners: [DVec3; 3],
        /// Half the thickness; 0 for a plain flat triangle.
        radius: f64,
    },
    /// Planar polygon with holes; as an offset surface, a prism of thickness `2·radius`.
    Polygon {
        /// Corners of the outer ring, then of the holes; each ring has at least three.
        rings: Vec<Vec<DVec3>>,
        /// Half the thickness; 0 for a plain flat polygon.
        radius: f64,
    },
    /// Tube around a cubic Bézier curve, round at its ends. Soft: the curve itself.
    Curve {
        /// Control points.
        control: [DVec3; 4],
        /// Radius of the tube, > 0.
        radius: f64,
    },
    /// An infinite plane; as an offset surface, a slab of thickness `2·radius`.
    Plane {
        /// Point of the plane.
        point: DVec3,
        /// Unit normal.
        normal: DVec3,
        /// Half the thickness; 0 for a plain plane.
        radius: f64,
    },
    /// Cone cut off at both ends, with flat lids. Soft: a line segment whose radius in isolation
    /// varies evenly from one end to the other.
    Cone {
        /// Start of the axis.
        base: DVec3,
        /// The radius there, ≥ 0.
        base_radius: f64,
        /// End of the axis.
        apex: DVec3,
        /// The radius there, ≥ 0; at least one of the two is > 0.
        apex_radius: f64,
    },
    /// The wall of a cylinder, without lids. Soft: a line segment.
    Pipe {
        /// Start of the axis.
        base: DVec3,
        /// End of the axis.
        apex: DVec3,
        /// Radius, > 0.
        radius: f64,
    },
    /// Box that may be turned and sheared: the points `center + Σ sᵢ·axisᵢ`, −1 ≤ sᵢ ≤ 1. It has
    /// no skeleton and stays hard.
    Box {
        /// Middle.
        center: DVec3,
        /// Vectors from the middle to the middles of three faces; they span a volume.
        axes: [DVec3; 3],
    },
    /// Flat triangle that is lit as if it were curved (Phong's interpolation of normals). Soft:
    /// the flat triangle.
    Patch {
        /// Corners.
        corners: [DVec3; 3],
        /// The normals that light sees at the corners; any length but 0.
        normals: [DVec3; 3],
    },
    /// Piece of a surface of the second degree. It has no skeleton and stays hard.
    Quadric(Box<Quadric>),
    /// Function of space, soft without any flesh. It has no skeleton.
    Function(Box<Function>),
}

impl Shape {
    /// The shape's own radius (its tube, ball or half thickness; of a cone, the larger one). 0 for
    /// what has none.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match *self {
            Self::Sphere { radius, .. }
            | Self::Cylinder { radius, .. }
            | Self::Arc { radius, .. }
            | Self::Triangle { radius, .. }
            | Self::Polygon { radius, .. }
            | Self::Curve { radius, .. }
            | Self::Plane { radius, .. }
            | Self::Pipe { radius, .. } => radius,
            Self::Cone {
                base_radius,
                apex_radius,
                ..
            } => base_radius.max(apex_radius),
            Self::Box { .. } | Self::Patch { .. } | Self::Quadric(_) | Self::Function(_) => 0.0,
        }
    }

    /// The shape's curves, if it is a skeleton of such.
    #[must_use]
    pub fn curves(&self) -> Option<&Curves> {
        match self {
            Self::Function(function) => function.curves(),
            _ => None,
        }
    }

    /// Whether the shape can be convolved. Shapes without a skeleton stay as they are with any
    /// material.
    #[must_use]
    pub fn has_skeleton(&self) -> bool {
        !matches!(
            self,
            Self::Box { .. } | Self::Quadric(_) | Self::Function(_)
        )
    }
}
