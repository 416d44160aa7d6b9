//! The tests of the mathematics as wasm, in node, and its pictures against those of this machine.

use super::passed;
use crate::shell::{self, cargo, find, run_and_read};
use crate::tools;
use anyhow::{Result, bail};

/// The crates whose results must be the same in the page as on this machine.
const CRATES: [&str; 5] = ["field", "rats", "texture", "tracer", "worker"];

/// Runs this part.
pub fn check() -> Result<String> {
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    tools::wasm_target()?;
    let runner = tools::wasm_test_runner()?;
    let mut said = Vec::new();
    let mut pictures = Vec::new();
    for package in CRATES {
        let options = ["test", "--package", package, "--target", tools::WASM];
        let output = run_and_read(
            cargo(&options)
                .args(["--lib", "--tests", "--", "--nocapture"])
                .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", &runner),
        )?;
        pictures.extend(output.lines().filter_map(picture).map(str::to_owned));
        // A test without the attribute of wasm-bindgen-test is silently left out.
        match passed(&output) {
            0 => bail!("no test of {package} was run as wasm"),
            count => said.push(format!("{package} {count}")),
        }
    }
    let same = ["test", "--package", "worker", "--test", "same"];
    let output = run_and_read(cargo(&same).args(["--", "--nocapture"]))?;
    let count = compare(&pictures, output.lines().filter_map(picture))?;
    let mut machines = String::from("those of this machine");
    // `.cargo/config.toml` asks for all that this processor can do.
    if cfg!(target_arch = "x86_64") {
        let mut test = cargo(&same);
        let output = run_and_read(
            test.args(["--", "--nocapture"])
                .envs(shell::PORTABLE.settings()),
        )?;
        compare(&pictures, output.lines().filter_map(picture))?;
        machines += " and of any x86-64";
    }
    Ok(format!(
        "tests passed: {}; {count} pictures and scenes equal to {machines}",
        said.join(", ")
    ))
}

/// A line `picture …` of `crate/worker/tests/same.rs`. What is run in node is written with spaces before it.
fn picture(line: &str) -> Option<&str> {
    let line = line.trim();
    line.starts_with("picture ").then_some(line)
}

/// Compares what is told of pictures as wasm with what is told of them natively, and gives how many
/// there are.
fn compare<'a>(wasm: &[String], native: impl Iterator<Item = &'a str>) -> Result<usize> {
    let native: Vec<&str> = native.collect();
    if let Some((wasm, native)) = wasm.iter().zip(&native).find(|(a, b)| a != b) {
        bail!("pictures differ:\n  as wasm  {wasm}\n  natively {native}");
    }
    if wasm.is_empty() || wasm.len() != native.len() {
        let (as_wasm, natively) = (wasm.len(), native.len());
        bail!("{as_wasm} pictures were told of as wasm, {natively} natively");
    }
    Ok(native.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_that_differ_or_are_missing_are_found() {
        let wasm = ["picture a Full 1", "picture b Full 2"].map(str::to_owned);
        let count = |native: &str| compare(&wasm, native.lines().filter_map(picture)).ok();
        let same = "running 1 test\n picture a Full 1\n    picture b Full 2\n";
        assert_eq!(count(same), Some(2));
        assert_eq!(count(&same.replace("Full 2", "Full 3")), None);
        assert_eq!(count("picture a Full 1"), None);
        assert!(compare(&[], [].into_iter()).is_err());
    }
}
