//! Boxes whose faces are parallel to the axes.

use glam::DVec3;

/// Closed box with faces parallel to the axes.
///
/// ```
/// use glam::DVec3;
/// use mesh::Aabb;
///
/// let unit = Aabb::of_points([DVec3::ZERO, DVec3::ONE]);
/// assert!(unit.overlaps(&Aabb::of_points([DVec3::ONE, DVec3::splat(2.0)])));
/// assert_eq!(unit.distance_squared(DVec3::new(3.0, 0.5, 0.5)), 4.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box without points: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// The smallest box that contains all points; empty without points.
    #[must_use]
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| Self {
            min: bounds.min.min(p),
            max: bounds.max.max(p),
        })
    }

    /// `true` if the box contains no point, or a coordinate is NaN.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The smallest box that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// `true` if the boxes have a point in common; touching counts. An empty box has none.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        // An empty box compares as if it were within one without bounds.
        self.min.cmple(other.max).all()
            && other.min.cmple(self.max).all()
            && !self.is_empty()
            && !other.is_empty()
    }

    /// The middle; not finite for an empty box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Lengths of the edges; 0 for an empty box.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        if self.is_empty() {
            DVec3::ZERO
        } else {
            self.max - self.min
        }
    }

    /// Squared distance of a point from the box: 0 inside, infinite from an empty box.
    #[must_use]
    pub fn distance_squared(&self, point: DVec3) -> f64 {
        if self.is_empty() {
            return f64::INFINITY;
        }
        let outside = (self.min - point).max(point - self.max).max(DVec3::ZERO);
        outside.length_squared()
    }

    /// Half the surface area, the cost measure of a hierarchy: 0 for an empty box.
    pub(crate) fn half_area(&self) -> f64 {
        let size = self.size();
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}
