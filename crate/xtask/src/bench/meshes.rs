//! Meshes against other programs and as wasm: what the example `peers` of `crate/mesher` prints.

use super::Piece;
use super::goal::{Goal, Wanted, short};
use crate::shell::{cargo, command, find, root, run, run_and_read, target};
use anyhow::{Context, Result};
use serde_json::Value;
use std::fmt::Write;

const SCENES: [&str; 3] = ["seahorse", "coral", "flake-820"];
/// How many times as fast as `LevelSet`, and at most which share of the triangles.
const FASTER: f64 = 5.0;
const FEWER: f64 = 1.0 / 3.0;

/// Scene that fidget meshes, with the quartic kernel, and how many times as fast ours is to be.
const FIDGET: &str = "flake-820";
const FASTER_THAN_FIDGET: f64 = 3.0;

/// Scene that is meshed as wasm, the largest ratio of its time to the native one, and the number of runs of each.
const WASM: &str = "seahorse";
const SLOWER: f64 = 1.8;
const ROUNDS: usize = 3;

/// Measures.
pub fn measure() -> Result<Piece> {
    let mut page = String::from(
        "One thread, a tolerance of a thousandth of the box's diagonal. The others' edges are the longest ones found at which their \
         measured error is ours. `LevelSet` of manifold-rust has the same field, evaluated by what matters in each cell of a grid; \
         fidget-mesh compiles the balls' quartic fields for the processor. Errors are the largest distances found, either way. Only ours \
         proves the topology.\n\n\
         | scene | s | triangles | proved error | measured | other | s | triangles | measured |\n\
         |---|--:|--:|--:|--:|---|--:|--:|--:|\n",
    );
    let mut goals = Vec::new();
    for line in printed("level-set", &SCENES, &[])?.lines() {
        let row = Row::new(line)?;
        row.write(&mut page, "LevelSet")?;
        let against = || String::from("LevelSet at equal measured error");
        goals.push(Goal {
            what: format!("mesh of {}, speed", row.scene),
            against: against(),
            wanted: Wanted::AtLeast(FASTER),
            unit: "×",
            measured: Ok(row.number("peer_seconds")? / row.number("seconds")?),
        });
        goals.push(Goal {
            what: format!("mesh of {}, triangles", row.scene),
            against: against(),
            wanted: Wanted::AtMost(FEWER),
            unit: "×",
            measured: Ok(row.number("triangles")? / row.number("peer_triangles")?),
        });
    }
    let printed = printed("fidget", &[FIDGET], &["--features", "fidget"])?;
    let mut row = Row::new(&printed)?;
    row.scene += ", quartic";
    row.write(&mut page, "fidget")?;
    goals.push(Goal {
        what: format!("mesh of {}, speed", row.scene),
        against: "fidget-mesh at equal measured error".into(),
        wanted: Wanted::AtLeast(FASTER_THAN_FIDGET),
        unit: "×",
        measured: Ok(row.number("peer_seconds")? / row.number("seconds")?),
    });
    let [native, wasm] = as_wasm()?;
    writeln!(
        page,
        "\n{WASM} as wasm, in node: {} s, natively {} s; the quickest of {ROUNDS} each.",
        short(wasm),
        short(native)
    )?;
    goals.push(Goal {
        what: format!("mesh of {WASM} as wasm"),
        against: "the native one, one thread".into(),
        wanted: Wanted::AtMost(SLOWER),
        unit: "×",
        measured: Ok(wasm / native),
    });
    Ok((goals, page + "\n"))
}

/// A line that the example prints.
struct Row {
    scene: String,
    values: Value,
}

impl Row {
    fn new(line: &str) -> Result<Self> {
        let values: Value = serde_json::from_str(line.trim())?;
        let scene = values["scene"].as_str().context("no scene")?.to_owned();
        Ok(Self { scene, values })
    }

    fn number(&self, key: &str) -> Result<f64> {
        let number = self.values[key].as_f64();
        number.with_context(|| format!("no {key} in {}", self.values))
    }

    /// Adds a row to the table.
    fn write(&self, page: &mut String, other: &str) -> Result<()> {
        writeln!(
            page,
            "| {} | {} | {} | {:.1e} | {:.1e} | {other} | {} | {} | {:.1e} |",
            self.scene,
            short(self.number("seconds")?),
            self.number("triangles")?,
            self.number("proved")?,
            self.number("error")?,
            short(self.number("peer_seconds")?),
            self.number("peer_triangles")?,
            self.number("peer_error")?,
        )?;
        Ok(())
    }
}

fn file(scene: &str) -> String {
    format!("tests/bench/{scene}.rat")
}

/// Lines that the example prints about some scenes.
fn printed(kind: &str, scenes: &[&str], features: &[&str]) -> Result<String> {
    let files: Vec<String> = scenes.iter().map(|scene| file(scene)).collect();
    let mut options = vec!["run", "--release", "--quiet", "--package", "mesher"];
    options.extend_from_slice(features);
    options.extend(["--example", "peers", "--", kind]);
    options.extend(files.iter().map(String::as_str));
    run_and_read(&mut cargo(&options))
}

/// Seconds of a mesh natively, and as wasm with simd128 in node.
fn as_wasm() -> Result<[f64; 2]> {
    const TARGET: &str = "wasm32-wasip1";
    if find("rustup").is_some() {
        run(&mut command("rustup", &["target", "add", TARGET]))?;
    }
    let build = [
        "build",
        "--release",
        "--quiet",
        "--package",
        "mesher",
        "--example",
        "peers",
    ];
    run(&mut cargo(&build))?;
    run(&mut cargo(&[&build[..], &["--target", TARGET]].concat()))?;
    let example = |folder: &str, name: &str| {
        let path = target().join(folder).join("release/examples").join(name);
        path.to_string_lossy().into_owned()
    };
    let script = root().join("tests/bench/wasi.mjs");
    let file = file(WASM);
    let mut best = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        let native = example("", if cfg!(windows) { "peers.exe" } else { "peers" });
        let mut native = command(&native, &["alone", &file]);
        let mut wasm = command(
            "node",
            &[
                "--no-warnings",
                &script.to_string_lossy(),
                &example(TARGET, "peers.wasm"),
                "alone",
                &file,
            ],
        );
        for (best, command) in best.iter_mut().zip([&mut native, &mut wasm]) {
            let seconds = Row::new(&run_and_read(command)?)?.number("seconds")?;
            *best = best.min(seconds);
        }
    }
    Ok(best)
}
