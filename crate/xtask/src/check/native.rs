//! The tests of all crates, on this machine.

use super::Chosen;
use super::files::{File, Watch};
use super::programs;
use crate::shell::{PORTABLE, cargo, executable};
use crate::tools;
use anyhow::{Result, bail};
use std::path::PathBuf;

/// The crates of this program. They are compiled apart from the others, as this program was:
/// otherwise features of the others would reach their dependencies, which would be compiled anew.
const OURS: [&str; 2] = ["xtask", "bench"];

/// Options that choose the tests of all other crates. Examples are not run; `clippy` checks them.
const OTHERS: [&str; 6] = [
    "--workspace",
    "--exclude",
    OURS[0],
    "--exclude",
    OURS[1],
    "--tests",
];

/// Tests that a build for any processor of this one's kind passes, too: some scenes come out the
/// same to the bit.
const PORTABLE_TESTS: [&str; 2] = ["bits::", "pictures_are_as_pinned_4"];

/// Returns the program `sinew` that the tests of the crates use.
pub fn program() -> Result<PathBuf> {
    let mut artifacts = programs::build(&OTHERS, None)?;
    // Tests of its own are a program of this name, too.
    artifacts.retain(|artifact| artifact["profile"]["test"] == false);
    executable(&artifacts, "sinew")
}

/// Runs this part, with `times` as many random inputs as the tests name.
pub fn check(watch: &mut Watch, chosen: &Chosen, times: &str) -> Result<String> {
    let mut selections = vec![chosen.packages()];
    if selections[0] == ["--workspace"] {
        selections[0] = OTHERS.to_vec();
        selections.extend(OURS.map(|package| vec!["--package", package, "--tests"]));
    } else {
        selections[0].push("--tests");
    }
    let programs = watch.step("build", || {
        let compiled = selections
            .iter()
            .map(|selection| programs::compile(selection, None));
        Ok(compiled
            .collect::<Result<Vec<_>>>()?
            .into_iter()
            .flatten()
            .collect::<Vec<_>>())
    })?;
    let mut files = Vec::new();
    if chosen.test.is_none() {
        let mut command = cargo(&["test", "--doc"]);
        command.args(selections[0].iter().filter(|option| **option != "--tests"));
        let name = String::from("examples of documentation");
        files.push(File { name, command });
    }
    files.extend(programs::files(&programs, chosen.test.as_deref(), times)?);
    if chosen.is_all() && cfg!(target_arch = "x86_64") {
        let options = ["--package", "worker", "--test", "it"];
        let portable = watch.step("portable build", || {
            programs::compile(&options, Some(PORTABLE))
        })?;
        for test in PORTABLE_TESTS {
            for mut file in programs::files(&portable, Some(test), times)? {
                file.name.insert_str(0, "portable ");
                files.push(file);
            }
        }
    }
    if tools::graphics_driver()? {
        // Where there is a driver, tests that find none fail instead of being skipped.
        for file in &mut files {
            file.command.env("CI", "1");
        }
    }
    let count = watch.run(files)?;
    if count.passed == 0 {
        bail!("no test was run");
    }
    Ok(format!("{} tests passed", count.passed))
}
