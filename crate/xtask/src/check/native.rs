//! The tests of all crates, on this machine.

use super::{Chosen, Watch, passed};
use crate::shell::{cargo, run, run_and_read};
use anyhow::{Result, bail};

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    let packages = chosen.packages();
    let mut test = vec!["test"];
    test.extend(&packages);
    watch.step("build", || run(cargo(&test).arg("--no-run")))?;
    let output = watch.step("run", || {
        let filter = chosen.test().map(|name| ["--", name]);
        run_and_read(cargo(&test).args(filter.into_iter().flatten()))
    })?;
    match passed(&output) {
        0 => bail!("no test was run"),
        count => Ok(format!("{count} tests passed")),
    }
}
