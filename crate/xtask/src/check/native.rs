//! The tests of all crates, on this machine.

use super::passed;
use crate::shell::{cargo, run_and_read};
use anyhow::{Result, bail};

/// Runs this part.
pub fn check() -> Result<String> {
    let output = run_and_read(&mut cargo(&["test", "--workspace"]))?;
    match passed(&output) {
        0 => bail!("no test was run"),
        count => Ok(format!("{count} tests passed")),
    }
}
