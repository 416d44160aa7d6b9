//! Surfaces of the second degree: ellipsoids, paraboloids, hyperboloids, cones, saddles.
//!
//! Most of them are unbounded, so each is cut off by a box. The box is also what carries the
//! surface into the world: everything is said in coordinates q that go from −1 to 1 across the box,
//! and an affine map takes them to `center + q₀·axes[0] + q₁·axes[1] + q₂·axes[2]`. Moving,
//! turning, scaling and shearing the surface changes the map and leaves the equation as it is.

use crate::Cuboid;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// The points of a box where `q·A·q + 2·b·q + c = 0`; the surface only, without lids on the box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quadric {
    /// Symmetric matrix A.
    pub square: DMat3,
    /// Vector b.
    pub linear: DVec3,
    /// Constant c.
    pub constant: f64,
    /// The middle of the box.
    pub center: DVec3,
    /// Vectors from the middle to the middles of three faces; they span a volume.
    pub axes: [DVec3; 3],
}

impl Quadric {
    /// The part of the surface `x·A·x + 2·b·x + c = 0` between two corners of an axis-parallel box.
    /// Of a matrix that is not symmetric, the symmetric part counts.
    ///
    /// `None` if a number is not finite, if the box has no volume or if the equation is no surface
    /// anywhere because A and b are zero.
    #[must_use]
    pub fn new(
        square: DMat3,
        linear: DVec3,
        constant: f64,
        low: DVec3,
        high: DVec3,
    ) -> Option<Self> {
        let center = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        let scale = DMat3::from_diagonal(half);
        let square = 0.5 * (square + square.transpose());
        let quadric = Self {
            square: scale * square * scale,
            linear: half * (square * center + linear),
            constant: center.dot(square * center) + 2.0 * linear.dot(center) + constant,
            center,
            axes: [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * half),
        };
        (half.cmpgt(DVec3::ZERO).all() && quadric.is_surface()).then_some(quadric)
    }

    /// Returns the box that cuts the surface off.
    #[must_use]
    pub fn cuboid(&self) -> Cuboid {
        Cuboid {
            center: self.center,
            axes: self.axes,
        }
    }

    /// Whether all numbers are finite, the box has a volume, and the equation is not one that
    /// holds nowhere or everywhere.
    #[must_use]
    pub fn is_surface(&self) -> bool {
        let finite = self.square.is_finite()
            && self.linear.is_finite()
            && self.constant.is_finite()
            && self.center.is_finite();
        let varies = self.square != DMat3::ZERO || self.linear != DVec3::ZERO;
        finite && varies && self.local_from_world().is_some()
    }

    /// The left side of the equation at q, and its gradient with respect to q.
    #[must_use]
    pub fn value(&self, q: DVec3) -> (f64, DVec3) {
        let half = self.square * q + self.linear;
        (q.dot(half) + q.dot(self.linear) + self.constant, 2.0 * half)
    }

    /// The world position of q.
    #[must_use]
    pub fn place(&self, q: DVec3) -> DVec3 {
        self.center + DMat3::from_cols_array_2d(&self.axes.map(Into::into)) * q
    }

    /// The linear part of the map from the world to q: subtract `center` and multiply. Its
    /// transpose turns gradients with respect to q into normals. `None` for a box without volume.
    #[must_use]
    pub fn local_from_world(&self) -> Option<DMat3> {
        inverse(self.axes)
    }
}

/// The inverse of the matrix with these columns; `None` unless it is finite and they span a volume
/// that is more than rounding.
#[must_use]
pub fn inverse(axes: [DVec3; 3]) -> Option<DMat3> {
    let [x, y, z] = axes.map(DVec3::try_normalize);
    let units = DMat3::from_cols(x?, y?, z?);
    if units.determinant().abs() < 1e-12 {
        return None;
    }
    let lengths = DVec3::from(axes.map(DVec3::length));
    let inverse = DMat3::from_diagonal(lengths.recip()) * units.inverse();
    (lengths.is_finite() && inverse.is_finite()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_off_the_middle_keeps_the_equation() {
        let square = DMat3::from_cols_array(&[1.0, 0.5, 0.0, 0.25, -2.0, 1.0, 0.3, 0.0, 0.7]);
        let (b, c) = (DVec3::new(0.3, -0.2, 0.9), -0.4);
        let (low, high) = (DVec3::new(-1.0, 0.5, -3.0), DVec3::new(2.0, 0.75, 1.0));
        let quadric = Quadric::new(square, b, c, low, high).unwrap();
        for q in [
            DVec3::ZERO,
            DVec3::ONE,
            DVec3::NEG_ONE,
            DVec3::new(0.2, -0.9, 0.4),
        ] {
            let x = quadric.place(q);
            let wanted = x.dot(square * x) + 2.0 * b.dot(x) + c;
            let (value, gradient) = quadric.value(q);
            assert!((value - wanted).abs() < 1e-12, "{value} {wanted}");
            let step = DVec3::new(1e-6, -2e-6, 3e-6);
            let change = quadric.value(q + step).0 - quadric.value(q - step).0;
            assert!((change - 2.0 * gradient.dot(step)).abs() < 1e-12);
        }
        assert!(quadric.place(DVec3::NEG_ONE).distance(low) < 1e-15);
        assert!(quadric.place(DVec3::ONE).distance(high) < 1e-15);
    }

    #[test]
    fn quadrics_without_a_surface_are_refused() {
        assert!(new(DMat3::IDENTITY, DVec3::ZERO, DVec3::ONE).is_some());
        assert!(new(DMat3::ZERO, DVec3::X, DVec3::ONE).is_some());
        assert!(new(DMat3::ZERO, DVec3::ZERO, DVec3::ONE).is_none());
        assert!(new(DMat3::IDENTITY, DVec3::ZERO, DVec3::NEG_ONE).is_none());
        assert!(new(DMat3::IDENTITY, DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0)).is_none());
        for bad in [f64::NAN, f64::INFINITY, 1e200] {
            assert!(new(DMat3::IDENTITY, DVec3::splat(bad), DVec3::splat(1e200)).is_none());
            assert!(new(DMat3::IDENTITY * bad, DVec3::ZERO, DVec3::splat(1e200)).is_none());
        }
    }

    fn new(a: DMat3, b: DVec3, high: DVec3) -> Option<Quadric> {
        Quadric::new(a, b, 1.0, DVec3::ZERO, high)
    }
}
