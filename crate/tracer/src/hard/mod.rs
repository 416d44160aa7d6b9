//! Hard shapes: elements that do not blend, drawn as their offset surfaces.
//!
//! Each shape is a closed body (or, at zero thickness, a sheet) and knows every place where a ray
//! crosses its surface.

mod cylinder;
mod plane;
mod sphere;
mod torus;
mod triangle;

#[cfg(test)]
mod tests;

use crate::ray::Ray;
use glam::DVec3;
use scene::Shape;

pub use cylinder::Cylinder;
pub use plane::Plane;
pub use sphere::Sphere;
pub use torus::Tube;
pub use triangle::Prism;

/// A place where a ray crosses a hard surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Ray parameter, any sign.
    pub t: f64,
    /// Outward unit normal.
    pub normal: DVec3,
}

/// A hard shape, made ready.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere(Sphere),
    /// A cylinder with flat lids.
    Cylinder(Cylinder),
    /// A piece of a torus with flat lids.
    Tube(Tube),
    /// A triangle, flat or thick.
    Prism(Prism),
    /// A plane or slab.
    Plane(Plane),
}

impl Solid {
    /// A shape with the given radius (which may overrule the shape's own). `None` if it has no
    /// surface: a number that is not finite, a size of zero.
    #[must_use]
    pub fn new(shape: &Shape, radius: f64) -> Option<Self> {
        if !radius.is_finite() {
            return None;
        }
        match *shape {
            Shape::Sphere { center, .. } => Sphere::new(center, radius).map(Self::Sphere),
            Shape::Cylinder { base, apex, .. } => {
                Cylinder::new(base, apex, radius).map(Self::Cylinder)
            }
            Shape::Arc {
                center,
                u,
                v,
                sweep,
                angle,
                ..
            } => Tube::new(center, [u, v], sweep, angle, radius).map(Self::Tube),
            Shape::Triangle { corners, .. } => Prism::new(corners, radius).map(Self::Prism),
            Shape::Plane { point, normal, .. } => {
                Plane::new(point, normal, radius).map(Self::Plane)
            }
            // Made of several solids: see `Shape::parts`.
            Shape::Polygon { .. } | Shape::Curve { .. } => None,
        }
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        match self {
            Self::Sphere(s) => s.crossings(ray, out),
            Self::Cylinder(s) => s.crossings(ray, out),
            Self::Tube(s) => s.crossings(ray, out),
            Self::Prism(s) => s.crossings(ray, out),
            Self::Plane(s) => s.crossings(ray, out),
        }
    }

    /// A ball that holds the shape; `None` for a plane.
    #[must_use]
    pub fn ball(&self) -> Option<(DVec3, f64)> {
        match self {
            Self::Sphere(s) => Some(s.ball()),
            Self::Cylinder(s) => Some(s.ball()),
            Self::Tube(s) => Some(s.ball()),
            Self::Prism(s) => Some(s.ball()),
            Self::Plane(_) => None,
        }
    }
}

/// The part of a ray's line inside a convex body: where it enters and where it leaves, each with
/// the outward normal there. Starts as the whole line and is clipped piece by piece.
struct Clip {
    enter: Crossing,
    leave: Crossing,
}

impl Clip {
    fn whole_line() -> Self {
        let at = |t| Crossing {
            t,
            normal: DVec3::ZERO,
        };
        Self {
            enter: at(f64::NEG_INFINITY),
            leave: at(f64::INFINITY),
        }
    }

    /// Keeps the half space where `(p − point)·normal ≤ 0`.
    fn half_space(&mut self, ray: &Ray, point: DVec3, normal: DVec3) {
        let height = (ray.origin - point).dot(normal);
        let rate = ray.direction.dot(normal);
        if rate == 0.0 {
            if height > 0.0 {
                self.leave.t = f64::NEG_INFINITY;
            }
            return;
        }
        let crossing = Crossing {
            t: -height / rate,
            normal,
        };
        if rate < 0.0 {
            if crossing.t > self.enter.t {
                self.enter = crossing;
            }
        } else if crossing.t < self.leave.t {
            self.leave = crossing;
        }
    }

    /// Adds both ends if anything is left and they are finite.
    fn finish(&self, out: &mut Vec<Crossing>) {
        if self.enter.t < self.leave.t && self.enter.t.is_finite() && self.leave.t.is_finite() {
            out.push(self.enter);
            out.push(self.leave);
        }
    }
}
