//! The tests of all crates, on this machine.

use super::Chosen;
use super::files::{File, Watch};
use super::programs;
use crate::shell::cargo;
use anyhow::{Result, bail};

/// Runs this part, with `times` as many random inputs as the tests name.
pub fn check(watch: &mut Watch, chosen: &Chosen, times: &str) -> Result<String> {
    let packages = chosen.packages();
    // Examples are for `clippy` to check; they are not run.
    let programs = watch.step("build", || {
        programs::compile(&[&packages, &["--tests"][..]].concat())
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
