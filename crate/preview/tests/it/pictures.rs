//! Whole pictures: Phong's model, lights, gamma, sampling, sizes, limits, and scenes that make no
//! sense.

use crate::common::gpu::{gpus, open};
use crate::common::scenes::{arc, element, look};
use glam::{DMat3, DQuat, DVec3};
use preview::{Draft, Drawn, MAX_ELEMENTS, MAX_LIGHTS, Mesh, Sampling, VERTEX, looks};
use scene::{
    Camera, Element, Finish, Flesh, Light, LightKind, Paint, Quadric, Scene, Settings, Shape,
};

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
    let size = [60, 40];
    let projection = scene.camera.projection(size[0], size[1]);
    for gpu in gpus() {
        let picture = gpu.draw(&scene, size);
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
                let drawn = picture.at(x, y);
                // On the silhouette f32 may decide otherwise.
                if square.abs() > 1e-4 {
                    assert!(
                        close(drawn, expected),
                        "{x} {y} on {}: {drawn:?}, not {expected:?}",
                        gpu.name
                    );
                }
            }
        }
        assert!(seen > 300);
    }
}

#[test]
fn colours_at_the_corners_of_a_triangle_are_mixed() {
    fn area(a: DVec3, b: DVec3, c: DVec3) -> f64 {
        (b - a).cross(c - a).z
    }
    let corners = [[1.3, -0.8], [0.1, 1.2], [-1.2, -1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    // Multiples of 1/31 and 1/63.
    let colors = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [10.0 / 31.0, 21.0 / 63.0, 1.0],
    ];
    let mut scene = ball(Finish::default(), Vec::new());
    let finishes = [[0.9; 3], [0.2, 0.9, 0.3]].map(|ambient| Finish {
        ambient,
        diffuse: [0.0; 3],
        ..Finish::default()
    });
    scene.finishes = finishes.to_vec();
    let flat = Shape::triangle(corners, 0.0);
    let patch = Shape::patch(
        corners,
        [
            DVec3::Z,
            DVec3::new(0.3, 0.1, 1.0),
            DVec3::new(0.0, 0.4, 1.0),
        ],
    );
    let size = [48, 48];
    let projection = scene.camera.projection(size[0], size[1]);
    let whole = area(corners[0], corners[1], corners[2]);
    for shape in [flat, patch] {
        scene.elements = vec![Element {
            finish: 1,
            paint: Some(Box::new(Paint {
                finish: 0,
                corners: colors,
            })),
            ..Element::new(shape)
        }];
        for gpu in gpus() {
            let picture = gpu.draw(&scene, size);
            let mut seen = 0;
            for (x, y) in (0..48).flat_map(|y| (0..48).map(move |x| (x, y))) {
                let [u, v] = [x, y].map(|i| (f64::from(i) + 0.5) / 48.0);
                let ray = projection.direction(u, v);
                let point = projection.eye - ray * (projection.eye.z / ray.z);
                let shares = [0, 1, 2]
                    .map(|k| area(point, corners[(k + 1) % 3], corners[(k + 2) % 3]) / whole);
                if shares.iter().all(|share| *share > 1e-3) {
                    seen += 1;
                    let expected = [0, 1, 2].map(|channel| {
                        let parts = (0..3).map(|k| shares[k] * f64::from(colors[k][channel]));
                        0.9 * parts.sum::<f64>()
                    });
                    let drawn = picture.at(x, y);
                    assert!(
                        close(drawn, expected),
                        "{x} {y} on {}: {drawn:?}, not {expected:?}",
                        gpu.name
                    );
                }
            }
            assert!(seen > 300, "{seen}");
        }
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
fn four_samples_are_averaged_as_light() {
    // A plane through the middle of the picture, seen edge on: rows are all sky or all ground,
    // but for an odd height the middle row is half of each.
    let mut scene = Scene {
        elements: vec![element(
            Shape::plane(DVec3::new(0.0, -0.01, 0.0), DVec3::Y, 0.0),
            0,
        )],
        finishes: vec![Finish {
            ambient: [1.0, 0.5, 0.0],
            diffuse: [0.0; 3],
            ..Finish::default()
        }],
        background: [0.0, 0.5, 1.0].into(),
        camera: look([0.0, 0.0, 5.0], [0.0; 3], 60.0),
        ..Scene::default()
    };
    let gamma = 2.0;
    scene.settings.gamma = gamma;
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        draft.set_scene(&gpu.device, &gpu.queue, &scene);
        draft.set_sampling(Sampling::Four);
        let picture = gpu.render(&mut draft, &scene.camera, [9, 7]);
        assert_eq!(picture.size, [9, 7]);
        for (y, rgb) in [(0, [0.0, 0.5, 1.0]), (3, [0.5; 3]), (6, [1.0, 0.5, 0.0])] {
            let encoded = rgb.map(|c| libm::pow(c, 1.0 / f64::from(gamma)));
            assert!((0..9).all(|x| close(picture.at(x, y), encoded)));
        }
    }
}

#[test]
fn sizes_and_generations() {
    let scene = ball(shiny(), Vec::new());
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        assert_eq!(draft.size(), None);
        gpu.render(&mut draft, &scene.camera, [31, 17]);
        let first = draft.generation();
        draft.set_scene(&gpu.device, &gpu.queue, &scene);
        gpu.render(&mut draft, &Camera::default(), [31, 17]);
        assert_eq!(draft.generation(), first);
        gpu.render(&mut draft, &scene.camera, [32, 17]);
        assert_ne!(draft.generation(), first);
        assert_eq!(gpu.render(&mut draft, &scene.camera, [0, 0]).size, [1, 1]);
        // Larger than the device's textures, which are WebGL2's least: the same view, smaller.
        let huge = gpu.render(&mut draft, &scene.camera, [40_000, 400]);
        assert_eq!(huge.size, [2048, 20]);
    }
}

#[test]
fn more_lights_than_fit_leaves_the_weakest() {
    let weak = Light {
        kind: LightKind::Distant { towards: DVec3::Z },
        colour: [0.001; 3],
        shadow: false,
        size: 0.0,
    };
    let mut lights = vec![weak; 41];
    lights[40].colour = [0.5; 3];
    let scene = ball(
        Finish {
            ambient: [0.0; 3],
            ..Finish::default()
        },
        lights,
    );
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        let drawn = draft.set_scene(&gpu.device, &gpu.queue, &scene);
        assert_eq!(drawn.lights_left_out, 41 - MAX_LIGHTS);
        let picture = gpu.render(&mut draft, &scene.camera, [5, 5]);
        assert!(close(picture.at(2, 2), [0.8 * (0.5 + 0.001 * 7.0); 3]));
    }
}

#[test]
fn the_radius_that_counts_is_drawn_and_carving_is_not() {
    let bright = Finish {
        ambient: [1.0; 3],
        ..Finish::default()
    };
    let mut scene = ball(bright, Vec::new());
    scene.flesh.push(Flesh {
        radius: 2.0,
        blobbiness: Some(1.0),
        ..Flesh::default()
    });
    scene.elements[0].flesh = Some(0);
    scene.camera.fov = 60.0;
    let [own, fragile] = [scene.settings.fragile, scene::Fragile::ALL].map(|fragile| {
        scene.settings.fragile = fragile;
        let counts = gpus().iter().map(|gpu| {
            let picture = gpu.draw(&scene, [40, 40]);
            picture.pixels.iter().filter(|p| p[0] == 255).count()
        });
        counts.collect::<Vec<usize>>()
    });
    for (own, fragile) in own.iter().zip(&fragile) {
        // Twice the radius, four times the area, more as it comes nearer.
        assert!((4.0..5.5).contains(&(*fragile as f64 / *own as f64)));
    }

    scene.flesh[0].strength = -1.0;
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        let expected = Drawn {
            invisible: 1,
            ..Drawn::default()
        };
        assert_eq!(draft.set_scene(&gpu.device, &gpu.queue, &scene), expected);
        // With `soft off` the strength means nothing and the offset surface is shown.
        scene.settings = Settings {
            soft: false,
            ..scene.settings
        };
        let drawn = draft.set_scene(&gpu.device, &gpu.queue, &scene);
        assert_eq!(drawn.elements, 1);
        scene.settings.soft = true;
    }
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
    let count = elements.len();
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
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        let drawn = draft.set_scene(&gpu.device, &gpu.queue, &scene);
        assert_eq!(drawn.elements + drawn.invisible, count);
        for eye in [DVec3::ZERO, DVec3::splat(1e300), DVec3::NAN] {
            let camera = Camera {
                eye,
                ..scene.camera
            };
            let picture = gpu.render(&mut draft, &camera, [16, 16]);
            assert!(picture.pixels.iter().all(|pixel| pixel[3] == 255));
        }
        // And the device has not been lost.
        assert_eq!(gpu.draw(&ball(shiny(), Vec::new()), [8, 8]).size, [8, 8]);
    }
}

#[test]
fn hundreds_of_thousands_of_elements_are_limited() {
    let count = MAX_ELEMENTS + 10;
    let side = 450;
    let elements = (0..count)
        .map(|i| {
            let place = DVec3::new((i % side) as f64, (i / side) as f64, 0.0);
            element(Shape::sphere(place, 0.4), i as u32)
        })
        .collect();
    let mut scene = Scene {
        elements,
        // As many materials, more than a row of their texture.
        finishes: (0..count)
            .map(|i| Finish {
                ambient: [1.0, (i % 2) as f32, 0.0],
                ..Finish::default()
            })
            .collect(),
        ..Scene::default()
    };
    scene.camera = preview::orbit::frame(&scene, scene.camera, [32, 32]);
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        let drawn = draft.set_scene(&gpu.device, &gpu.queue, &scene);
        assert_eq!(drawn.elements, MAX_ELEMENTS);
        assert_eq!(drawn.left_out, 10);
        draft.set_sampling(Sampling::One);
        let picture = gpu.render(&mut draft, &scene.camera, [32, 32]);
        assert!(picture.pixels.iter().any(|pixel| pixel[0] == 255));
        // Close to number 100123, whose material is far down the table.
        let middle = DVec3::new((100_123 % side) as f64, (100_123 / side) as f64, 0.0);
        let camera = Camera {
            eye: middle + DVec3::Z,
            target: middle,
            ..Camera::default()
        };
        let picture = gpu.render(&mut draft, &camera, [3, 3]);
        assert_eq!(picture.at(1, 1), [1.0, 1.0, 0.0]);
    }
}

#[test]
fn a_device_with_little_memory_draws_what_fits() {
    let mut scene = ball(shiny(), Vec::new());
    scene.elements = vec![scene.elements[0].clone(); 1000];
    for gpu in gpus() {
        let limits = wgpu::Limits {
            max_buffer_size: 1 << 14,
            ..wgpu::Limits::downlevel_webgl2_defaults()
        };
        let gpu = open(gpu.backend.into(), limits).expect("the backend is there");
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        let drawn = draft.set_scene(&gpu.device, &gpu.queue, &scene);
        assert!(drawn.elements > 100 && drawn.left_out > 100, "{drawn:?}");
        assert_eq!(drawn.elements + drawn.left_out, 1000);
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        draft.render(&gpu.device, &gpu.queue, &mut encoder, &scene.camera, [8, 8]);
        gpu.queue.submit([encoder.finish()]);
    }
}

/// A unit ball of triangles, `rings` from pole to pole, all of one look: vertices and triangles.
fn round(rings: u32, look: [f32; 10]) -> (Vec<u8>, Vec<u8>) {
    let across = 2 * rings;
    let [ar, ag, ab, dr, dg, db, sr, sg, sb, shine] = look.map(|x| (255.0 * x + 0.5) as u8);
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=rings {
        for k in 0..across {
            let [lat, lon] = [(i, rings), (k, rings)]
                .map(|(i, n)| core::f64::consts::PI * f64::from(i) / f64::from(n));
            let (s, c) = libm::sincos(lat);
            let (t, d) = libm::sincos(lon);
            let place = [s * d, s * t, c];
            for x in place {
                vertices.extend((x as f32).to_le_bytes());
            }
            for x in [place[0], place[1], place[2], 0.0] {
                vertices.extend(((x * 32767.0) as i16).to_le_bytes());
            }
            vertices.extend([ar, ag, ab, shine, dr, dg, db, 255, sr, sg, sb, 255]);
            if i < rings {
                let [a, b] = [i * across + k, i * across + (k + 1) % across];
                let [c, d] = [a + across, b + across];
                for corner in [a, c, b, b, c, d] {
                    triangles.extend(corner.to_le_bytes());
                }
            }
        }
    }
    (vertices, triangles)
}

#[test]
fn mesh_takes_the_place_of_soft_elements_alone() {
    let lights = vec![Light {
        kind: LightKind::Distant {
            towards: DVec3::new(-1.0, 0.4, 0.8).normalize(),
        },
        colour: [0.8, 0.7, 0.9],
        shadow: true,
        size: 0.0,
    }];
    let mut scene = ball(shiny(), lights.clone());
    scene.flesh.push(Flesh {
        blobbiness: Some(2.0),
        ..Flesh::default()
    });
    scene.elements[0].flesh = Some(0);
    // A hard ball beside it.
    let (aside, small) = (DVec3::new(0.95, 0.95, 0.0), 0.3);
    scene.elements.push(element(Shape::sphere(aside, small), 0));
    let (vertices, triangles) = round(60, looks(&scene)[0]);
    let (origin, unit) = (DVec3::new(0.1, -0.1, 0.0), 0.5);
    let mesh = Mesh {
        vertices: &vertices,
        triangles: &triangles,
        origin,
        unit,
    };
    assert_eq!(vertices.len() % VERTEX, 0);
    let size = [160, 160];
    for gpu in gpus() {
        let mut draft = Draft::new(&gpu.device, &gpu.queue);
        draft.set_sampling(Sampling::One);
        draft.set_scene(&gpu.device, &gpu.queue, &scene);
        let before = gpu.render(&mut draft, &scene.camera, size);
        assert!(draft.set_mesh(&gpu.device, &gpu.queue, Some(&mesh)));
        let picture = gpu.render(&mut draft, &scene.camera, size);
        let projection = scene.camera.projection(size[0], size[1]);
        let mut counts = [0; 3];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let [u, v] = [(x, size[0]), (y, size[1])]
                    .map(|(i, n)| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0);
                let (right, up) = (u * projection.half_width, -v * projection.half_height);
                let ray = projection.world_from_view * DVec3::new(right, up, -1.0);
                let ray = ray.normalize();
                // Where the ray meets a ball, and how near it passes the middle, in radii.
                let meet = |center: DVec3, radius: f64| {
                    let to = projection.eye - center;
                    let nearest = to - ray * to.dot(ray);
                    let off = nearest.length() / radius;
                    let half = (1.0 - off * off).max(0.0).sqrt() * radius;
                    (off, (nearest - ray * half) / radius)
                };
                let (off, normal) = meet(origin, unit);
                let (beside, _) = meet(aside, small);
                let pixel = picture.at(x, y);
                if off < 0.95 {
                    let expected = phong(normal, ray, &lights);
                    let near =
                        (0..3).all(|i| (pixel[i] - expected[i].clamp(0.0, 1.0)).abs() < 0.02);
                    assert!(near, "{} {x} {y}: {pixel:?} {expected:?}", gpu.name);
                    counts[0] += 1;
                } else if off > 1.05 && beside > 1.05 {
                    assert!(close(pixel, [0.1, 0.2, 0.3]), "{x} {y} {pixel:?}");
                    counts[1] += 1;
                } else if beside < 0.95 {
                    assert_eq!(pixel, before.at(x, y), "the hard ball stays");
                    counts[2] += 1;
                }
            }
        }
        assert!(counts.iter().all(|count| *count > 400), "{counts:?}");
        // Without it, and with one that is none, the offset surfaces are back.
        let mut broken = triangles.clone();
        broken[4..8].copy_from_slice(&u32::MAX.to_le_bytes());
        let broken = Mesh {
            triangles: &broken,
            ..mesh
        };
        let empty = Mesh {
            triangles: &[],
            ..mesh
        };
        let endless = Mesh {
            unit: f64::NAN,
            ..mesh
        };
        for none in [None, Some(&broken), Some(&empty), Some(&endless)] {
            draft.set_mesh(&gpu.device, &gpu.queue, Some(&mesh));
            assert!(!draft.set_mesh(&gpu.device, &gpu.queue, none));
            let again = gpu.render(&mut draft, &scene.camera, size);
            assert!(again.pixels == before.pixels);
        }
    }
}
