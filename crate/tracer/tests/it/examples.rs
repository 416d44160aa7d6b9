//! Pictures of examples of the gallery whose skeletons fold and touch, against the reference.
//!
//! SINEW_SCENE names the only example to judge; the counts are printed with `--nocapture`.

use crate::judged::{Range, distances, is_outside, packet, reference};
use glam::DVec3;
use oracle::rays::Row;
use rats::Project;
use scene::Scene;
use tracer::Picture;
use trials::Random;

/// Side of the pictures, pixels.
const SIDE: u32 = 256;

macro_rules! example {
    ($name:literal, $frame:literal) => {
        (
            $name,
            include_str!(concat!("../../../../www/examples/", $name, ".rat")),
            $frame,
        )
    };
}

/// Names, texts and frames of the examples.
const EXAMPLES: [(&str, &str, u32); 8] = [
    example!("grasp", 0),
    example!("squeeze", 0),
    example!("touching", 0),
    example!("folds", 0),
    example!("octopus", 0),
    example!("coils", 0),
    example!("falling", 0),
    example!("falling", 40),
];

/// Returns the soft bodies of an example.
fn compile(name: &str, text: &str, frame: u32) -> Scene {
    let compiled = rats::compile_at(&Project::single(text), &[], f64::from(frame));
    let mut errors = compiled.diagnostics.iter();
    let error = errors.find(|d| d.severity == rats::Severity::Error);
    assert_eq!(error, None, "{name}");
    let mut scene = std::sync::Arc::unwrap_or_clone(compiled.scene);
    let soft: Vec<bool> = scene.elements.iter().map(|e| scene.is_soft(e)).collect();
    let mut soft = soft.into_iter();
    scene.elements.retain(|_| soft.next() == Some(true));
    scene
}

/// Returns the box around all that the camera sees.
fn range(scene: &Scene, picture: &Picture) -> Range {
    let rays: Vec<(DVec3, DVec3)> = (0..SIDE * SIDE / 16)
        .map(|i| pixel(scene, f64::from(i % 64) / 64.0, f64::from(i / 64) / 64.0))
        .collect();
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for hit in picture.cast(&rays).into_iter().flatten() {
        (low, high) = (low.min(hit.position), high.max(hit.position));
    }
    let half = 0.5 * (high - low);
    assert!(half.is_finite(), "the camera sees nothing");
    Range {
        center: 0.5 * (low + high),
        half,
        far: 2.0 * half.length(),
    }
}

/// Returns the ray of a place in the picture.
fn pixel(scene: &Scene, x: f64, y: f64) -> (DVec3, DVec3) {
    let projection = scene.camera.projection(SIDE, SIDE);
    (projection.eye, projection.direction(x, y))
}

/// Judges rays of an example, half of the packets from the camera, the others from around.
fn judge(name: &str, text: &str, frame: u32, rays: usize) -> Row {
    let scene = compile(name, text, frame);
    let picture = Picture::new(&scene, [SIDE; 2]);
    let mut reference = reference(&scene);
    let range = range(&scene, &picture);
    let eye = scene.camera.eye;
    assert!(is_outside(&mut reference, eye), "{name}");
    let far = eye.distance(range.center) + range.half.length();
    let mut numbers = Random::new(41 + u64::from(frame));
    let mut row = Row::default();
    while row.rays < rays as u64 {
        let (packet, limit) = if numbers.chance(0.5) {
            let (x, y) = (numbers.unit(), numbers.unit());
            let spread = numbers.decades(-3.0, -1.0);
            let rays = (0..8).map(|_| {
                let [x, y] = [x, y].map(|c| c + spread * numbers.range(-1.0, 1.0));
                pixel(&scene, x, y)
            });
            (rays.collect(), far)
        } else {
            let packet = packet(&mut numbers, &range, &picture, &mut reference);
            (packet, 2.0 * range.far)
        };
        let found = distances(&picture, &packet);
        let faults = row.judge((&picture, &mut reference), &packet, &found, limit);
        print!("{faults}");
    }
    println!("{name} frame {frame}: {row:?}");
    row
}

#[test]
fn examples_show_what_is_there() {
    let only = std::env::var("SINEW_SCENE").ok();
    let mut all = Row::default();
    for (name, text, frame) in EXAMPLES {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        let row = judge(name, text, frame, trials::count(50));
        assert!(row.missed == 0 && row.invented == 0, "{name} {row:?}");
        all.add(&row);
    }
    // Grazing rays may be left undecided.
    assert!(
        10 * all.hits > all.rays && 50 * all.uncertain <= all.rays,
        "{all:?}"
    );
}
