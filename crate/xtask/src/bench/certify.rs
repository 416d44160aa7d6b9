//! Pictures against a certified reference: what `crate/tracer/examples/certify.rs` prints.

use super::Piece;
use crate::shell::{cargo, root, run_and_read};
use anyhow::{Result, bail};

/// How many rays are held against the reference.
const RAYS: &str = "1000000";

/// Runs it. It writes its own tables.
pub fn measure() -> Result<Piece> {
    let example = "crate/tracer/examples/certify.rs";
    if !root().join(example).is_file() {
        bail!("there is no {example}");
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.to_string();
    let options = [
        "run",
        "--release",
        "--package",
        "tracer",
        "--example",
        "certify",
        "--",
        RAYS,
        &threads,
    ];
    let output = run_and_read(&mut cargo(&options))?;
    let page = format!(
        "`cargo {}`:\n\n{}\n\n",
        options[..options.len() - 1].join(" "),
        output.trim_end()
    );
    Ok((Vec::new(), page))
}
