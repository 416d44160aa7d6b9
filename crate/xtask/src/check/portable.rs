//! The build for any processor of this kind, with other instructions than the tests on this machine: the program that
//! the page is compared with, and the test that traces parts of all pictures. One build, as they share nearly everything.

use crate::shell::{PORTABLE, artifacts, cargo, executable};
use anyhow::Result;
use std::path::PathBuf;

/// The test of `worker` whose pictures are compared between builds.
pub const SAME: &str = "same";

/// Result of the build.
pub struct Portable {
    /// The program `sinew`.
    pub program: PathBuf,
    /// The test `crate/worker/tests/it/same.rs`.
    pub same: PathBuf,
}

/// Builds both.
pub fn build() -> Result<Portable> {
    let mut cargo = cargo(&[
        "build",
        "--package",
        "cli",
        "--package",
        "worker",
        "--bin",
        "sinew",
        "--test",
        SAME,
        "--message-format",
        "json-render-diagnostics",
    ]);
    // Elsewhere nothing is asked for that not all processors can do.
    if cfg!(target_arch = "x86_64") {
        cargo.envs(PORTABLE.settings());
    }
    let made = artifacts(&mut cargo)?;
    Ok(Portable {
        program: executable(&made, "sinew")?,
        same: executable(&made, SAME)?,
    })
}
