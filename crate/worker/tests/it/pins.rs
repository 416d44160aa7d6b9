//! Whole pictures are the ones that `tests/pins.txt` keeps the hashes of: natively as the program
//! traces them, as wasm as a worker does. A change of the pictures that is meant is written there
//! by `cargo xtask pins`, which shows the old and the new ones.
//!
//! With `SINEW_PICTURES` set to a folder, the native tests compare nothing: they write each picture
//! there as `NAME-PASS.ppm` and print its pin. The command runs them so.

use crate::common::{BENCH, EXAMPLES, EXAMPLES_WITH_FILES, compile_text, hash};
use scene::Scene;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;
use tracer::{Pass, Tile};

const PINS: &str = include_str!("../../../../tests/pins.txt");
/// Width and height of the pictures, pixels.
const SIZE: u32 = 256;
/// Scenes that take too long, and the sides of the squares in the middle of their pictures that are
/// traced instead, pixels.
const PARTS: [(&str, u32); 14] = [
    ("coils", 12),
    ("coral-crab", 128),
    ("elder", 8),
    ("flake-7381-cauchy", 16),
    ("folds", 64),
    ("generators", 64),
    ("grasp", 64),
    ("heads", 128),
    ("octopus", 128),
    ("pebbles", 128),
    ("queen", 16),
    ("squeeze", 128),
    ("still-life", 128),
    ("touching", 128),
];
/// The most rays a pixel is n×n, so that the smooth pass has something to do in every scene.
const SAMPLES: u32 = 2;
const PASSES: [Pass; 2] = [Pass::Full, Pass::Smooth];

/// The square in the middle of a picture.
fn middle(side: u32) -> Tile {
    let first = (SIZE - side) / 2;
    let (x, y) = (first, first);
    let (width, height) = (side, side);
    Tile {
        x,
        y,
        width,
        height,
    }
}

/// RGBA bytes of a part of the picture, one for each of [`PASSES`].
#[cfg(not(target_arch = "wasm32"))]
fn pictures(scene: &Scene, part: Tile) -> [Vec<u8>; 2] {
    let picture = tracer::Picture::new(scene, [SIZE; 2]);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    PASSES.map(|pass| {
        if part.width == SIZE {
            return tracer::render(&picture, threads, pass, &|_| {}).0;
        }
        let traced = picture.trace(part, pass, &|| false, &mut tracer::Stats::default());
        traced.expect("nobody stops it")
    })
}

/// RGBA bytes of a part of the picture, one for each of [`PASSES`].
#[cfg(target_arch = "wasm32")]
fn pictures(scene: &Scene, part: Tile) -> [Vec<u8>; 2] {
    let tiles = if part.width == SIZE {
        tracer::tiles(SIZE, SIZE, crate::common::TILE)
    } else {
        vec![part]
    };
    let orders = PASSES
        .iter()
        .flat_map(|&pass| tiles.iter().map(move |&tile| (pass, tile)));
    let done = crate::common::trace(scene, [SIZE; 2], orders);
    assert_eq!(done.len(), 2 * tiles.len());
    [0, 1].map(|pass| {
        let mut picture = vec![0; 4 * (part.width * part.height) as usize];
        for (tile, pixels, _) in &done[pass * tiles.len()..][..tiles.len()] {
            let rows = pixels.chunks_exact(4 * tile.width as usize);
            for (y, row) in (tile.y - part.y..).zip(rows) {
                let at = 4 * (y * part.width + tile.x - part.x) as usize;
                picture[at..at + row.len()].copy_from_slice(row);
            }
        }
        picture
    })
}

/// The pins of a text, `NAME PASS SIDE HASH` a line, by `NAME PASS`. Lines that begin with `#` are
/// comments.
fn pins(text: &str) -> BTreeMap<String, String> {
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let (picture, pin) = line
                .match_indices(' ')
                .nth(1)
                .map(|(at, _)| line.split_at(at))
                .expect("a pin is NAME PASS SIDE HASH");
            (picture.to_owned(), pin.trim().to_owned())
        })
        .collect()
}

/// The folder that pictures are written to in place of a comparison; none as wasm.
fn folder() -> Option<PathBuf> {
    std::env::var_os("SINEW_PICTURES").map(PathBuf::from)
}

/// A file of an opaque square picture.
fn ppm(size: u32, rgba: &[u8]) -> Vec<u8> {
    let mut file = format!("P6 {size} {size} 255\n").into_bytes();
    for pixel in rgba.chunks_exact(4) {
        assert_eq!(pixel[3], 255);
        file.extend(&pixel[..3]);
    }
    file
}

/// A sentence for each picture that is not as pinned.
fn changes(pinned: &BTreeMap<String, String>, drawn: &BTreeMap<String, String>) -> String {
    let mut said = String::new();
    for (picture, pin) in drawn {
        match pinned.get(picture) {
            None => writeln!(said, "The picture {picture} has no pin.").expect("text"),
            Some(old) if old != pin => writeln!(
                said,
                "The picture {picture} has changed: it was {old}, it is {pin}."
            )
            .expect("text"),
            Some(_) => {}
        }
    }
    said
}

/// Draws scenes of a place and compares them with their pins.
fn compare(place: &str, scenes: &[(&str, &str)]) {
    let folder = folder();
    let mut drawn = BTreeMap::new();
    for (name, text) in scenes {
        let mut scene = compile_text(text);
        scene.settings.samples = SAMPLES;
        let part = PARTS.iter().find(|(slow, _)| slow == name);
        let size = part.map_or(SIZE, |(_, side)| *side);
        for (pass, pixels) in PASSES.iter().zip(pictures(&scene, middle(size))) {
            let picture = format!("{place}/{name} {pass:?}");
            let pin = format!("{size} {:016x}", hash(&pixels));
            if let Some(folder) = &folder {
                println!("pin {picture} {pin}");
                let file = folder.join(format!("{place}-{name}-{pass:?}.ppm"));
                std::fs::write(file, ppm(size, &pixels)).expect("the folder takes pictures");
            }
            drawn.insert(picture, pin);
        }
    }
    if folder.is_some() {
        return;
    }
    let said = changes(&pins(PINS), &drawn);
    assert!(
        said.is_empty(),
        "\n{said}If that is meant, look at the old and new pictures and renew tests/pins.txt: \
         cargo xtask pins\n"
    );
}

// In parts, so that they run side by side, also as wasm. The names are in the order of the file.

#[test]
fn pictures_are_as_pinned_1() {
    compare("example", &EXAMPLES[..16]);
}

#[test]
fn pictures_are_as_pinned_2() {
    compare("example", &EXAMPLES[16..32]);
}

#[test]
fn pictures_are_as_pinned_3() {
    compare("example", &EXAMPLES[32..]);
}

#[test]
fn pictures_are_as_pinned_4() {
    compare("example", &EXAMPLES_WITH_FILES);
}

#[test]
fn pictures_are_as_pinned_5() {
    compare("bench", &BENCH);
}

#[test]
#[cfg(not(target_arch = "wasm32"))]
fn changed_and_missing_pictures_are_told() {
    let old = pins("# comment\na Full 8 01\nb Full 8 02\n");
    let new = pins("a Full 8 01\nb Full 8 12\nd Full 8 04\n");
    assert_eq!(changes(&old, &old), "");
    assert_eq!(
        changes(&old, &new),
        "The picture b Full has changed: it was 8 02, it is 8 12.\n\
         The picture d Full has no pin.\n"
    );
}

#[test]
#[cfg(not(target_arch = "wasm32"))]
fn each_pin_is_of_a_scene() {
    let examples = EXAMPLES.iter().chain(&EXAMPLES_WITH_FILES);
    let examples = examples.map(|(name, _)| format!("example/{name}"));
    let bench = BENCH.iter().map(|(name, _)| format!("bench/{name}"));
    let pictures = examples.chain(bench);
    let pictures = pictures.flat_map(|name| PASSES.map(|pass| format!("{name} {pass:?}")));
    let mut pictures: Vec<String> = pictures.collect();
    pictures.sort_unstable();
    assert!(pictures.iter().eq(pins(PINS).keys()));
}
