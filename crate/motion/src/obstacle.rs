//! Obstacles, which stand still: floors, walls, boxes, balls, rods.

use crate::LARGEST;
use glam::DVec3;

/// Solid that bodies cannot enter.
#[derive(Clone, Debug, PartialEq)]
pub enum Obstacle {
    /// Half-space below a plane; the normal is a unit vector that points to where bodies may be.
    Plane {
        /// Point of the plane.
        point: DVec3,
        /// Unit normal, away from the half-space.
        normal: DVec3,
    },
    /// Box with right angles.
    Box {
        /// Middle of the box.
        center: DVec3,
        /// Vectors from the middle to the middles of three faces; perpendicular to each other.
        axes: [DVec3; 3],
    },
    /// Rod with round ends, whose radius varies evenly along it; a ball if its ends are one point.
    Rod {
        /// Ends of the rod's axis.
        ends: [DVec3; 2],
        /// Radii at the ends.
        radii: [f64; 2],
    },
}

impl Obstacle {
    /// Signed distance of a point from the surface, negative inside, and the direction in which it
    /// grows. Of a rod that tapers an approximation that is exact at its surface's widest part.
    ///
    /// ```
    /// use glam::DVec3;
    /// use motion::Obstacle;
    ///
    /// let axes = [DVec3::X * 2.0, DVec3::Y, DVec3::Z];
    /// let step = Obstacle::Box { center: DVec3::ZERO, axes };
    /// assert_eq!(step.distance(DVec3::new(0.0, 1.5, 0.0)), (0.5, DVec3::Y));
    /// assert_eq!(step.distance(DVec3::new(1.9, 0.0, 0.0)), (2.0 * 0.95 - 2.0, DVec3::X));
    /// ```
    #[must_use]
    pub fn distance(&self, p: DVec3) -> (f64, DVec3) {
        match self {
            Self::Plane { point, normal } => ((p - *point).dot(*normal), *normal),
            Self::Box { center, axes } => to_box(p - *center, axes),
            Self::Rod { ends, radii } => {
                let [a, b] = *ends;
                let along = foot(p, a, b);
                let away = p - a.lerp(b, along);
                let radius = radii[0] + (radii[1] - radii[0]) * along;
                let distance = away.length();
                (distance - radius, away.try_normalize().unwrap_or(DVec3::Y))
            }
        }
    }

    /// Returns a ball around it, if it has an end; a little larger than need be.
    fn ball(&self) -> Option<(DVec3, f64)> {
        let (center, radius) = match self {
            Self::Plane { .. } => return None,
            Self::Box { center, axes } => {
                let square: f64 = axes.iter().map(|axis| axis.length_squared()).sum();
                (*center, square.sqrt())
            }
            Self::Rod {
                ends: [a, b],
                radii,
            } => (
                a.midpoint(*b),
                0.5 * a.distance(*b) + radii[0].max(radii[1]),
            ),
        };
        Some((center, radius * (1.0 + 1e-6)))
    }

    /// Whether all numbers are finite and not too large, and normals have the length 1.
    #[must_use]
    pub(crate) fn is_usable(&self) -> bool {
        match self {
            Self::Plane { point, normal } => fits(point) && (normal.length() - 1.0).abs() < 1e-6,
            Self::Box { center, axes } => {
                fits(center) && axes.iter().all(|a| fits(a) && a.length() > 0.0)
            }
            Self::Rod { ends, radii } => {
                ends.iter().all(fits) && radii.iter().all(|r| (0.0..=LARGEST).contains(r))
            }
        }
    }
}

/// Whether no coordinate is larger than [`LARGEST`], or NaN.
pub(crate) fn fits(v: &DVec3) -> bool {
    v.to_array().into_iter().all(|x| x.abs() <= LARGEST)
}

/// An obstacle and the ball around it, so that most samples need no look at more than that.
#[derive(Clone, Debug)]
pub struct Standing {
    pub obstacle: Obstacle,
    ball: Option<(DVec3, f64)>,
}

impl Standing {
    pub fn new(obstacle: &Obstacle) -> Self {
        Self {
            ball: obstacle.ball(),
            obstacle: obstacle.clone(),
        }
    }

    /// Whether a ball is surely outside.
    pub fn is_clear_of(&self, point: DVec3, radius: f64) -> bool {
        self.ball.is_some_and(|(center, around)| {
            let reach = around + radius;
            point.distance_squared(center) > reach * reach * (1.0 + 1e-6)
        })
    }
}

/// The share of the way from `a` to `b` at which the segment is nearest to `p`.
pub fn foot(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    if square > 0.0 {
        ((p - a).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

fn to_box(p: DVec3, axes: &[DVec3; 3]) -> (f64, DVec3) {
    let mut outside = DVec3::ZERO;
    let mut nearest = (f64::NEG_INFINITY, DVec3::Y);
    for axis in axes {
        let half = axis.length();
        let direction = *axis / half;
        let at = p.dot(direction);
        let (beyond, direction) = if at < 0.0 {
            (-at - half, -direction)
        } else {
            (at - half, direction)
        };
        if beyond > 0.0 {
            outside += direction * beyond;
        }
        if beyond > nearest.0 {
            nearest = (beyond, direction);
        }
    }
    match outside.try_normalize() {
        Some(direction) => (outside.length(), direction),
        None => nearest,
    }
}
