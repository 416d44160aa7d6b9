//! Small scenes for the tests.

use glam::{DQuat, DVec3};
use scene::{Camera, Element, Shape};

pub fn element(shape: Shape, finish: u32) -> Element {
    Element {
        finish,
        ..Element::new(shape)
    }
}

/// An arc in the plane that a rotation makes of the xy-plane.
pub fn arc(center: DVec3, rotation: DQuat, sweep: f64, angle: f64, radius: f64) -> Shape {
    Shape::arc(
        center,
        [rotation * DVec3::X, rotation * DVec3::Y],
        sweep,
        angle,
        radius,
    )
}

pub fn look(eye: [f64; 3], target: [f64; 3], fov: f64) -> Camera {
    Camera {
        eye: eye.into(),
        target: target.into(),
        up: DVec3::Y,
        fov,
        ..Camera::default()
    }
}
