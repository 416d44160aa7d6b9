//! The scenes of `www/examples/` and `tests/bench/`, compiled, and traced as a worker traces them.

use rats::{Asset, File, Project};
use scene::Scene;
use std::sync::Arc;
use tracer::{Pass, Stats, Tile};
use worker::{Answer, Engine, Kind, Order, Request, Step};

/// Side of the tiles that the page asks for, pixels.
pub const TILE: u32 = 64;

const FLAKE: &str = include_str!("../../../../../tests/bench/flake.rat");

macro_rules! examples {
    ($($name:literal)*) => {
        [$((
            $name,
            include_str!(concat!("../../../../../www/examples/", $name, ".rat")),
        )),*]
    };
}

/// Names and texts of the examples.
pub const EXAMPLES: [(&str, &str); 49] = examples![
    "agate-shell" "blends" "coating" "coils" "coral-crab" "coral-tree" "cowrie" "drops" "falling"
    "fawn" "fireflies" "flakes" "floppy-ears" "fog-stones" "folds" "generators" "glass-drops"
    "grasp" "hermite-crab" "icicle" "jelly" "octopus" "pebbles" "planets" "sea-urchin" "seahorse"
    "seaweed" "shell-1" "shell-2" "shell-3" "snail" "sphereflake" "spinal-starecase" "squeeze"
    "starfish" "starfish-a" "starfish-b" "starfish-c" "starfish-d" "starfish-e" "starfish-f"
    "stem-flakes" "still-life" "tide" "time-map" "touching" "tshape" "urchin-patterns" "wrinkles"
];

/// Names and texts of the examples that read meshes and strokes of their own.
pub const EXAMPLES_WITH_FILES: [(&str, &str); 13] = examples![
    "diamond" "dog" "elder" "fish" "heads" "lattice" "molecule" "neuron" "queen" "slug"
    "triceratops" "vessels" "winter-tree"
];

macro_rules! files {
    ($include:ident, $($name:literal)*) => {
        [$((
            $name,
            $include!(concat!("../../../../../www/examples/", $name)),
        )),*]
    };
}

const STROKES: [(&str, &str); 4] =
    files![include_str, "dog.strokes" "fish.strokes" "slug.strokes" "triceratops.strokes"];
const ASSETS: [(&str, &[u8]); 8] = files![
    include_bytes,
    "dodecahedrane.xyz" "elder.obj" "head.obj" "lattice.3mf" "neuron.swc" "queen.obj" "tree.csv"
    "vessels.vtp"
];

macro_rules! bench {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../../../tests/bench/", $name, ".rat")),
        )
    };
}

/// Names and texts of the scenes that are measured.
pub const BENCH: [(&str, &str); 10] = [
    bench!("flake-1"),
    bench!("flake-10"),
    bench!("flake-91"),
    bench!("flake-820"),
    bench!("flake-7381"),
    bench!("flake-820-cauchy"),
    bench!("flake-7381-cauchy"),
    bench!("coral"),
    bench!("seahorse"),
    bench!("tee"),
];

/// Scenes for what is not tried on all: a plain sum, far fields, contact and local convolution,
/// textures and glass.
pub const FEW: [&str; 4] = ["tshape", "flake-820-cauchy", "squeeze", "glass-drops"];

/// Compiles the scene of a name.
pub fn compile(name: &str) -> Scene {
    let mut all = EXAMPLES.iter().chain(&BENCH);
    let (_, text) = all.find(|(known, _)| *known == name).expect("it is known");
    compile_text(text)
}

/// Compiles a text; it may read `flake.rat`, and the meshes and strokes of the examples.
pub fn compile_text(text: &str) -> Scene {
    let read = [("main.rat", text), ("flake.rat", FLAKE)];
    let files = read.into_iter().chain(STROKES).map(|(name, text)| File {
        name: name.into(),
        text: text.into(),
    });
    let project = Project {
        files: files.collect(),
    };
    let assets = ASSETS.map(|(name, bytes)| Asset::new(name, bytes));
    let compiled = rats::compile_at(&project, &assets, 0.0);
    let mut errors = compiled.diagnostics.iter();
    assert_eq!(errors.find(|d| d.severity == rats::Severity::Error), None);
    Arc::unwrap_or_clone(compiled.scene)
}

/// FNV-1a.
pub fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xCBF2_9CE4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3)
    })
}

/// Traces tiles as a worker does; returns the RGBA bytes and counts of work of each, in the given
/// order.
pub fn trace(
    scene: &Scene,
    size: [u32; 2],
    orders: impl Iterator<Item = (Pass, Tile)>,
) -> Vec<(Tile, Vec<u8>, Stats)> {
    let mut engine = Engine::default();
    engine.accept(Request::Begin {
        generation: 1,
        scene: Arc::new(scene.clone()),
        camera: None,
        size,
        kind: Kind::Colours,
        shared: false,
    });
    let orders = orders.map(|(pass, tile)| Order {
        generation: 1,
        tile,
        pass,
    });
    engine.accept(Request::Trace(orders.collect()));
    let mut done = Vec::new();
    loop {
        match engine.step(&|| false, &|| 0.0) {
            Step::Idle => return done,
            Step::Answer(Answer::Traced {
                order,
                pixels,
                stats,
                ..
            }) => done.push((order.tile, pixels, stats)),
            _ => {}
        }
    }
}
