//! Pictures are equal bit for bit, natively by one worker and by two on threads, and as wasm by two
//! workers, and take the same work. The lines `picture NAME PASS SIZE HASH WORK` that this test prints are
//! compared between platforms by `cargo xtask test wasm`. Whole pictures, those of the page against those
//! of the program, are compared in `tests/agree.test.mjs`.

use crate::common::{BENCH, EXAMPLES, TILE, compile, hash, say, traced};
use scene::Scene;
use tracer::{Pass, Stats, Tile, tiles};

/// So many tiles of a picture are traced, spread over its middle.
const TILES: usize = 3;
/// Scenes that take too long, and by what their pictures are smaller.
const SMALL: [(&str, u32); 3] = [("coils", 8), ("folds", 2), ("grasp", 2)];
/// At most n×n rays a pixel.
const SAMPLES: u32 = 2;

/// Pixels of each tile, and counts of the work for it, by one worker.
fn traced_by_one(
    scene: &Scene,
    size: [u32; 2],
    pass: Pass,
    tiles: &[Tile],
) -> Vec<(Vec<u8>, Stats)> {
    traced(scene, size, tiles.iter().map(|&tile| (pass, tile)))
        .into_iter()
        .map(|(_, pixels, stats)| (pixels, stats))
        .collect()
}

/// The same by two workers that take tiles in turn, natively at the same time.
fn traced_by_two(
    scene: &Scene,
    size: [u32; 2],
    pass: Pass,
    tiles: &[Tile],
) -> Vec<(Vec<u8>, Stats)> {
    let half =
        |first: usize| -> Vec<Tile> { tiles.iter().skip(first).step_by(2).copied().collect() };
    #[cfg(not(target_arch = "wasm32"))]
    let [even, odd] = std::thread::scope(|scope| {
        let worker = |first| scope.spawn(move || traced_by_one(scene, size, pass, &half(first)));
        [worker(0), worker(1)].map(|thread| thread.join().expect("it does not panic"))
    });
    #[cfg(target_arch = "wasm32")]
    let [even, odd] = [0, 1].map(|first| traced_by_one(scene, size, pass, &half(first)));
    let mut halves = [even.into_iter(), odd.into_iter()];
    (0..tiles.len())
        .filter_map(|i| halves[i % 2].next())
        .collect()
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn pictures_are_the_same_whoever_traces_them() {
    for (name, text) in EXAMPLES.into_iter().chain(BENCH) {
        let mut scene = compile(text);
        let bytes = worker::message::pack(&scene).expect("a scene is packed");
        say(&format!("picture {name} scene {:016x}", hash(&bytes)));
        scene.settings.samples = SAMPLES;
        let small = SMALL.iter().find(|(slow, _)| *slow == name);
        let size = scene
            .settings
            .frame
            .map(|n| n / small.map_or(1, |(_, by)| *by));
        let all = tiles(size[0], size[1], TILE);
        // The upper quarter of an example may be empty; a ball that is measured stands there.
        let is_bench = BENCH.iter().any(|(bench, _)| *bench == name);
        let first = if is_bench { 0 } else { all.len() / 4 };
        let tiles = all.iter().skip(first);
        let tiles = tiles.step_by((all.len() / (2 * TILES)).max(1)).take(TILES);
        let tiles: Vec<Tile> = tiles.copied().collect();
        for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
            let done = traced_by_two(&scene, size, pass, &tiles);
            assert_eq!(done.len(), tiles.len(), "{name}, {pass:?}");
            // One that does all has more samples already, and so less work, for the same pixels.
            #[cfg(not(target_arch = "wasm32"))]
            assert!(
                done.iter()
                    .map(|(pixels, _)| pixels)
                    .eq(traced_by_one(&scene, size, pass, &tiles)
                        .iter()
                        .map(|(pixels, _)| pixels)),
                "{name}, {pass:?}: it matters how many workers there are"
            );
            let pixels = done.iter().flat_map(|(pixels, _)| pixels);
            let pixels: Vec<u8> = pixels.copied().collect();
            assert!(
                pass == Pass::Coarse || pixels.chunks_exact(4).any(|pixel| pixel != &pixels[..4]),
                "{name} shows nothing"
            );
            let count =
                |of: fn(&Stats) -> u64| done.iter().map(|(_, stats)| of(stats)).sum::<u64>();
            say(&format!(
                "picture {name} {pass:?} {}x{} {:016x} {} {} {}",
                size[0],
                size[1],
                hash(&pixels),
                count(|stats| stats.primary_rays),
                count(|stats| stats.shadow_rays),
                count(|stats| stats.field_evaluations),
            ));
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn no_example_is_left_out() {
    for (folder, known) in [
        (
            "../../www/examples",
            [&EXAMPLES[..], &crate::common::EXAMPLES_WITH_FILES].concat(),
        ),
        ("../../tests/bench", BENCH.to_vec()),
    ] {
        for entry in std::fs::read_dir(folder).expect("the folder is there") {
            let name = entry.expect("it can be read").file_name();
            let name = name.to_str().expect("a plain name");
            // Files that the others read.
            let Some(name) = name.strip_suffix(".rat").filter(|name| *name != "flake") else {
                continue;
            };
            assert!(known.iter().any(|(other, _)| *other == name), "{name}");
        }
    }
}
