//! Scenes and pictures for the tests of shading.

use glam::DVec3;
use scene::{Background, Camera, Element, Finish, Flesh, Scene, Shape};
use texture::{Method, Target, Texture, Wave};
use tracer::{Pass, Picture, Stats, Tile};

/// Returns a black scene without lights, seen from z = 6.
pub fn dark() -> Scene {
    Scene {
        background: Background::Colour([0.0; 3]),
        camera: Camera {
            eye: DVec3::new(0.0, 0.0, 6.0),
            fov: 30.0,
            ..Camera::default()
        },
        flesh: vec![Flesh {
            blobbiness: Some(2.0),
            ..Flesh::default()
        }],
        ..Scene::default()
    }
}

/// Returns a finish that neither shines nor scatters light.
pub fn black() -> Finish {
    Finish {
        diffuse: [0.0; 3],
        ambient: [0.0; 3],
        ..Finish::default()
    }
}

/// Returns a finish that lets all light pass.
pub fn glass(index: f32) -> Finish {
    Finish {
        transparent: [1.0; 3],
        index,
        ..black()
    }
}

/// Adds an element with a finish.
pub fn add(scene: &mut Scene, shape: Shape, finish: Finish) {
    scene.finishes.push(finish);
    scene.elements.push(Element {
        finish: scene.finishes.len() as u32 - 1,
        ..Element::new(shape)
    });
}

/// Adds a soft element with a finish.
pub fn add_soft(scene: &mut Scene, shape: Shape, finish: Finish) {
    add(scene, shape, finish);
    if let Some(last) = scene.elements.last_mut() {
        last.flesh = Some(0);
    }
}

/// Returns a ball.
pub fn ball(center: DVec3, radius: f64) -> Shape {
    Shape::sphere(center, radius)
}

/// Adds a glowing plane across z whose brightness shows x: the fraction of `scale·x`.
pub fn ruler(scene: &mut Scene, z: f64, scale: f64) {
    let finish = Finish {
        ambient: [1.0; 3],
        diffuse: [0.0; 3],
        layers: vec![Texture {
            scale: DVec3::splat(scale),
            ..Texture::new(Target::Ambient, Method::Waves([Wave::Saw, Wave::One]))
        }],
        ..Finish::default()
    };
    let plane = Shape::plane(DVec3::Z * z, DVec3::Z, 0.0);
    add(scene, plane, finish);
}

/// Draws a scene with one ray for each pixel; returns red, green and blue of the pixels, rows from
/// the top.
pub fn draw(scene: &Scene, size: [u32; 2]) -> Vec<[u8; 3]> {
    draw_pass(scene, size, Pass::Full)
}

/// Draws a scene in a pass; returns red, green and blue of the pixels, rows from the top.
pub fn draw_pass(scene: &Scene, size: [u32; 2], pass: Pass) -> Vec<[u8; 3]> {
    let tile = Tile {
        x: 0,
        y: 0,
        width: size[0],
        height: size[1],
    };
    let picture = Picture::new(scene, size);
    let rgba = picture
        .trace(tile, pass, &|| false, &mut Stats::default())
        .expect("nobody stops");
    rgba.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect()
}

/// Returns the ray through the middle of each pixel.
pub fn rays(scene: &Scene, size: [u32; 2]) -> Vec<(DVec3, DVec3)> {
    let projection = scene.camera.projection(size[0], size[1]);
    let [width, height] = size.map(f64::from);
    (0..size[0] * size[1])
        .map(|i| {
            let (x, y) = (f64::from(i % size[0]), f64::from(i / size[0]));
            let direction = projection.direction((x + 0.5) / width, (y + 0.5) / height);
            (scene.camera.eye, direction)
        })
        .collect()
}

/// Returns the largest difference of two pixels' channels.
pub fn apart(a: [u8; 3], b: [u8; 3]) -> u8 {
    (0..3).map(|i| a[i].abs_diff(b[i])).fold(0, u8::max)
}

/// Returns a byte's distance from a value on a circle of the length 255.
pub fn around(byte: u8, value: f64) -> f64 {
    let apart = (f64::from(byte) - value).rem_euclid(255.0);
    apart.min(255.0 - apart)
}
