//! The scenes of `tests/bench/`, compiled.
#![allow(dead_code)]

use rats::{File, Project};
use scene::Scene;

const FLAKE: &str = include_str!("../../../../tests/bench/flake.rat");

macro_rules! bench {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../../tests/bench/", $name, ".rat")),
        )
    };
}

/// Names and texts.
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

/// What a text means; it may read `flake.rat`.
pub fn compile(text: &str) -> Scene {
    let file = |name: &str, text: &str| File {
        name: name.into(),
        text: text.into(),
    };
    let project = Project {
        files: vec![file("main.rat", text), file("flake.rat", FLAKE)],
    };
    let compiled = rats::compile(&project);
    assert_eq!(compiled.diagnostics, []);
    compiled.scene
}

/// Prints a line, natively and as wasm.
#[cfg(not(target_arch = "wasm32"))]
pub fn say(line: &str) {
    println!("{line}");
}

/// Prints a line, natively and as wasm.
#[cfg(target_arch = "wasm32")]
pub fn say(line: &str) {
    wasm_bindgen_test::console_log!("{line}");
}
