//! Hard shapes: elements that do not blend, drawn as their offset surfaces.
//!
//! Each shape is a closed body (or, without thickness or lids, a sheet) and knows every place where
//! a ray crosses its surface.

mod cone;
mod cuboid;
mod cylinder;
mod patch;
mod pipe;
mod plane;
mod quadric;
mod sphere;
mod torus;
mod triangle;

#[cfg(test)]
mod tests;

use crate::ray::Ray;
use field::Skeleton;
use glam::DVec3;
use scene::{Ends, Shape};

pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use patch::Patch;
pub use pipe::Pipe;
pub use plane::Plane;
pub use quadric::Quadric;
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

/// A hard shape, prepared for tracing.
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
    /// A cone cut off at both ends, with flat lids.
    Cone(Cone),
    /// The wall of a cylinder.
    Pipe(Pipe),
    /// A box, maybe sheared.
    Cuboid(Cuboid),
    /// A triangle that is lit as if it were curved.
    Patch(Patch),
    /// A piece of a surface of the second degree.
    Quadric(Box<Quadric>),
}

impl Solid {
    /// Prepares a shape with the given radius, which may overrule the shape's own; shapes without a
    /// single one ignore it. `None` if it has no surface: a number that is not finite, a size of
    /// zero.
    #[must_use]
    pub fn new(shape: &Shape, radius: f64) -> Option<Self> {
        if !radius.is_finite() {
            return None;
        }
        let bone = match shape {
            Shape::Bone(bone) => bone,
            Shape::Box(own) => return Cuboid::new(own.center, own.axes).map(Self::Cuboid),
            Shape::Quadric(own) => return Quadric::new(own).map(|q| Self::Quadric(Box::new(q))),
            Shape::Function(_) => return None,
        };
        match bone.skeleton {
            Skeleton::Point { center } => Sphere::new(center, radius).map(Self::Sphere),
            Skeleton::Segment { base, apex } => match (bone.ends, bone.end_radius) {
                (_, Some(end)) => Cone::new([base, apex], [bone.radius, end]).map(Self::Cone),
                (Ends::Open, None) => Pipe::new(base, apex, radius).map(Self::Pipe),
                (_, None) => Cylinder::new(base, apex, radius).map(Self::Cylinder),
            },
            Skeleton::Arc {
                center,
                u,
                v,
                radius: sweep,
                angle,
            } => Tube::new(center, [u, v], sweep, angle, radius).map(Self::Tube),
            Skeleton::Triangle { corners } => match &bone.normals {
                Some(normals) => Patch::new(corners, **normals).map(Self::Patch),
                None => Prism::new(corners, radius).map(Self::Prism),
            },
            Skeleton::Plane { point, normal } => Plane::new(point, normal, radius).map(Self::Plane),
            // Several solids: see `Shape::parts`.
            _ => None,
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
            Self::Cone(s) => s.crossings(ray, out),
            Self::Pipe(s) => s.crossings(ray, out),
            Self::Cuboid(s) => s.crossings(ray, out),
            Self::Patch(s) => s.crossings(ray, out),
            Self::Quadric(s) => s.crossings(ray, out),
        }
    }

    /// Returns a ball (centre, radius) that holds the shape; `None` for a plane.
    #[must_use]
    pub fn ball(&self) -> Option<(DVec3, f64)> {
        match self {
            Self::Sphere(s) => Some(s.ball()),
            Self::Cylinder(s) => Some(s.ball()),
            Self::Tube(s) => Some(s.ball()),
            Self::Prism(s) => Some(s.ball()),
            Self::Plane(_) => None,
            Self::Cone(s) => Some(s.ball()),
            Self::Pipe(s) => Some(s.ball()),
            Self::Cuboid(s) => Some(s.ball()),
            Self::Patch(s) => Some(s.ball()),
            Self::Quadric(s) => Some(s.ball()),
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
        let [enter, leave] = [f64::NEG_INFINITY, f64::INFINITY].map(|t| Crossing {
            t,
            normal: DVec3::ZERO,
        });
        Self { enter, leave }
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

    /// Keeps the part between two crossings.
    fn stretch(&mut self, enter: Crossing, leave: Crossing) {
        if enter.t > self.enter.t {
            self.enter = enter;
        }
        if leave.t < self.leave.t {
            self.leave = leave;
        }
    }

    /// Adds both ends if anything is left and they are finite.
    fn finish(&self, out: &mut Vec<Crossing>) {
        self.finish_from(0.0, out);
    }

    /// Adds both ends if anything is left and they are finite, of a clip that was made for a ray
    /// that starts at parameter `start` of the true one.
    fn finish_from(&self, start: f64, out: &mut Vec<Crossing>) {
        if self.enter.t < self.leave.t && self.enter.t.is_finite() && self.leave.t.is_finite() {
            out.extend([self.enter, self.leave].map(|c| Crossing {
                t: start + c.t,
                ..c
            }));
        }
    }
}

/// Returns the zeros of `a·t² + 2·b·t + c`, in order; one is infinite if `a` vanishes. `None` if it
/// is zero nowhere, or everywhere.
fn zeros(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let square = b * b - a * c;
    if square.is_nan() || square < 0.0 {
        return None;
    }
    // The sum that does not cancel; the other root follows from the product of both.
    let sum = -(b + square.sqrt().copysign(b));
    let [p, q] = if sum == 0.0 {
        [0.0, 0.0 / a]
    } else {
        // Adding 0 makes a negative zero positive.
        [sum / (a + 0.0), c / sum]
    };
    (!p.is_nan() && !q.is_nan()).then_some([p.min(q), p.max(q)])
}
