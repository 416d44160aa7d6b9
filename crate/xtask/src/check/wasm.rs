//! Tests as wasm that compare results with stored ones to the bit, and the pins of pictures. Where
//! these and the same tests on this machine pass, both have computed the same.

use super::Chosen;
use super::files::Watch;
use super::programs;
use crate::packages::TESTED_AS_WASM;
use crate::tools;
use anyhow::{Result, bail};

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    tools::target(tools::WASI)?;
    tools::node()?;
    let mut options = vec!["--target", tools::WASI, "--test", "it"];
    let packages: Vec<&str> = TESTED_AS_WASM
        .into_iter()
        .filter(|package| chosen.has(package))
        .collect();
    if packages.is_empty() {
        bail!("the tests of {chosen:?} do not run as wasm");
    }
    options.extend(packages.iter().flat_map(|package| ["--package", package]));
    let programs = watch.step("build", || programs::compile(&options, None))?;
    if programs.len() < packages.len() {
        bail!(
            "{} of {} test programs were compiled",
            programs.len(),
            packages.len()
        );
    }
    let files = programs::files(&programs, chosen.test.as_deref(), super::BASIC)?;
    let has_tests = packages
        .iter()
        .all(|package| files.iter().any(|file| file.name.starts_with(package)));
    if chosen.test.is_none() && !has_tests {
        bail!("one of {packages:?} has no test as wasm");
    }
    let count = watch.run(files)?;
    Ok(format!("{} tests passed", count.passed))
}
