//! Pictures against a certified reference: what `crate/tracer/examples/certify.rs` prints.

use super::Piece;
use crate::shell::{Build, cargo, root, run_and_read};
use anyhow::{Result, bail};

/// How many rays are held against the reference.
const RAYS: &str = "1000000";

/// Runs it. It writes its own tables.
pub fn measure() -> Result<Piece> {
    let (command, output) = certify(RAYS, None)?;
    Ok((
        Vec::new(),
        format!("`{command}`:\n\n{}\n\n", output.trim_end()),
    ))
}

/// Runs the certifier, perhaps built in another way, on a number of rays; returns its output and its command.
pub fn certify(rays: &str, build: Option<Build>) -> Result<(String, String)> {
    let example = "crate/tracer/examples/certify.rs";
    if !root().join(example).is_file() {
        bail!("there is no {example}");
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let options = [
        "run",
        "--release",
        "--package",
        "tracer",
        "--example",
        "certify",
        "--",
        rays,
    ];
    let mut command = cargo(&options);
    command.arg(threads.to_string());
    command.envs(build.into_iter().flat_map(Build::settings));
    let output = run_and_read(&mut command)?;
    Ok((format!("cargo {}", options.join(" ")), output))
}
