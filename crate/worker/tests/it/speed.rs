//! Time of the worker's engine for the scenes of `tests/bench/`, natively and as wasm. A
//! measurement: `cargo xtask bench wasm` runs it.

use crate::common::{BENCH, compile_text};
use scene::Scene;
use std::sync::Arc;
use std::time::Instant;
use tracer::{Pass, tiles};
use worker::{Engine, Kind, Order, Request, Step};

/// Side of the tiles that the page asks for.
const TILE: u32 = 64;
/// The least number of pictures of each scene, of which the quickest counts.
const PICTURES: usize = 3;
/// Seconds in which more pictures are begun: quick ones are easily disturbed, and wasm is first
/// compiled in haste.
const SECONDS: f64 = 0.6;
/// The most pictures of a scene, as clocks may be coarse.
const MOST: usize = 1000;

/// Scenes that tell something about speed and do not take long.
fn scenes() -> impl Iterator<Item = (&'static str, &'static str)> {
    let others = ["flake-1", "flake-91", "flake-7381-cauchy"];
    BENCH
        .into_iter()
        .filter(move |(name, _)| !others.contains(name))
}

/// Traces a picture as the page has it traced, and gives the seconds that it took.
fn picture(scene: &Scene) -> f64 {
    let size = scene.settings.frame;
    let mut engine = Engine::default();
    let start = Instant::now();
    engine.accept(Request::Begin {
        generation: 1,
        scene: Arc::new(scene.clone()),
        camera: None,
        size,
        kind: Kind::Colours,
        shared: false,
    });
    let tiles = tiles(size[0], size[1], TILE).into_iter();
    let orders = tiles.map(|tile| Order {
        generation: 1,
        tile,
        pass: Pass::Full,
    });
    engine.accept(Request::Trace(orders.collect()));
    while !matches!(engine.step(&|| false, &|| 0.0), Step::Idle) {}
    start.elapsed().as_secs_f64()
}

/// Lines `speed SCENE SECONDS`.
#[test]
#[ignore = "a measurement, for optimised builds"]
fn speed() {
    for (name, text) in scenes() {
        let scene = compile_text(text);
        let (mut best, mut all, mut count) = (f64::INFINITY, 0.0, 0);
        while count < PICTURES || (all < SECONDS && count < MOST) {
            let seconds = picture(&scene);
            best = best.min(seconds);
            all += seconds;
            count += 1;
        }
        println!("speed {name} {best:.5}");
    }
}
