//! A scene of very many elements, more than a dataset may have.

use field::Kernel;
use glam::DVec3;
use scene::{Body, Camera, Element, Flesh, Light, LightKind, Scene, Shape};

/// Balls of a kernel spread evenly through a cube of side 2, by the additive sequence of the three
/// powers of 1/φ₃, φ₃ ≈ 1.2207 being the root of x⁴ = x + 1. Their mean distance is `apart` radii:
/// at 3 many touch and melt together.
pub fn scene(count: u32, kernel: Kernel, apart: f64) -> Scene {
    const PHI: f64 = 1.220_744_084_605_759_5;
    let step = DVec3::new(1.0 / PHI, 1.0 / (PHI * PHI), 1.0 / (PHI * PHI * PHI));
    let radius = 2.0 / libm::cbrt(f64::from(count)) / apart;
    let mut scene = Scene::default();
    scene.flesh.push(Flesh {
        blobbiness: Some(4.0),
        ..Flesh::default()
    });
    scene.elements = (0..count)
        .map(|i| Element {
            flesh: Some(0),
            kernel,
            ..Element::new(Shape::sphere(
                (step * f64::from(i)).fract() * 2.0 - 1.0,
                radius,
            ))
        })
        .collect();
    scene.camera = Camera {
        eye: DVec3::new(4.0, 2.4, 3.2),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov: 45.0,
        ..Camera::default()
    };
    scene.lights.push(Light {
        kind: LightKind::Point {
            position: DVec3::new(4.0, 3.0, 5.0),
        },
        colour: [1.0; 3],
        shadow: false,
        size: 0.0,
    });
    scene.settings.frame = [512, 512];
    scene
}

/// Molecules of three balls that melt together, in the places of the balls of [`scene`]: all in one
/// body, or each in a body of its own.
pub fn triples(count: u32, kernel: Kernel, apart: f64, in_bodies: bool) -> Scene {
    let mut scene = scene(count, kernel, apart);
    let middles = core::mem::take(&mut scene.elements);
    if in_bodies {
        scene.bodies.resize(middles.len(), Body::default());
    }
    for (number, middle) in (0..).zip(middles) {
        let (center, radius) = (middle.shape.middle(), middle.shape.radius());
        for around in [DVec3::X, DVec3::Y, DVec3::Z] {
            let shape = Shape::sphere(center + 0.5 * radius * around, 0.6 * radius);
            scene.elements.push(Element {
                flesh: Some(0),
                kernel,
                body: if in_bodies { number } else { 0 },
                ..Element::new(shape)
            });
        }
    }
    scene
}
