//! Tests that surfaces make no light from nothing, and that every pixel is a number.

use crate::looks::*;
use glam::DVec3;
use scene::{Background, Finish, Light, LightKind, Scene, Shape, Tone};
use trials::{Random, count};

const SIZE: [u32; 2] = [24, 18];

/// Returns diffuse, specular, reflected and transmitted shares of a channel that sum to 1.
fn shares(random: &mut Random) -> [f64; 4] {
    let parts = [0; 4].map(|_| random.unit());
    let whole: f64 = parts.iter().sum();
    parts.map(|part| part / whole)
}

/// Returns a material without light of its own whose shares sum to 1 in each channel.
fn random_finish(random: &mut Random) -> Finish {
    let channels = [0; 3].map(|_| shares(random));
    let [diffuse, specular, reflective, transparent] =
        [0, 1, 2, 3].map(|k| channels.map(|shares| shares[k] as f32));
    Finish {
        ambient: [0.0; 3],
        diffuse,
        specular,
        reflective,
        transparent,
        shine: random.range(1.0, 100.0) as f32,
        index: random.range(0.7, 2.4) as f32,
        dispersion: random.range(0.0, 0.2) as f32,
        ..Finish::default()
    }
}

fn shape(random: &mut Random) -> Shape {
    let center = random.vector(1.5);
    match random.below(5) {
        0 => Shape::cuboid(
            center,
            [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * random.range(0.001, 0.8)),
        ),
        1 => Shape::cylinder(center, random.vector(1.5), random.range(0.01, 0.5)),
        2 => Shape::triangle([center, random.vector(2.0), random.vector(2.0)], 0.0),
        _ => ball(center, random.range(0.2, 1.0)),
    }
}

/// Returns the brightest channel of a scene under a single light of this brightness.
fn brightest(seed: u64, light: f32) -> u8 {
    let mut random = Random::new(seed);
    let mut scene = dark();
    scene.settings.vanish = 0.0;
    for k in 0..7 {
        let (shape, finish) = (shape(&mut random), random_finish(&mut random));
        if k % 3 == 0 && !matches!(shape, Shape::Box(_)) {
            add_soft(&mut scene, shape, finish);
        } else {
            add(&mut scene, shape, finish);
        }
    }
    let kind = LightKind::Point {
        position: random.vector(8.0) + DVec3::Z * 4.0,
    };
    scene.lights.push(Light::new(kind, [light; 3]));
    draw(&scene, SIZE).into_iter().flatten().fold(0, u8::max)
}

#[test]
fn no_pixel_is_brighter_than_the_light() {
    let mut lit = 0;
    for seed in 0..count(40) as u64 {
        let found = brightest(seed, 0.5);
        assert!(
            found <= 128,
            "scene {seed}: {found} of 255 from a light of a half"
        );
        lit += usize::from(found > 30);
    }
    assert!(2 * lit > count(40), "only {lit} scenes are lit at all");
}

#[test]
fn a_background_is_not_made_brighter_by_what_stands_before_it() {
    for seed in 0..count(20) as u64 {
        let mut random = Random::new(seed);
        let mut scene = dark();
        scene.background = Background::Colour([0.5; 3]);
        for _ in 0..7 {
            let (shape, finish) = (shape(&mut random), random_finish(&mut random));
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

/// Returns a scene in which much may go wrong, without what would spread one bad number over
/// neighbours.
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
    let slab = Shape::cuboid(
        DVec3::new(-1.0, 0.0, 0.0),
        [DVec3::X * 0.8, DVec3::Y * 0.8, DVec3::Z * thin],
    );
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
                // A pixel whose light is no number would be black: everything here shines, mirrors
                // or lets the background through.
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
    let thin = Shape::cuboid(
        DVec3::new(0.0, 0.0, 2.0),
        [DVec3::X, DVec3::Y, DVec3::Z * 1e-6],
    );
    add(&mut scene, thin, glass(1.0));
    for (a, b) in draw(&scene, SIZE).into_iter().zip(bare) {
        assert!(apart(a, b) <= 1, "{a:?} {b:?}");
    }
}
