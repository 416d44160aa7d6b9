//! Pictures are equal bit for bit, traced by one worker or by two on threads. That they are the
//! same as wasm, too, is seen in `pins.rs`; those of the page against those of the program are
//! compared in `tests/agree.test.mjs`.

use crate::common::{BENCH, EXAMPLES, EXAMPLES_WITH_FILES, FEW, TILE, compile, trace};
use scene::Scene;
use tracer::{Pass, Tile, tiles};

/// Tiles of a picture that are traced, spread over its middle.
const TILES: usize = 3;

/// Pixels of each tile, by one worker.
fn by_one(scene: &Scene, size: [u32; 2], pass: Pass, tiles: &[Tile]) -> Vec<Vec<u8>> {
    let done = trace(scene, size, tiles.iter().map(|&tile| (pass, tile)));
    done.into_iter().map(|(_, pixels, _)| pixels).collect()
}

/// Pixels of each tile, by two workers at the same time, each of which takes every other tile.
fn by_two(scene: &Scene, size: [u32; 2], pass: Pass, tiles: &[Tile]) -> Vec<Vec<u8>> {
    let [even, odd] = std::thread::scope(|scope| {
        let worker = |first: usize| {
            let own: Vec<Tile> = tiles.iter().skip(first).step_by(2).copied().collect();
            scope.spawn(move || by_one(scene, size, pass, &own))
        };
        [worker(0), worker(1)].map(|thread| thread.join().expect("it does not panic"))
    });
    let mut halves = [even.into_iter(), odd.into_iter()];
    (0..tiles.len())
        .filter_map(|i| halves[i % 2].next())
        .collect()
}

#[test]
fn workers_do_not_matter() {
    for name in FEW {
        let mut scene = compile(name);
        scene.settings.samples = 2;
        let size = scene.settings.frame.map(|n| n.min(320));
        let all = tiles(size[0], size[1], TILE);
        // The upper quarter may be empty.
        let some = all.iter().skip(all.len() / 4);
        let some = some.step_by((all.len() / (2 * TILES)).max(1)).take(TILES);
        let some: Vec<Tile> = some.copied().collect();
        for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
            let done = by_one(&scene, size, pass, &some);
            assert_eq!(done.len(), some.len(), "{name}, {pass:?}");
            let shows_something = done
                .iter()
                .any(|tile| tile.chunks_exact(4).any(|pixel| pixel != &tile[..4]));
            assert!(shows_something, "{name} shows nothing");
            let others = by_two(&scene, size, pass, &some);
            assert!(done == others, "{name}, {pass:?}: workers matter");
        }
    }
}

#[test]
fn no_example_is_left_out() {
    for (folder, known) in [
        (
            "../../www/examples",
            [&EXAMPLES[..], &EXAMPLES_WITH_FILES].concat(),
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
