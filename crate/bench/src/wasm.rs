//! The worker's engine as wasm in node against the same natively on one thread:
//! `crate/worker/tests/it/speed.rs`.

use crate::report::{Report, Short};
use crate::series::Runs;
use anyhow::{Context, Result};
use std::path::PathBuf;
use xtask::shell::{artifacts, cargo, command, executable, root, run_and_read, words};
use xtask::{page, tools};

/// Rounds of both in turn; each takes the quickest of several pictures.
const ROUNDS: usize = 5;

/// Measures all scenes.
pub fn measure() -> Result<Report> {
    tools::target(tools::WASI)?;
    let native = build("--profile release")?;
    let slow = build(&format!("--profile worker --target {}", tools::WASI))?;
    // Optimised like the worker of the page.
    let wasm = slow.with_file_name("speed.wasm");
    page::optimise(
        &tools::wasm_opt().context("wasm-opt is missing")?,
        &slow,
        &wasm,
    )?;
    let mut scenes: Vec<(String, [Runs; 2])> = Vec::new();
    for _ in 0..ROUNDS {
        let programs = [command(&native, &[]), tools::in_node(&wasm)];
        for (which, mut program) in programs.into_iter().enumerate() {
            program.args(words("--exact speed::speed --include-ignored --nocapture"));
            let output = run_and_read(program.current_dir(root().join("crate/worker")))?;
            // They come in the same order each time.
            for (i, (scene, seconds)) in output.lines().filter_map(figure).enumerate() {
                if i == scenes.len() {
                    scenes.push((scene, Default::default()));
                }
                scenes[i].1[which].add(seconds);
            }
        }
    }
    let mut report = Report::default();
    let mut worst = 0.0f64;
    for (scene, [native, wasm]) in &scenes {
        let ratio = wasm.over(native);
        worst = worst.max(ratio.0);
        report.row("scenes", format!("{scene} | {native} | {wasm} | {ratio}"));
    }
    let goal = "wasm ÷ native, the largest of the ratios | one worker, one thread | ≤ 1.7×";
    report.goal(goal, Ok(Short(worst)))?;
    Ok(report)
}

/// Compiles the measurement.
fn build(options: &str) -> Result<PathBuf> {
    let line = format!(
        "test --no-run --package worker --test it --message-format json-render-diagnostics \
         {options}"
    );
    executable(&artifacts(&mut cargo(&words(&line)))?, "it")
}

/// A line `speed SCENE SECONDS`.
fn figure(line: &str) -> Option<(String, f64)> {
    match words(line)[..] {
        ["speed", scene, seconds] => Some((scene.to_owned(), seconds.parse().ok()?)),
        _ => None,
    }
}
