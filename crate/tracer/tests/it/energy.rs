//! Light is not made from nothing, and no pixel is not a number.

use crate::looks::*;
use glam::DVec3;
use scene::{Background, Finish, Light, LightKind, Scene, Shape, Tone};

const SIZE: [u32; 2] = [24, 18];

/// A sequence of numbers in [0, 1), the same on every machine.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }

    fn point(&mut self, half: f64) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.between(-half, half)))
    }

    /// Diffuse, specular, mirrored and passed shares of a channel that sum to `sum`.
    fn shares(&mut self, sum: f64) -> [f64; 4] {
        let parts = [0; 4].map(|_| self.next());
        let whole: f64 = parts.iter().sum();
        parts.map(|part| sum * part / whole)
    }
}

/// A material without light of its own whose shares sum to 1 in each channel.
fn closed(chance: &mut Chance) -> Finish {
    let channels = [0; 3].map(|_| chance.shares(1.0));
    let of = |k: usize| [0, 1, 2].map(|channel| channels[channel][k] as f32);
    Finish {
        ambient: [0.0; 3],
        diffuse: of(0),
        specular: of(1),
        reflective: of(2),
        transparent: of(3),
        shine: chance.between(1.0, 100.0) as f32,
        index: chance.between(0.7, 2.4) as f32,
        dispersion: chance.between(0.0, 0.2) as f32,
        ..Finish::default()
    }
}

fn shape(chance: &mut Chance) -> Shape {
    let center = chance.point(1.5);
    match (5.0 * chance.next()) as u32 {
        0 => Shape::Box {
            center,
            axes: [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * chance.between(0.001, 0.8)),
        },
        1 => Shape::Cylinder {
            base: center,
            apex: chance.point(1.5),
            radius: chance.between(0.01, 0.5),
        },
        2 => Shape::Triangle {
            corners: [center, chance.point(2.0), chance.point(2.0)],
            radius: 0.0,
        },
        _ => ball(center, chance.between(0.2, 1.0)),
    }
}

/// The brightest channel of a scene under one light of this brightness that nothing else lights.
fn brightest(seed: u64, light: f32) -> u8 {
    let mut chance = Chance(seed);
    let mut scene = dark();
    scene.settings.vanish = 0.0;
    for k in 0..7 {
        let (shape, finish) = (shape(&mut chance), closed(&mut chance));
        if k % 3 == 0 && !matches!(shape, Shape::Box { .. }) {
            add_soft(&mut scene, shape, finish);
        } else {
            add(&mut scene, shape, finish);
        }
    }
    let kind = LightKind::Point {
        position: chance.point(8.0) + DVec3::Z * 4.0,
    };
    scene.lights.push(Light::new(kind, [light; 3]));
    draw(&scene, SIZE).into_iter().flatten().fold(0, u8::max)
}

#[test]
fn no_pixel_is_brighter_than_the_light() {
    let mut lit = 0;
    for seed in 0..40 {
        let found = brightest(seed, 0.5);
        assert!(
            found <= 128,
            "scene {seed}: {found} of 255 from a light of a half"
        );
        lit += u32::from(found > 30);
    }
    assert!(lit > 20, "only {lit} scenes are lit at all");
}

#[test]
fn a_background_is_not_made_brighter_by_what_stands_before_it() {
    for seed in 0..20 {
        let mut chance = Chance(seed);
        let mut scene = dark();
        scene.background = Background::Colour([0.5; 3]);
        for _ in 0..7 {
            let (shape, finish) = (shape(&mut chance), closed(&mut chance));
            add(&mut scene, shape, finish);
        }
        // Without lights a scene would be lit evenly.
        let kind = LightKind::Point {
            position: DVec3::new(0.0, 0.0, 4.0),
        };
        scene.lights.push(Light::new(kind, [0.0; 3]));
        let found = draw(&scene, SIZE).into_iter().flatten().fold(0, u8::max);
        assert!((100..=128).contains(&found), "scene {seed}: {found}");
    }
}

/// A scene with much that may go wrong: a lens and a tone that spread one bad number over neighbours are left out.
fn extreme(index: f32, dispersion: f32, thin: f64) -> Scene {
    let mut scene = dark();
    scene.background = Background::Colour([0.5, 0.6, 0.7]);
    scene.settings.tone = Tone::Filmic;
    // A ray may split at each surface.
    scene.settings.max_depth = 6;
    let finish = Finish {
        transparent: [0.6; 3],
        reflective: [0.3; 3],
        diffuse: [0.5; 3],
        dispersion,
        ..glass(index)
    };
    let slab = Shape::Box {
        center: DVec3::new(-1.0, 0.0, 0.0),
        axes: [DVec3::X * 0.8, DVec3::Y * 0.8, DVec3::Z * thin],
    };
    add(&mut scene, slab, finish.clone());
    add_soft(
        &mut scene,
        ball(DVec3::new(0.9, 0.2, 0.0), 0.7),
        finish.clone(),
    );
    // Touched at a grazing angle by the rays in the middle of the picture.
    add(
        &mut scene,
        ball(DVec3::new(0.0, -1.0, 0.0), 1.0),
        finish.clone(),
    );
    // One inside the other, with the same surface on one side.
    add(&mut scene, ball(DVec3::new(0.0, -0.5, 0.0), 0.5), finish);
    let kind = LightKind::Point {
        position: DVec3::new(0.0, 0.0, 6.0),
    };
    scene.lights.push(Light::new(kind, [1.0; 3]));
    scene
}

#[test]
fn no_number_is_lost_in_glass() {
    for index in [1.0, 1.0 + 1e-6, 0.01, 0.5, 1.5, 2.42, 100.0] {
        for dispersion in [0.0, 2.0] {
            for thin in [1e-3, 1e-9] {
                let scene = extreme(index, dispersion, thin);
                let pixels = draw(&scene, [13, 9]);
                // A pixel whose light is no number would be black: everything here shines, mirrors or lets the background through.
                let black = pixels.iter().filter(|p| **p == [0; 3]).count();
                assert_eq!(
                    black, 0,
                    "index {index}, dispersion {dispersion}, {thin} thick"
                );
            }
        }
    }
}

#[test]
fn an_index_of_one_bends_nothing() {
    let mut scene = dark();
    ruler(&mut scene, -3.0, 4.0);
    let bare = draw(&scene, SIZE);
    add(&mut scene, ball(DVec3::ZERO, 1.0), glass(1.0));
    let thin = Shape::Box {
        center: DVec3::new(0.0, 0.0, 2.0),
        axes: [DVec3::X, DVec3::Y, DVec3::Z * 1e-6],
    };
    add(&mut scene, thin, glass(1.0));
    for (a, b) in draw(&scene, SIZE).into_iter().zip(bare) {
        assert!(apart(a, b) <= 1, "{a:?} {b:?}");
    }
}
