//! Whole pictures by the fragment stage, with no more than WebGL2's limits: Phong's model, and
//! scenes that make no sense.

use crate::common::scenes::{arc, element, look};
use crate::common::traced::cards;
use cells::Detail;
use glam::{DMat3, DQuat, DVec3};
use preview::Stage;
use scene::{Camera, Element, Finish, Light, LightKind, Quadric, Scene, Shape};

/// A ball of radius 1 at the origin, seen from z = 5.
fn ball(finish: Finish, lights: Vec<Light>) -> Scene {
    Scene {
        elements: vec![element(Shape::sphere(DVec3::ZERO, 1.0), 0)],
        finishes: vec![finish],
        lights,
        background: [0.1, 0.2, 0.3].into(),
        camera: look([0.0, 0.0, 5.0], [0.0; 3], 30.0),
        ..Scene::default()
    }
}

fn shiny() -> Finish {
    Finish {
        ambient: [0.05, 0.02, 0.0],
        diffuse: [0.3, 0.5, 0.2],
        specular: [0.6, 0.5, 0.7],
        shine: 12.0,
        ..Finish::default()
    }
}

fn close(drawn: [f64; 3], expected: [f64; 3]) -> bool {
    (0..3).all(|i| (drawn[i] - expected[i].clamp(0.0, 1.0)).abs() <= 2.0 / 255.0)
}

#[test]
fn phong_with_point_and_distant_lights_and_gamma() {
    let lights = vec![
        Light {
            kind: LightKind::Point {
                position: DVec3::new(3.0, 2.0, 4.0),
            },
            colour: [0.9, 0.8, 0.7],
            shadow: true,
            size: 0.0,
        },
        Light {
            kind: LightKind::Distant {
                towards: DVec3::new(-1.0, 0.4, 0.5).normalize(),
            },
            colour: [0.2, 0.5, 1.4],
            shadow: true,
            size: 0.0,
        },
    ];
    let mut scene = ball(shiny(), lights.clone());
    scene.settings.gamma = 1.8;
    let size = [64, 40];
    let projection = scene.camera.projection(size[0], size[1]);
    for card in cards() {
        let pixels = card.draw(&scene, size);
        let mut seen = 0;
        for y in 0..size[1] {
            for x in 0..size[0] {
                let ray = projection.direction(
                    (f64::from(x) + 0.5) / f64::from(size[0]),
                    (f64::from(y) + 0.5) / f64::from(size[1]),
                );
                let middle = -projection.eye.dot(ray);
                let square = 1.0 - (projection.eye + ray * middle).length_squared();
                let light = if square <= 0.0 {
                    scene.background.mean().map(f64::from)
                } else {
                    seen += 1;
                    phong(
                        projection.eye + ray * (middle - square.sqrt()),
                        ray,
                        &lights,
                    )
                };
                let expected = light.map(|c| libm::pow(c.clamp(0.0, 1.0), 1.0 / 1.8));
                let [red, green, blue, alpha] = pixels[(y * size[0] + x) as usize];
                assert_eq!(alpha, 255);
                let drawn = [red, green, blue].map(|channel| f64::from(channel) / 255.0);
                // On the silhouette f32 may decide otherwise.
                if square.abs() > 1e-4 {
                    assert!(
                        close(drawn, expected),
                        "{x} {y} on {}: {drawn:?}, not {expected:?}",
                        card.name()
                    );
                }
            }
        }
        assert!(seen > 300);
    }
}

/// Phong's model at a point of the unit ball made of [`shiny`].
fn phong(p: DVec3, ray: DVec3, lights: &[Light]) -> [f64; 3] {
    let material = shiny();
    let normal = p.normalize();
    let mut sum = material.ambient.map(f64::from);
    for light in lights {
        let towards = match light.kind {
            LightKind::Point { position } | LightKind::Spot { position, .. } => {
                (position - p).normalize()
            }
            LightKind::Distant { towards } => towards,
        };
        let slope = normal.dot(towards);
        if slope > 0.0 {
            let mirrored = normal * (2.0 * slope) - towards;
            let gleam = libm::pow((-ray).dot(mirrored).max(0.0), f64::from(material.shine));
            for (i, channel) in sum.iter_mut().enumerate() {
                let [c, d, s] = [light.colour, material.diffuse, material.specular]
                    .map(|rgb| f64::from(rgb[i]));
                *channel += c * (d * slope + s * gleam);
            }
        }
    }
    sum
}

#[test]
fn scenes_without_sense_are_drawn_without_harm() {
    let numbers = [
        0.0,
        -1.0,
        1e-320,
        1e-30,
        1.0,
        1e30,
        1e300,
        f64::INFINITY,
        f64::NAN,
    ];
    let mut elements: Vec<Element> = Vec::new();
    for a in numbers {
        for b in numbers {
            let p = DVec3::new(a, 1.0, b);
            for shape in [
                Shape::sphere(p, a),
                Shape::cylinder(p, DVec3::new(b, a, 0.0), b),
                arc(p, DQuat::IDENTITY, a, b, 1.0),
                arc(DVec3::ZERO, DQuat::IDENTITY, 1.0, a, b),
                Shape::arc(p, [DVec3::splat(a), DVec3::splat(b)], 1.0, 2.0, 0.1),
                Shape::triangle([p, DVec3::new(b, a, b), DVec3::splat(a)], b),
                Shape::plane(p, DVec3::new(b, a, 0.0), a),
                Shape::cone(p, a, DVec3::new(b, a, 0.0), b),
                Shape::pipe(p, DVec3::new(b, a, 0.0), b),
                Shape::cuboid(p, [DVec3::X * a, DVec3::Y * b, DVec3::new(a, b, 1.0)]),
                Shape::patch(
                    [p, DVec3::new(b, a, b), DVec3::splat(a)],
                    [p, DVec3::Z, DVec3::X * a],
                ),
                Shape::Quadric(Box::new(Quadric {
                    square: DMat3::from_diagonal(DVec3::new(a, b, 1.0)),
                    linear: p,
                    constant: b,
                    center: p,
                    axes: [DVec3::X * a, DVec3::Y * b, DVec3::Z],
                })),
            ] {
                elements.push(element(shape, if a == 1.0 { u32::MAX } else { 0 }));
            }
        }
    }
    let strange = Finish {
        ambient: [f32::NAN, f32::INFINITY, -1.0],
        specular: [1e30; 3],
        shine: f32::NAN,
        ..Finish::default()
    };
    let mut scene = ball(
        strange,
        vec![Light {
            kind: LightKind::Point {
                position: DVec3::NAN,
            },
            colour: [f32::NAN; 3],
            shadow: false,
            size: 0.0,
        }],
    );
    scene.elements = elements;
    scene.settings.gamma = f32::NAN;
    scene.background = [f32::NAN, 2.0, -1.0].into();
    for card in cards() {
        let (mut tracer, _) = card.prepare(&scene, Detail::Quick, Stage::Fragment);
        for eye in [DVec3::ZERO, DVec3::splat(1e300), DVec3::NAN] {
            let camera = Camera {
                eye,
                ..scene.camera
            };
            let colours = card.colours(&mut tracer, &camera, [64, 16]);
            assert!(colours.iter().all(|pixel| pixel[3] == 255));
        }
        // And the device has not been lost.
        assert_eq!(card.draw(&ball(shiny(), Vec::new()), [64, 8]).len(), 512);
    }
}
