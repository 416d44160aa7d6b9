//! Formatting and lints, for this machine and for wasm.

use crate::shell::{cargo, run};
use crate::tools;
use anyhow::{Context, Result};

/// Runs this part.
pub fn check() -> Result<String> {
    run(&mut cargo(&["fmt", "--all", "--check"]))
        .context("The code is not formatted. Run: cargo fmt --all")?;
    let deny = ["--", "-D", "warnings"];
    run(cargo(&["clippy", "--workspace", "--all-targets"]).args(deny))?;
    tools::wasm_target()?;
    for (package, features) in [("studio", ""), ("worker", "entry")] {
        let options = [
            "--package",
            package,
            "--features",
            features,
            "--target",
            tools::WASM,
        ];
        run(cargo(&["clippy"]).args(options).args(deny))?;
    }
    Ok(String::from("clean"))
}
