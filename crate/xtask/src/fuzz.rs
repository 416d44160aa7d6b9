//! `cargo xtask fuzz`: random tests with other inputs than `cargo xtask test` runs them with.

use crate::shell::{cargo, command, files, read, root, run, words};
use anyhow::{Context, Result};
use std::fs;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Number of inputs in each round relative to that of the tests.
const TIMES: &str = "10";

/// Runs the random tests with fresh seeds, the fuzzer of the language, and each target of
/// cargo-fuzz, each for `minutes`.
pub fn fuzz(minutes: u64) -> Result<()> {
    let seconds = 60 * minutes;
    tests(Duration::from_secs(seconds))?;
    let line = format!(
        "run --profile fuzz --package fuzzer -- {seconds} {}",
        fresh()
    );
    run(&mut cargo(&words(&line)))?;
    run_targets(seconds)
}

/// Returns a seed made of the time.
fn fresh() -> u64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    now.map_or(1, |since| since.as_secs() ^ u64::from(since.subsec_nanos()))
}

/// Tests properties on random inputs, in rounds, each with another seed.
fn tests(time: Duration) -> Result<()> {
    let mut line = String::from("test --tests");
    for package in fs::read_dir(root().join("crate"))? {
        let package = package?;
        let manifest = fs::read_to_string(package.path().join("Cargo.toml")).unwrap_or_default();
        if manifest.contains("\ntrials.workspace = true") {
            line += &format!(" --package {}", package.file_name().to_string_lossy());
        }
    }
    let begun = Instant::now();
    loop {
        let seed = fresh().to_string();
        println!("\nRandom tests with SINEW_SEED={seed} SINEW_TRIALS={TIMES}");
        run(cargo(&words(&line))
            .env("SINEW_SEED", &seed)
            .env("SINEW_TRIALS", TIMES))
        .with_context(|| format!("a random test failed with SINEW_SEED={seed}"))?;
        if begun.elapsed() >= time {
            return Ok(());
        }
    }
}

/// Runs the targets of cargo-fuzz, each for `seconds`. It watches which code the inputs reach, and
/// needs a nightly compiler.
pub fn run_targets(seconds: u64) -> Result<()> {
    if read(&mut cargo(&["fuzz", "--version"])).is_none() {
        run(&mut cargo(&["install", "cargo-fuzz"]))
            .context("cargo-fuzz is missing. Install it: cargo install cargo-fuzz")?;
    }
    let nightly = words("toolchain install nightly --profile minimal");
    run(&mut command("rustup", &nightly)).context("cargo-fuzz needs a nightly compiler")?;
    for target in files(&root().join("fuzz/fuzz_targets"), "rs")? {
        let name = target.file_stem().unwrap_or_default().to_string_lossy();
        // The cargo that runs this program is not rustup's, and would not know of the other
        // compiler.
        let line = format!("run nightly cargo fuzz run {name} -- -max_total_time={seconds}");
        run(&mut command("rustup", &words(&line)))
            .with_context(|| format!("the target {name} found something"))?;
    }
    Ok(())
}
