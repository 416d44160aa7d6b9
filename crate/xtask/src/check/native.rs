//! The tests of all crates, on this machine.

use super::Chosen;
use super::files::{File, Watch};
use super::programs;
use crate::shell::cargo;
use anyhow::{Result, bail};

/// The crates of this program. They are compiled apart from the others, as this program was: together
/// features of others would reach what they depend on, and have it compiled anew.
const OURS: [&str; 2] = ["xtask", "bench"];

/// Runs this part, with `times` as many random inputs as the tests name.
pub fn check(watch: &mut Watch, chosen: &Chosen, times: &str) -> Result<String> {
    let mut packages = chosen.packages();
    let mut selections = Vec::new();
    if packages == ["--workspace"] {
        packages.extend(OURS.iter().flat_map(|package| ["--exclude", package]));
        selections.extend(OURS.map(|package| vec!["--package", package]));
    }
    selections.insert(0, packages.clone());
    let programs = watch.step("build", || {
        let mut programs = Vec::new();
        for mut selection in selections {
            // Examples are for `clippy` to check; they are not run.
            selection.push("--tests");
            programs.extend(programs::compile(&selection)?);
        }
        Ok(programs)
    })?;
    let mut files = Vec::new();
    if chosen.test.is_none() {
        let mut command = cargo(&["test", "--doc"]);
        command.args(&packages);
        let name = String::from("examples of documentation");
        files.push(File { name, command });
    }
    files.extend(programs::files(&programs, chosen.test.as_deref(), times)?);
    let count = watch.run(files)?;
    if count.passed == 0 {
        bail!("no test was run");
    }
    Ok(format!("{} tests passed", count.passed))
}
