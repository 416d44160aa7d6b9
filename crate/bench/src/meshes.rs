//! Meshes against other programs and as wasm: what the example `peers` of `crate/mesher` prints.

use crate::programs::{Figures, example, example_as_wasm};
use crate::report::{Report, Short};
use crate::series::in_turn;
use anyhow::Result;

/// Scenes that `LevelSet` meshes.
const SCENES: [&str; 3] = ["tests/bench/seahorse.rat", "tests/bench/coral.rat", FIDGET];
/// The goal: the least ratio of the time of `LevelSet` to ours.
const FASTER: f64 = 5.0;
/// The goal: the greatest ratio of our triangles to those of `LevelSet`.
const FEWER: f64 = 1.0 / 3.0;
/// Scene that fidget meshes, with the quartic kernel.
const FIDGET: &str = "tests/bench/flake-820.rat";
/// The goal: the least ratio of fidget's time to ours.
const FASTER_THAN_FIDGET: f64 = 3.0;
/// Scene that is meshed as wasm.
const WASM: &str = "seahorse";
/// The goal: the greatest ratio of the time as wasm to the native one.
const SLOWER: f64 = 1.8;
/// Runs of each.
const ROUNDS: usize = 3;

/// Measures.
pub fn measure() -> Result<Report> {
    let mut report = Report::default();
    let said = example("mesher", "peers", &[&["level-set"], &SCENES[..]].concat())?;
    for line in said.lines() {
        let found = Figures::new(line)?;
        let mesh = format!("mesh of {}", found.text("scene"));
        let against = "LevelSet at equal measured error";
        let faster = row(&mut report, &found, "", "LevelSet")?;
        report.goal(
            &format!("{mesh}, speed | {against} | ≥ {FASTER}×"),
            Ok(faster),
        )?;
        let fewer = found.number("triangles")? / found.number("peer_triangles")?;
        let goal = format!("{mesh}, triangles | {against} | ≤ {FEWER}×");
        report.goal(&goal, Ok(Short(fewer)))?;
    }
    let said = example("mesher --features fidget", "peers", &["fidget", FIDGET])?;
    let found = Figures::new(&said)?;
    let faster = row(&mut report, &found, ", quartic", "fidget")?;
    let mesh = format!("mesh of {}, quartic, speed", found.text("scene"));
    let against = "fidget-mesh at equal measured error";
    report.goal(
        &format!("{mesh} | {against} | ≥ {FASTER_THAN_FIDGET}×"),
        Ok(faster),
    )?;

    let [native, wasm] = in_turn(ROUNDS, |i| {
        let run = [example, example_as_wasm][i];
        Figures::new(&run("mesher", "peers", &["alone", SCENES[0]])?)?.number("seconds")
    })?;
    report.set("scene", WASM);
    report.set("rounds", ROUNDS);
    report.set("native", Short(native.best()));
    report.set("wasm", Short(wasm.best()));
    let goal = format!("mesh of {WASM} as wasm | the native one, one thread | ≤ {SLOWER}×");
    report.goal(&goal, Ok(wasm.over(&native)))?;
    Ok(report)
}

/// Adds a row to the table, and returns how many times as fast as the other ours is.
fn row(report: &mut Report, found: &Figures, kernel: &str, other: &str) -> Result<Short> {
    let (s, peer_s) = (found.number("seconds")?, found.number("peer_seconds")?);
    let (triangles, error) = (found.number("triangles")?, found.number("error")?);
    let (peer_triangles, peer_error) =
        (found.number("peer_triangles")?, found.number("peer_error")?);
    let (scene, proved) = (found.text("scene"), found.number("proved")?);
    let own = format!("{} | {triangles} | {proved:.1e} | {error:.1e}", Short(s));
    let peer = format!(
        "{other} | {} | {peer_triangles} | {peer_error:.1e}",
        Short(peer_s)
    );
    report.row("scenes", format!("{scene}{kernel} | {own} | {peer}"));
    Ok(Short(peer_s / s))
}
