//! The bones: geometry of dimension 0, 1 and 2.
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A skeletal element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Skeleton {
    /// A point.
    Point {
        /// Where.
        center: DVec3,
    },
    /// A line segment.
    Segment {
        /// One end.
        base: DVec3,
        /// The other end.
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
        /// Its corners.
        corners: [DVec3; 3],
    },
    /// An infinite plane.
    Plane {
        /// A point of it.
        point: DVec3,
        /// Its unit normal.
        normal: DVec3,
    },
}
