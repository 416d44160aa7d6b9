//! Programs that measure themselves: examples of our packages, natively and as wasm.

use crate::report::Short;
use anyhow::{Context, Result};
use serde_json::Value;
use xtask::shell::{cargo, run, run_and_read, target, words};
use xtask::tools;

/// Runs an example, whose package may be followed by options of cargo, and returns what it writes.
pub fn example(package: &str, name: &str, arguments: &[&str]) -> Result<String> {
    let line = format!("run --release --quiet --package {package} --example {name} --");
    run_and_read(cargo(&words(&line)).args(arguments))
}

/// Runs an example as wasm in node, and returns what it writes.
pub fn example_as_wasm(package: &str, name: &str, arguments: &[&str]) -> Result<String> {
    let kind = tools::WASI;
    tools::target(kind)?;
    let line =
        format!("build --release --quiet --package {package} --example {name} --target {kind}");
    run(&mut cargo(&words(&line)))?;
    let wasm = target().join(format!("{kind}/release/examples/{name}.wasm"));
    run_and_read(tools::in_node(&wasm).args(arguments))
}

/// Figures that a program writes, by name.
pub struct Figures(pub Value);

impl Figures {
    /// Reads it.
    pub fn new(line: &str) -> Result<Self> {
        Ok(Self(serde_json::from_str(line.trim())?))
    }

    /// A number.
    pub fn number(&self, name: &str) -> Result<f64> {
        let number = self.0[name].as_f64();
        number.with_context(|| format!("no {name} in {}", self.0))
    }

    /// A number that is shown.
    pub fn short(&self, name: &str) -> Result<Short> {
        self.number(name).map(Short)
    }

    /// A text; an empty one if there is none.
    pub fn text(&self, name: &str) -> &str {
        self.0[name].as_str().unwrap_or_default()
    }
}
