//! Formatting and lints, for this machine and for wasm.

use super::Chosen;
use super::files::Watch;
use crate::packages::MODULES;
use crate::shell::{cargo, run};
use crate::tools;
use anyhow::{Context, Result};

const DENY: [&str; 3] = ["--", "-D", "warnings"];

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    format()?;
    watch.step("native", || clippy(&chosen.packages()))?;
    tools::target(tools::WASM)?;
    watch.step("wasm", || {
        MODULES
            .iter()
            .filter(|module| chosen.has(module.package))
            .try_for_each(|module| {
                let options = ["--package", module.package, "--features", module.features];
                // Tests of these packages are for this machine only.
                lint(&[&options[..], &["--target", tools::WASM]].concat())
            })
    })?;
    Ok(String::from("clean"))
}

/// Checks the format of all code.
pub fn format() -> Result<()> {
    run(&mut cargo(&["fmt", "--all", "--check"]))
        .context("The code is not formatted. Run: cargo fmt --all")
}

/// Lints packages with their tests.
pub fn clippy(packages: &[&str]) -> Result<()> {
    lint(&[&["--all-targets"], packages].concat())
}

fn lint(options: &[&str]) -> Result<()> {
    run(cargo(&["clippy"]).args(options).args(DENY))
}
