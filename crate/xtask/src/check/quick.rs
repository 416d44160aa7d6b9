//! After an edit: what is likely to tell that it was wrong, soon.

use super::lint::{clippy, format};
use super::{Chosen, Watch, passed};
use crate::packages::PICTURES;
use crate::shell::{cargo, run_and_read};
use anyhow::{Result, bail};

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    // Tests of a name are looked for in the packages that are quickly built.
    let everywhere = chosen.test().is_some();
    let packages = if everywhere {
        Vec::new()
    } else {
        chosen.packages()
    };
    format()?;
    watch.step("clippy", || clippy(&packages))?;
    let mut output = watch.step("test", || {
        let filter = chosen.test().map(|name| ["--", name]);
        let mut test = cargo(&["test", "--tests"]);
        run_and_read(test.args(&packages).args(filter.into_iter().flatten()))
    })?;
    let changed = PICTURES.iter().any(|package| chosen.has(package));
    if changed && !everywhere && !chosen.has("worker") {
        output += &watch.step("pins", || {
            run_and_read(&mut cargo(&[
                "test",
                "--package",
                "worker",
                "--test",
                "pins",
            ]))
        })?;
    }
    match passed(&output) {
        0 => bail!("no test was run"),
        count => Ok(format!("{count} tests passed")),
    }
}
