//! The true surface on an adapter, held to the tracer.

use crate::common::traced::{Differs, compare, open};
use field::Kernel;
use preview::trace::{Detail, Stage};
use scene::Scene;
use trials::scenes::{KINDS, Kind};
use trials::{Random, count};

/// Width and height of the pictures.
const SIZE: [u32; 2] = [192, 192];

macro_rules! examples {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!("../../../../www/examples/", $name, ".rat")))),*]
    };
}

/// A plain sum, blended colours, hard shapes, endless kernels, contact and local convolution.
const EXAMPLES: [(&str, &str); 6] =
    examples!["seahorse" "tshape" "blends" "planets" "squeeze" "folds"];

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

fn differs(scene: &Scene) -> Option<Differs> {
    let card = open()?;
    let (mut tracer, _) = card.prepare(scene, Detail::Fine, Stage::Compute);
    let pixels = card.read(&mut tracer, &scene.camera, SIZE);
    Some(compare(scene, SIZE, &pixels))
}

#[test]
fn examples_are_as_traced() {
    let mut failed = Vec::new();
    for (name, text) in EXAMPLES {
        let Some(found) = differs(&compile(name, text)) else {
            return;
        };
        println!("{name}: {found:?}");
        // A pixel of the edge weighs more in a small picture.
        if found.coverage > 0.004 || found.distance > 0.01 || found.normal > 0.02 {
            failed.push((name, found));
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn both_stages_draw_the_same() {
    let Some(card) = open() else { return };
    for (name, text) in &EXAMPLES[..3] {
        let scene = compile(name, text);
        let (mut tracer, _) = card.prepare(&scene, Detail::Fine, Stage::Compute);
        let pixels = card.read(&mut tracer, &scene.camera, SIZE);
        let (mut tracer, _) = card.prepare(&scene, Detail::Fine, Stage::Fragment);
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
    let mut random = Random::new(45);
    let (mut failed, mut all) = (Vec::new(), 0);
    for kernel in Kernel::ALL {
        for kind in KINDS.into_iter().filter(|kind| *kind != Kind::Plane) {
            if !random.chance(count(25) as f64 / 100.0) {
                continue;
            }
            let (scene, _) = trials::scenes::scene(kernel, kind, &mut random);
            let Some(found) = differs(&scene) else { return };
            println!("{kernel:?} {kind:?}: {found:?}");
            all += 1;
            if found.coverage > 0.004 || found.distance > 0.01 || found.normal > 0.02 {
                failed.push((kernel, kind, found));
            }
        }
    }
    assert!(all > 5);
    assert!(failed.is_empty(), "{failed:#?}");
}
