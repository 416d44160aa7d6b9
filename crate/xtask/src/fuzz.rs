//! `cargo xtask fuzz`: random tests with other inputs than `cargo xtask test` runs them with.

use crate::shell::{cargo, command, read, root, run};
use anyhow::{Context, Result};
use std::fs;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Times as many inputs as the tests have, in each round.
const TIMES: &str = "10";

/// Runs the random tests with fresh seeds, the fuzzer of the language, and each target of cargo-fuzz, each for so many minutes.
pub fn fuzz(minutes: u64) -> Result<()> {
    let time = Duration::from_secs(60 * minutes);
    tests(time)?;
    let seconds = time.as_secs().to_string();
    let seed = fresh().to_string();
    run(&mut cargo(&[
        "run",
        "--profile",
        "fuzz",
        "--package",
        "fuzzer",
        "--",
        &seconds,
        &seed,
    ]))?;
    guided(&seconds)
}

/// A seed of this moment.
fn fresh() -> u64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    now.map_or(1, |since| since.as_secs() ^ u64::from(since.subsec_nanos()))
}

/// Tests of properties on random inputs, in rounds, each with another seed.
fn tests(time: Duration) -> Result<()> {
    let mut arguments = vec![String::from("test"), String::from("--tests")];
    for package in fs::read_dir(root().join("crate"))? {
        let folder = package?.path();
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        if manifest.contains("\ntrials.workspace = true") {
            let name = folder.file_name().unwrap_or_default();
            arguments.push(String::from("--package"));
            arguments.push(name.to_string_lossy().into_owned());
        }
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let begun = Instant::now();
    loop {
        let seed = fresh();
        println!("\nRandom tests with SINEW_SEED={seed} SINEW_TRIALS={TIMES}");
        run(cargo(&arguments)
            .env("SINEW_SEED", seed.to_string())
            .env("SINEW_TRIALS", TIMES))
        .with_context(|| format!("a random test failed with SINEW_SEED={seed}"))?;
        if begun.elapsed() >= time {
            return Ok(());
        }
    }
}

/// The targets of cargo-fuzz, which watches what the code does, and needs a nightly compiler.
fn guided(seconds: &str) -> Result<()> {
    if read(&mut cargo(&["fuzz", "--version"])).is_none() {
        run(&mut cargo(&["install", "cargo-fuzz"]))
            .context("cargo-fuzz is missing. Install it: cargo install cargo-fuzz")?;
    }
    let nightly = ["toolchain", "install", "nightly", "--profile", "minimal"];
    run(&mut command("rustup", &nightly)).context("cargo-fuzz needs a nightly compiler")?;
    for target in fs::read_dir(root().join("fuzz/fuzz_targets"))? {
        let path = target?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let most = format!("-max_total_time={seconds}");
        // The cargo that runs this program is not rustup's, and would not know of the other compiler.
        let fuzz = ["run", "nightly", "cargo", "fuzz", "run", &name, "--", &most];
        run(&mut command("rustup", &fuzz))
            .with_context(|| format!("the target {name} found something"))?;
    }
    Ok(())
}
