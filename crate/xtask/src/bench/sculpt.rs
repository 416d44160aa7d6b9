//! What a step of a sculpting tool costs, natively and as wasm.

use super::Piece;
use super::goal::{Goal, Wanted, short};
use crate::shell::{cargo, command, find, root, run, run_and_read, target};
use anyhow::{Context, Result};
use serde_json::Value;
use std::fmt::Write;

/// A frame of a display with 60 Hz, ms.
const FRAME: f64 = 1000.0 / 60.0;
/// Vertices of the step that has to fit in a part of a frame.
const VERTICES: f64 = 2000.0;

/// Measures.
pub fn measure() -> Result<Piece> {
    let mut page = String::from(
        "A step of the same brush, in vertices, on balls of 10⁴ and of 10⁶ faces (`crate/sculpt/examples/cost.rs`; medians of 31 \
         places). *A vertex* compares the time for each vertex that moves; *plain passes* is the step on 10⁶ faces in times of a \
         pass that adds a vector to as many positions in a row.\n\n\
         | | action | vertices of 10⁴ | ms | vertices of 10⁶ | ms | a vertex | plain passes |\n|---|---|--:|--:|--:|--:|--:|--:|\n",
    );
    let mut goals = Vec::new();
    let native = run_and_read(&mut cargo(&[
        "run",
        "--release",
        "--quiet",
        "-p",
        "sculpt",
        "--example",
        "cost",
    ]))?;
    table("native", &native, 3.0, &mut page, &mut goals)?;
    match as_wasm() {
        Ok(said) => table("wasm", &said, 2.0, &mut page, &mut goals)?,
        Err(error) => writeln!(page, "\nAs wasm: not measured, {error:#}.")?,
    }
    Ok((goals, page))
}

/// The same program as wasm, run by Node.js.
fn as_wasm() -> Result<String> {
    const TARGET: &str = "wasm32-wasip1";
    if find("rustup").is_some() {
        run(&mut command("rustup", &["target", "add", TARGET]))?;
    }
    run(&mut cargo(&[
        "build",
        "--release",
        "--quiet",
        "-p",
        "sculpt",
        "--example",
        "cost",
        "--target",
        TARGET,
    ]))?;
    let wasm = target().join(TARGET).join("release/examples/cost.wasm");
    let script = root().join("tests/bench/wasi.mjs");
    run_and_read(&mut command(
        "node",
        &[
            "--no-warnings",
            &script.to_string_lossy(),
            &wasm.to_string_lossy(),
        ],
    ))
}

/// Adds rows of what the program said, and the goals: the same time on a large mesh, and a share of a frame.
fn table(
    with: &str,
    said: &str,
    parts: f64,
    page: &mut String,
    goals: &mut Vec<Goal>,
) -> Result<()> {
    let (mut times, mut share) = (0.0f64, 0.0f64);
    for line in said.lines().filter(|line| line.starts_with('{')) {
        let row: Value = serde_json::from_str(line)?;
        let number = |key: &str| row[key].as_f64().with_context(|| format!("no {key}"));
        let [small, small_ms, large, large_ms] =
            ["small", "small_ms", "large", "large_ms"].map(number);
        let (large, large_ms) = (large?, large_ms?);
        writeln!(
            page,
            "| {with} | {} | {} | {} | {large} | {} | {}× | {} |",
            row["action"].as_str().unwrap_or_default(),
            small?,
            short(small_ms?),
            short(large_ms),
            short(number("times")?),
            short(number("passes")?),
        )?;
        // Steps of a few vertices are too short for a clock.
        if large > 1000.0 {
            times = times.max(number("times")?);
            share = share.max(large_ms * VERTICES / large / FRAME);
        }
    }
    goals.push(Goal {
        what: format!("a step of sculpting on 10⁶ faces, {with}"),
        against: "the same on 10⁴, for each vertex".into(),
        wanted: Wanted::AtMost(1.5),
        unit: "×",
        measured: Ok(times),
    });
    goals.push(Goal {
        what: format!("a step that moves 2,000 vertices, {with}"),
        against: "a frame of 60 Hz".into(),
        wanted: Wanted::AtMost((1.0 / parts * 100.0).round() / 100.0),
        unit: " frames",
        measured: Ok(share),
    });
    Ok(())
}
