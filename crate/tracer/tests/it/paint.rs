//! Tests of colours at the corners of triangles, against barycentric coordinates computed from
//! areas.

use crate::looks::*;
use glam::{DVec3, Vec3};
use scene::{Element, Finish, Light, LightKind, Paint, Rgb, Scene, Shape};

const SIZE: [u32; 2] = [40, 40];
const CORNERS: [DVec3; 3] = [
    DVec3::new(-1.0, -0.8, 0.3),
    DVec3::new(1.1, -0.6, -0.4),
    DVec3::new(-0.1, 1.0, 0.2),
];
const COLORS: [Rgb; 3] = [[1.0, 0.0, 0.2], [0.0, 1.0, 0.4], [0.3, 0.1, 1.0]];

/// Returns a scene with a painted triangle that glows in 0.9 times its colours. Its own finish is
/// another one.
fn painting(shape: Shape) -> Scene {
    let mut scene = dark();
    let glows = [[0.9; 3], [0.2, 0.9, 0.3]];
    scene.finishes = glows.map(|ambient| Finish { ambient, ..black() }).to_vec();
    scene.elements.push(Element {
        finish: 1,
        paint: Some(Box::new(Paint {
            finish: 0,
            corners: COLORS,
        })),
        ..Element::new(shape)
    });
    scene
}

/// Returns a light from the eye's side.
fn lamp() -> Light {
    let towards = DVec3::new(0.2, 0.3, 1.0).normalize();
    Light::new(LightKind::Distant { towards }, [1.0; 3])
}

/// Returns the colour of the triangle at a point of its plane, by areas; `None` outside.
fn colour_at(point: DVec3) -> Option<Vec3> {
    let [a, b, c] = CORNERS;
    let normal = (b - a).cross(c - a);
    let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal);
    let areas = [area(point, b, c), area(a, point, c), area(a, b, point)];
    let whole = area(a, b, c);
    areas.iter().all(|part| *part > 1e-6 * whole).then(|| {
        (0..3)
            .map(|k| Vec3::from(COLORS[k]) * (areas[k] / whole) as f32)
            .sum()
    })
}

/// Returns the foot on the triangle's plane of the point where a ray meets the plane at a height.
fn meet((origin, direction): (DVec3, DVec3), height: f64) -> DVec3 {
    let [a, b, c] = CORNERS;
    let normal = (b - a).cross(c - a).normalize();
    let t = (a + normal * height - origin).dot(normal) / direction.dot(normal);
    origin + direction * t - normal * height
}

/// Compares all pixels whose rays meet the inside of the triangle; returns their number.
fn compare(scene: &Scene, height: f64, bound: f32) -> usize {
    let mut count = 0;
    for (pixel, ray) in draw(scene, SIZE).into_iter().zip(rays(scene, SIZE)) {
        if let Some(color) = colour_at(meet(ray, height)) {
            let seen = Vec3::from(pixel.map(f32::from));
            let off = (seen - color * (0.9 * 255.0)).abs().max_element();
            assert!(off <= bound, "{pixel:?} {color} {off}");
            count += 1;
        }
    }
    count
}

#[test]
fn corners_colours_are_mixed_by_barycentric_shares() {
    let flat = Shape::triangle(CORNERS, 0.0);
    let patch = Shape::patch(
        CORNERS,
        [
            DVec3::Z,
            DVec3::new(0.3, 0.1, 1.0),
            DVec3::new(0.0, 0.4, 1.0),
        ],
    );
    for shape in [flat, patch] {
        let mut scene = painting(shape);
        assert!(compare(&scene, 0.0, 1.0) > 100);
        // Beside a mirror, and under light: other ways of shading.
        let mirror = Finish {
            reflective: [0.5; 3],
            ..black()
        };
        add(&mut scene, ball(DVec3::new(0.0, 0.0, -30.0), 0.5), mirror);
        assert!(compare(&scene, 0.0, 1.0) > 100);
        scene.lights.push(lamp());
        assert!(compare(&scene, 0.0, 1.0) > 100);
    }
}

#[test]
fn paint_scatters_light_as_a_finish_of_its_colours() {
    let flat = Shape::triangle(CORNERS, 0.0);
    let mut scene = painting(flat);
    scene.lights.push(lamp());
    let color = [0.5, 0.25, 0.75];
    scene.finishes[0].diffuse = [0.8; 3];
    if let Some(paint) = &mut scene.elements[0].paint {
        paint.corners = [color; 3];
    }
    let seen = draw(&scene, SIZE);
    scene.elements[0].paint = None;
    scene.finishes[1].diffuse = color.map(|c| 0.8 * c);
    scene.finishes[1].ambient = color.map(|c| 0.9 * c);
    let want = draw(&scene, SIZE);
    assert!(want.iter().any(|pixel| pixel[0] > 120), "not lit");
    for (a, b) in seen.into_iter().zip(want) {
        assert!(apart(a, b) <= 1, "{a:?} {b:?}");
    }
}

#[test]
fn flesh_over_a_painted_triangle_takes_the_colour_of_the_foot() {
    let mut scene = painting(Shape::triangle(CORNERS, 0.0));
    scene.elements[0].flesh = Some(0);
    scene.flesh[0].blobbiness = Some(30.0);
    scene.flesh[0].radius = 0.05;
    // The height of the flesh moves the foot a little: the ray is not at right angles to the plane.
    assert!(compare(&scene, 0.05, 12.0) > 100);
}
