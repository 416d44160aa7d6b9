//! The true surface on an adapter, held to the tracer.

use crate::common::traced::{Card, Differs, compare, open};
use cells::Detail;
use field::Kernel;
use preview::Stage;
use scene::Scene;
use trials::scenes::KINDS;
use trials::{Random, count};

/// Width and height of the pictures.
const SIZE: [u32; 2] = [128, 128];

macro_rules! examples {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!("../../../../www/examples/", $name, ".rat")))),*]
    };
}

/// Endless kernels; a plain sum, hard shapes and blended colours; a soft plane; a function that is
/// no sum.
const EXAMPLES: [(&str, &str); 4] = examples!["planets" "tshape" "blends" "coating"];

fn compile(name: &str, text: &str) -> Scene {
    let project = rats::Project {
        files: vec![rats::File {
            name: format!("{name}.rat"),
            text: text.into(),
        }],
    };
    let compiled = rats::compile(&project);
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

fn differs(card: &Card, scene: &Scene) -> Differs {
    let (mut tracer, _) = card.prepare(scene, Detail::Full, Stage::Compute);
    let pixels = card.read(&mut tracer, &scene.camera, SIZE);
    compare(scene, SIZE, &pixels)
}

/// Whether a picture is as the tracer's. A pixel of the edge weighs more in a small one.
fn is_close(found: Differs) -> bool {
    found.coverage <= 0.004 && found.distance <= 0.01 && found.normal <= 0.02
}

#[test]
fn examples_are_as_traced() {
    let Some(card) = open() else { return };
    let mut failed = Vec::new();
    for (name, text) in EXAMPLES {
        let found = differs(&card, &compile(name, text));
        println!("{name}: {found:?}");
        if !is_close(found) {
            failed.push((name, found));
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

/// The quick draft of a body with limbs that are thinner than the cells of its mesh: they are not
/// lost.
#[test]
fn quick_drafts_keep_thin_limbs() {
    let Some(card) = open() else { return };
    let [(name, text)] = examples!["sea-urchin"];
    let scene = compile(name, text);
    let (mut tracer, packed) = card.prepare(&scene, Detail::Quick, Stage::Compute);
    assert_eq!(packed.meshed, [0]);
    let pixels = card.read(&mut tracer, &scene.camera, [256, 256]);
    let found = compare(&scene, [256, 256], &pixels);
    println!("{name}: {found:?}");
    assert!(found.coverage <= 0.03, "{found:?}");
}

#[test]
fn both_stages_draw_the_same() {
    let Some(card) = open() else { return };
    for (name, text) in &EXAMPLES[1..2] {
        let scene = compile(name, text);
        let (mut tracer, _) = card.prepare(&scene, Detail::Full, Stage::Compute);
        let pixels = card.read(&mut tracer, &scene.camera, SIZE);
        let (mut tracer, _) = card.prepare(&scene, Detail::Full, Stage::Fragment);
        let colours = card.colours(&mut tracer, &scene.camera, SIZE);
        let differ = pixels.iter().zip(&colours).filter(|(pixel, colour)| {
            let channels = pixel.colour.iter().zip(*colour);
            channels
                .into_iter()
                .any(|(one, other)| (one * 255.0 - f32::from(*other)).abs() > 2.0)
        });
        let (count, all) = (differ.count(), pixels.len());
        assert!(
            count * 1000 <= all,
            "{name}: {count} of {all} pixels differ"
        );
    }
}

#[test]
fn random_scenes_are_as_traced() {
    let Some(card) = open() else { return };
    let mut random = Random::new(45);
    let mut failed = Vec::new();
    for n in 0..count(9) {
        let kernel = Kernel::ALL[n % Kernel::ALL.len()];
        let kind = KINDS[random.below(KINDS.len())];
        let (scene, _) = trials::scenes::scene(kernel, kind, &mut random);
        let found = differs(&card, &scene);
        println!("{kernel:?} {kind:?}: {found:?}");
        if !is_close(found) {
            failed.push((kernel, kind, found));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
