//! Small scenes for the tests.

use glam::{DQuat, DVec3};
use scene::{Camera, Element, Finish, Light, LightKind, Scene, Shape};

pub fn element(shape: Shape, finish: u32) -> Element {
    Element {
        finish,
        ..Element::new(shape)
    }
}

/// A scene in which every element shines in a colour that tells its index (below 215).
pub fn by_index(shapes: &[Shape], camera: Camera) -> Scene {
    Scene {
        elements: (0..)
            .zip(shapes)
            .map(|(i, s)| element(s.clone(), i))
            .collect(),
        finishes: (0..shapes.len())
            .map(|i| Finish {
                ambient: colour_of(Some(i)),
                diffuse: [0.0; 3],
                ..Finish::default()
            })
            .collect(),
        background: colour_of(None).into(),
        camera,
        ..Scene::default()
    }
}

/// The colour of an element in [`by_index`], `None` for the background.
pub fn colour_of(index: Option<usize>) -> [f32; 3] {
    let number = index.map_or(0, |i| i + 1);
    [number % 6, number / 6 % 6, number / 36 % 6].map(|digit| digit as f32 / 5.0)
}

/// The index that a colour of [`by_index`] tells.
pub fn index_of(colour: [f64; 3]) -> Option<usize> {
    let [a, b, c] = colour.map(|channel| (channel * 5.0).round() as usize);
    (a + 6 * b + 36 * c).checked_sub(1)
}

/// A scene lit along the axes, red along x, green along y, blue along z, times `sign`: the colours
/// are the positive parts of the normal times `sign`.
pub fn by_normal(shapes: &[Shape], camera: Camera, sign: f64) -> Scene {
    let lights = [0, 1, 2].map(|channel| {
        let mut colour = [0.0; 3];
        colour[channel] = 1.0;
        Light {
            kind: LightKind::Distant {
                towards: DVec3::AXES[channel] * sign,
            },
            colour,
            shadow: false,
            size: 0.0,
        }
    });
    Scene {
        elements: shapes.iter().map(|s| element(s.clone(), 0)).collect(),
        finishes: vec![Finish {
            ambient: [0.0; 3],
            diffuse: [1.0; 3],
            ..Finish::default()
        }],
        lights: lights.to_vec(),
        background: [0.0; 3].into(),
        camera,
        ..Scene::default()
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

/// A rotation without a pattern.
pub fn rotation() -> DQuat {
    DQuat::from_xyzw(0.3, -0.5, 0.2, 0.8).normalize()
}
