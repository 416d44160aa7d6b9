//! Pictures against a certified reference: what `crate/tracer/examples/certify.rs` prints.

use super::Piece;
use crate::shell::{cargo, root, run_and_read};
use anyhow::{Result, bail};

/// Runs it. It writes its own tables.
pub fn measure() -> Result<Piece> {
    let example = "crate/tracer/examples/certify.rs";
    if !root().join(example).is_file() {
        bail!("there is no {example}");
    }
    let options = [
        "run",
        "--release",
        "--package",
        "tracer",
        "--example",
        "certify",
    ];
    let output = run_and_read(&mut cargo(&options))?;
    let page = format!(
        "`cargo {}`:\n\n{}\n\n",
        options.join(" "),
        output.trim_end()
    );
    Ok((Vec::new(), page))
}
