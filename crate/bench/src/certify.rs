//! Pictures against a certified reference: what `crate/tracer/examples/certify.rs` prints.

use crate::report::Report;
use anyhow::Result;
use xtask::shell::{Build, cargo, run_and_read, words};

/// The number of rays that are held to the reference.
const RAYS: &str = "1000000";

/// Runs it. It writes its own tables.
pub fn measure() -> Result<Report> {
    let (command, output) = certify(RAYS, None)?;
    let mut report = Report::default();
    report.set("command", command);
    report.set("tables", output);
    Ok(report)
}

/// Runs the certifier, perhaps built in another way, on a number of rays; returns its command and
/// its output.
pub fn certify(rays: &str, build: Option<Build>) -> Result<(String, String)> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let line = format!("run --release --package tracer --example certify -- {rays}");
    let mut command = cargo(&words(&line));
    command.arg(threads.to_string());
    command.envs(build.into_iter().flat_map(Build::settings));
    Ok((format!("cargo {line}"), run_and_read(&mut command)?))
}
