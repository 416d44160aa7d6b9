//! All tests: `cargo xtask test`.

mod e2e;
mod lint;
mod native;
mod wasm;

use anyhow::{Result, bail};
use clap::ValueEnum;
use std::time::Instant;

/// A part of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// Formatting and lints.
    Lint,
    /// Tests on this machine.
    Native,
    /// The mathematics' tests as wasm, in node.
    Wasm,
    /// The page in a real browser.
    E2e,
}

/// Runs one part, or all. A part that fails does not keep the others from being run.
pub fn test(part: Option<Part>) -> Result<()> {
    let parts = part.map_or_else(|| Part::value_variants().to_vec(), |part| vec![part]);
    let begun = Instant::now();
    let mut summary = String::new();
    let mut failed = Vec::new();
    for part in parts {
        println!("\n== {} ==", name(part));
        let begun = Instant::now();
        let result = match part {
            Part::Lint => lint::check(),
            Part::Native => native::check(),
            Part::Wasm => wasm::check(),
            Part::E2e => e2e::check(),
        };
        let said = result.unwrap_or_else(|error| {
            failed.push(name(part));
            format!("FAILED: {error:#}")
        });
        let seconds = begun.elapsed().as_secs();
        summary += &format!("\n  {}: {said} ({seconds} s)", name(part));
    }
    println!("\nTested in {} s:{summary}", begun.elapsed().as_secs());
    if !failed.is_empty() {
        bail!("{} failed", failed.join(", "));
    }
    Ok(())
}

fn name(part: Part) -> String {
    part.to_possible_value()
        .map_or_else(String::new, |value| value.get_name().to_owned())
}

/// How many tests a run of libtest or wasm-bindgen-test says have passed.
fn passed(output: &str) -> usize {
    output
        .lines()
        .filter_map(|line| line.trim().strip_prefix("test result: ok. "))
        .filter_map(|line| line.split(' ').next()?.parse::<usize>().ok())
        .sum()
}

#[cfg(test)]
mod tests {
    #[test]
    fn passed_tests_are_counted() {
        let output = "test a ... ok\ntest result: ok. 3 passed; 0 failed\n\ntest result: ok. 20 passed; 0 failed";
        assert_eq!(super::passed(output), 23);
        assert_eq!(super::passed("no tests to run!"), 0);
    }
}
