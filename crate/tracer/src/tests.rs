//! Pictures against themselves at a far higher precision, with nothing cut off.
#[path = "../tests/common/mod.rs"]
pub mod common;

use crate::picture::{Picture, Stats};
use crate::slabs::Precision;
use crate::tile::{Pass, Tile};
use field::{Profile, Wave};
use scene::Scene;

const SIZE: u32 = 72;

fn trace(picture: &Picture) -> Vec<u8> {
    let whole = Tile {
        x: 0,
        y: 0,
        width: SIZE,
        height: SIZE,
    };
    let mut stats = Stats::default();
    picture
        .trace(whole, Pass::Full, &|| false, &mut stats)
        .expect("nobody asked to stop")
}

/// Shares of channels that differ by more than 1/255 and by more than 8/255.
fn difference(scene: &Scene) -> [f64; 2] {
    let mut picture = Picture::new(scene, [SIZE, SIZE]);
    let quick = trace(&picture);
    picture.soft.precision = Precision {
        first: 1e-4,
        last: 2e-6,
        shared: 1e-6,
        ..Precision::PICTURE
    };
    let exact = trace(&picture);
    [1, 8].map(|bar| {
        let off = quick
            .iter()
            .zip(&exact)
            .filter(|(a, b)| a.abs_diff(**b) > bar);
        off.count() as f64 / quick.len() as f64
    })
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn pictures_show_the_exact_surface() {
    let mut worst = [0.0f64; 2];
    for seed in 0..12 {
        let mut scene = common::blend(seed, 3 + seed as usize % 6);
        scene.settings.influence = 1e-3;
        let [slightly, visibly] = difference(&scene);
        worst = [worst[0].max(slightly), worst[1].max(visibly)];
    }
    // Silhouettes and the edges of shadows may move by a small part of a pixel.
    assert!(worst[0] < 0.02 && worst[1] < 0.005, "{worst:?}");
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn pictures_with_profiles_show_the_exact_surface() {
    let mut worst = [0.0f64; 2];
    for (seed, wave) in [Wave::Sin, Wave::Hat, Wave::Sin2, Wave::Saw, Wave::Step]
        .into_iter()
        .enumerate()
    {
        let mut scene = common::blend(seed as u64, 5);
        for material in &mut scene.materials[..2] {
            material.profile = Some(Profile {
                waves: [wave, Wave::One],
                scale: [8.0, 1.0],
                bounds: [0.6, 1.0],
                times: 1.2,
                restriction: 0.0,
            });
        }
        let [slightly, visibly] = difference(&scene);
        worst = [worst[0].max(slightly), worst[1].max(visibly)];
    }
    // A profile with jumps has no certified spans, so this bar is lower.
    assert!(worst[0] < 0.03 && worst[1] < 0.02, "{worst:?}");
}
