//! Tests of textures in pictures, in the coordinates of their objects and mixed by the shares of
//! elements.

use crate::looks::*;
use glam::{DAffine3, DQuat, DVec3, Vec3};
use scene::{Finish, Frame, Scene, Shape};
use std::sync::Arc;
use texture::{
    Image, Mapping, Method, Region, Rgb8, Site, Solid, Surface, Target, Texture, Uv, Wave, apply,
    uv,
};
use tracer::Picture;

const SIZE: [u32; 2] = [40, 30];

/// Returns a finish that glows in the colours of its textures.
fn glowing(layers: Vec<Texture>) -> Finish {
    Finish {
        ambient: [0.9, 0.8, 0.7],
        layers,
        ..black()
    }
}

fn bare() -> Surface {
    Surface {
        diffuse: Vec3::ZERO,
        ambient: Vec3::new(0.9, 0.8, 0.7),
        ..Surface::default()
    }
}

/// Compares each pixel that hits something with the colour that `expect` returns, given the hit's
/// position and normal; returns the number of hits.
fn check(scene: &Scene, expect: impl Fn(DVec3, DVec3) -> Vec3) -> usize {
    let picture = Picture::new(scene, SIZE);
    let hits = picture.cast(&rays(scene, SIZE));
    let (mut count, mut off) = (0, 0);
    for (pixel, hit) in draw(scene, SIZE).into_iter().zip(hits) {
        let Some(hit) = hit else { continue };
        let want = expect(hit.position, hit.normal).to_array();
        let want = want.map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
        count += 1;
        // A hit that is 10⁻⁴ aside may be on the other side of an edge of the pattern.
        off += usize::from(apart(pixel, want) > 2);
    }
    assert!(off * 50 <= count, "{off} of {count}");
    count
}

#[test]
fn a_texture_turns_and_scales_with_its_object() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.7, -0.4, 1.1);
    let to_world = DAffine3::from_scale_rotation_translation(
        DVec3::splat(0.5),
        turn,
        DVec3::new(0.1, -0.2, 0.3),
    );
    let growth = 0.5;
    let center = DVec3::new(0.2, 0.1, -0.3);
    let image = Rgb8 {
        size: [3, 2],
        bytes: (0..18).map(|i| i * 14).collect(),
    };
    let square = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
    let to_eye = to_world.matrix3.transpose() * DVec3::Z;
    let across = to_eye.normalize().any_orthonormal_pair();
    let region = Region {
        min: DVec3::splat(-5.0),
        max: DVec3::splat(5.0),
        corners: square
            .map(|(x, y)| center + 3.0 * to_eye.normalize() + x * across.0 + y * across.1),
    };
    let mut methods: Vec<Method> = Solid::ALL.into_iter().map(Method::Solid).collect();
    methods.push(Method::Waves([Wave::Hat, Wave::Sin2]));
    methods.push(Method::Image(0, Mapping::Plain));
    methods.push(Method::Image(0, Mapping::Region(region)));
    for method in methods {
        let layer = Texture {
            scale: DVec3::new(3.0, 2.0, 2.5),
            bounds: [DVec3::new(0.1, 0.3, 0.2), DVec3::ONE],
            ..Texture::new(Target::Ambient, method)
        };
        for soft in [false, true] {
            let mut scene = dark();
            scene.frames.push(Frame { to_world, growth });
            scene.images.push(Arc::new(image.clone()));
            let shape = ball(to_world.transform_point3(center), 0.9);
            let finish = glowing(vec![layer.clone()]);
            if soft {
                add_soft(&mut scene, shape, finish);
            } else {
                add(&mut scene, shape, finish);
            }
            scene.elements[0].frame = 1;
            // A second element, so that the scene is not centred at the first.
            add(
                &mut scene,
                ball(DVec3::new(1.4, 0.9, 0.0), 0.1),
                glowing(Vec::new()),
            );
            let count = check(&scene, |position, normal| {
                if position.x > 1.25 {
                    return bare().ambient;
                }
                let point = to_world.inverse().transform_point3(position);
                let normal = (turn.inverse() * normal).normalize();
                let uv = uv::sphere(center, point);
                let site = Site { point, normal, uv };
                let layers = [layer.clone()];
                apply(&layers, bare(), &site, &[&image as &dyn Image]).ambient
            });
            assert!(count > 200, "{count}");
        }
    }
}

#[test]
fn textures_dissolve_over_a_blend() {
    let waves = |wave, k| Texture {
        scale: DVec3::splat(k),
        ..Texture::new(Target::Ambient, Method::Waves(wave))
    };
    let first = waves([Wave::Hat, Wave::One], 5.0);
    let second = waves([Wave::One, Wave::Sin2], 9.0);
    let (base, apex) = (DVec3::new(-1.2, -0.2, 0.0), DVec3::new(0.0, 0.1, 0.0));
    let center = DVec3::new(0.7, 0.2, 0.1);
    let mut scene = dark();
    let radius = 0.3;
    let segment = Shape::cylinder(base, apex, radius);
    add_soft(&mut scene, segment, glowing(vec![first.clone()]));
    add_soft(&mut scene, ball(center, 0.5), glowing(vec![second.clone()]));
    let sum = scene.soft_surfaces().remove(0);
    let count = check(&scene, |point, normal| {
        let textured = |layer: &Texture, uv: Uv| {
            let site = Site { point, normal, uv };
            apply(core::slice::from_ref(layer), bare(), &site, &[]).ambient
        };
        let colours = [
            textured(&first, uv::segment(base, apex, point)),
            textured(&second, uv::sphere(center, point)),
        ];
        let weights = sum.sum.weights(point);
        let total: f64 = weights.iter().sum();
        let shares = weights.iter().map(|w| (w / total) as f32);
        let own = sum.element.iter().map(|&e| colours[e as usize]);
        shares.zip(own).map(|(share, colour)| share * colour).sum()
    });
    assert!(count > 200, "{count}");
}

#[test]
fn index_and_shine_blend_by_shares() {
    // Two balls of one place and size are half each: glass of index 1.3 and 1.7 is glass of 1.5.
    let mut whole = dark();
    ruler(&mut whole, -3.0, 2.0);
    let mut mixed = whole.clone();
    for (scene, indices) in [(&mut whole, [1.5, 1.5]), (&mut mixed, [1.3, 1.7])] {
        for index in indices {
            add_soft(scene, ball(DVec3::ZERO, 1.0), glass(index));
        }
    }
    let off = draw(&whole, SIZE).into_iter().zip(draw(&mixed, SIZE));
    let off = off
        .filter(|(a, b)| around(a[0], f64::from(b[0])) > 1.0)
        .count();
    assert!(off <= 2, "{off}");
}

#[test]
fn bumps_turn_normals_and_nothing_else() {
    let layer = Texture {
        times: DVec3::splat(0.7),
        scale: DVec3::splat(3.0),
        ..Texture::new(Target::Normal, Method::Solid(Solid::Ripples))
    };
    let towards = DVec3::new(0.3, 0.5, 0.8).normalize();
    let mut scene = dark();
    let finish = Finish {
        diffuse: [0.8; 3],
        layers: vec![layer.clone()],
        ..black()
    };
    add_soft(&mut scene, ball(DVec3::ZERO, 1.0), finish);
    let kind = scene::LightKind::Distant { towards };
    scene.lights.push(scene::Light::new(kind, [1.0; 3]));
    let count = check(&scene, |point, normal| {
        let site = Site {
            point,
            normal,
            uv: Uv::default(),
        };
        let surface = Surface {
            normal,
            ..Surface::default()
        };
        let bumped = apply(core::slice::from_ref(&layer), surface, &site, &[]).normal;
        let eye = scene.camera.eye - point;
        // Bumps that are turned away from the eye are not.
        let bumped = if bumped.dot(eye) > 0.0 {
            bumped
        } else {
            normal
        };
        let lit = normal.dot(towards) > 0.0;
        let slope = if lit {
            bumped.dot(towards).max(0.0)
        } else {
            0.0
        };
        Vec3::splat(0.8 * slope as f32)
    });
    assert!(count > 200, "{count}");
}

#[test]
fn layers_lie_upon_each_other_where_their_masks_let_them() {
    let colour = |c: DVec3| Texture {
        replace: true,
        ..Texture::new(Target::Ambient, Method::Colour(c))
    };
    let tiles = Texture {
        scale: DVec3::splat(2.0),
        mask: vec![true, false, false, true],
        ..colour(DVec3::X)
    };
    let mut scene = dark();
    let plane = Shape::plane(DVec3::new(-0.5, -0.5, 0.0), DVec3::Z, 0.0);
    add(&mut scene, plane, glowing(vec![colour(DVec3::Y), tiles]));
    check(&scene, |point, _| {
        // Tiles of half a unit, those on the diagonal red, the others as green as the layer below.
        let [x, y] = [point.x, point.y].map(|x| ((x + 0.5) * 2.0).floor() as i64);
        if (x + y) % 2 == 0 { Vec3::X } else { Vec3::Y }
    });
}
