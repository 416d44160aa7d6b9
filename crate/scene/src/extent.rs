//! Extent of shapes: the box and the ball that hold them.

use crate::element::Shape;
use glam::DVec3;

/// The middle of the box around shapes, and the radius of the ball around that middle which holds
/// it. Planes are left out, as they are endless; `None` if nothing else is there.
#[must_use]
pub fn extent<'s>(shapes: impl Iterator<Item = &'s Shape>) -> Option<(DVec3, f64)> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for shape in shapes {
        each_corner(shape, &mut |point, around| {
            low = low.min(point - around);
            high = high.max(point + around);
        });
    }
    let size = high - low;
    (size.is_finite() && size.min_element() >= 0.0)
        .then(|| (0.5 * (low + high), 0.5 * size.length()))
}

/// Calls a function with points and half the sizes of boxes around them, which together hold the
/// shape.
fn each_corner(shape: &Shape, with: &mut impl FnMut(DVec3, DVec3)) {
    let ball = DVec3::splat(shape.radius());
    match shape {
        Shape::Sphere { center, .. } => with(*center, ball),
        Shape::Cylinder { base, apex, .. }
        | Shape::Cone { base, apex, .. }
        | Shape::Pipe { base, apex, .. } => {
            with(*base, ball);
            with(*apex, ball);
        }
        Shape::Arc { center, sweep, .. } => with(*center, ball + DVec3::splat(*sweep)),
        Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => {
            corners.iter().for_each(|corner| with(*corner, ball));
        }
        Shape::Polygon { rings, .. } => {
            rings
                .iter()
                .flatten()
                .for_each(|corner| with(*corner, ball));
        }
        Shape::Curve { control, .. } => control.iter().for_each(|point| with(*point, ball)),
        Shape::Box { center, axes } => with(*center, axes.iter().map(|axis| axis.abs()).sum()),
        Shape::Quadric(quadric) => {
            with(
                quadric.center,
                quadric.axes.iter().map(|axis| axis.abs()).sum(),
            );
        }
        Shape::Function(function) => {
            let (low, high) = function.corners();
            with(0.5 * (low + high), 0.5 * (high - low));
        }
        Shape::Plane { .. } => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_around_balls_and_limbs() {
        let [one, other] = [1.0, 3.0].map(|x| Shape::Sphere {
            center: DVec3::new(x, 0.0, 0.0),
            radius: 1.0,
        });
        let plane = Shape::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
            radius: 0.0,
        };
        let (middle, radius) = extent([one, plane.clone(), other].iter()).expect("balls");
        assert_eq!(middle, DVec3::new(2.0, 0.0, 0.0));
        assert_eq!(radius, DVec3::new(2.0, 1.0, 1.0).length());
        assert_eq!(extent([plane].iter()), None);
    }
}
