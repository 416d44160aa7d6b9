//! The worker's engine as wasm in node against the same natively on one thread: `crate/worker/tests/speed.rs`.

use super::Piece;
use super::goal::{Goal, Wanted, short};
use super::series::Runs;
use crate::page;
use crate::shell::{artifacts, cargo, command, root, run_and_read, target};
use crate::tools;
use anyhow::{Context, Result};
use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;

/// Rounds of both in turn; each takes the quickest of several pictures.
const ROUNDS: usize = 5;

/// Measures all scenes.
pub fn measure() -> Result<Piece> {
    tools::wasm_target()?;
    let runner = tools::wasm_test_runner()?;
    let native = built(&["--profile", "release"])?;
    let mut wasm = built(&["--profile", "worker", "--target", tools::WASM])?;
    // As the page's worker is.
    if let Some(wasm_opt) = tools::wasm_opt() {
        let folder = target().join("bench");
        std::fs::create_dir_all(&folder)?;
        let quicker = folder.join("speed.wasm");
        page::optimise(&wasm_opt, page::LEVEL, &wasm, &quicker)?;
        wasm = quicker;
    }
    let mut scenes: Vec<(String, [Runs; 2])> = Vec::new();
    for _ in 0..ROUNDS {
        for (which, figures) in [
            figures(&mut command(&native, &[]))?,
            figures(&mut tools::in_node(&runner, &wasm))?,
        ]
        .into_iter()
        .enumerate()
        {
            for (scene, seconds) in figures {
                let at = scenes.iter().position(|(name, _)| *name == scene);
                let at = at.unwrap_or_else(|| {
                    scenes.push((scene, Default::default()));
                    scenes.len() - 1
                });
                scenes[at].1[which].add(seconds);
            }
        }
    }
    let mut page = String::from(
        "The worker's engine, tile by tile as the page asks for them, one ray a pixel: natively on one \
         thread, and as wasm with simd128, made quicker by wasm-opt as the page's is, in node (`crate/worker/tests/speed.rs`); seconds, the quickest of \
         all runs.\n\n| scene | native | wasm | wasm ÷ native |\n|---|--:|--:|--:|\n",
    );
    let mut ratios = Vec::new();
    for (scene, [native, wasm]) in &scenes {
        let ratio = wasm.best() / native.best();
        ratios.push(ratio);
        writeln!(
            page,
            "| {scene} | {} | {} | {} |",
            native.text(),
            wasm.text(),
            short(ratio)
        )?;
    }
    page.push('\n');
    let worst = ratios.iter().copied().reduce(f64::max);
    let goal = Goal {
        what: "wasm ÷ native, the largest of the ratios".into(),
        against: "one worker, one thread".into(),
        wanted: Wanted::AtMost(1.7),
        unit: "×",
        measured: Ok(worst.context("the measurement gave no figures")?),
    };
    Ok((vec![goal], page))
}

/// Compiles the measurement.
fn built(arguments: &[&str]) -> Result<PathBuf> {
    let fixed = [
        "test",
        "--no-run",
        "--package",
        "worker",
        "--test",
        "speed",
        "--message-format",
        "json-render-diagnostics",
    ];
    artifacts(&mut cargo(&[&fixed, arguments].concat()))?
        .iter()
        .rfind(|made| made["target"]["name"] == "speed")
        .and_then(|made| Some(PathBuf::from(made["executable"].as_str()?)))
        .context("cargo made no measurement")
}

/// Runs the measurement and gives seconds by scene.
fn figures(command: &mut Command) -> Result<Vec<(String, f64)>> {
    let package = root().join("crate/worker");
    let output = run_and_read(
        command
            .args(["--include-ignored", "--nocapture"])
            .current_dir(package),
    )?;
    Ok(output.lines().filter_map(figure).collect())
}

/// A line `speed SCENE SECONDS`.
fn figure(line: &str) -> Option<(String, f64)> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words[..] {
        ["speed", scene, seconds] => Some((scene.to_owned(), seconds.parse().ok()?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn figures_are_told_from_other_lines() {
        assert_eq!(
            super::figure("    speed tee 0.25"),
            Some((String::from("tee"), 0.25))
        );
        assert_eq!(super::figure("test speed ... ok"), None);
    }
}
