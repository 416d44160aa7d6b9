//! Quick tests after an edit: those that are likely to find a mistake.

use super::Chosen;
use super::files::Watch;
use super::lint::{clippy, format};
use super::programs;
use crate::packages::PICTURES;
use anyhow::{Result, bail};

/// Runs this part, with `times` as many random inputs as the tests name.
pub fn check(watch: &mut Watch, chosen: &Chosen, times: &str) -> Result<String> {
    let mut packages = chosen.packages();
    format()?;
    watch.step("clippy", || clippy(&packages))?;
    // The pins of pictures.
    let changed = chosen.test.is_none() && PICTURES.iter().any(|package| chosen.has(package));
    if changed && !chosen.has("worker") {
        packages.extend(["--package", "worker"]);
    }
    packages.push("--tests");
    let programs = watch.step("build", || programs::compile(&packages, None))?;
    let count = watch.run(programs::files(&programs, chosen.test.as_deref(), times)?)?;
    if count.passed == 0 {
        bail!("no test was run");
    }
    Ok(format!("{} tests passed", count.passed))
}
