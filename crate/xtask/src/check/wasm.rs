//! The tests of the mathematics as wasm, in node.

use super::passed;
use crate::shell::{cargo, find, run_and_read};
use crate::tools;
use anyhow::{Result, bail};

/// The crates whose results must be the same in the page as on this machine.
const CRATES: [&str; 4] = ["field", "rats", "tracer", "worker"];

/// Runs this part.
pub fn check() -> Result<String> {
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    tools::wasm_target()?;
    let runner = tools::wasm_test_runner()?;
    let mut said = Vec::new();
    for package in CRATES {
        let output = run_and_read(
            cargo(&[
                "test",
                "--package",
                package,
                "--target",
                tools::WASM,
                "--lib",
                "--tests",
            ])
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", &runner),
        )?;
        // A test without the attribute of wasm-bindgen-test is silently left out.
        match passed(&output) {
            0 => bail!("no test of {package} was run as wasm"),
            count => said.push(format!("{package} {count}")),
        }
    }
    Ok(format!("tests passed: {}", said.join(", ")))
}
