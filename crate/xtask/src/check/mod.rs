//! Tests of everything: `cargo xtask test`.

mod chosen;
mod e2e;
mod english;
mod files;
mod lint;
mod native;
mod programs;
mod quick;
mod wasm;

use crate::shell::{in_lane, tell};
use anyhow::{Result, bail};
use chosen::Chosen;
use clap::ValueEnum;
use files::Watch;
use std::time::Instant;

/// A part of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// After each edit: formatting, lints and tests, with a tenth of the random inputs, of the
    /// crates that have been changed since the last commit, and the pins of pictures.
    Quick,
    /// Formatting and lints.
    Lint,
    /// Tests on this machine.
    Native,
    /// Tests as wasm, which must give the same bits and pictures.
    Wasm,
    /// The page in a real browser.
    E2e,
    /// The page in Firefox.
    Firefox,
    /// Everything with ten times as many random inputs, Firefox, and a minute of each target of the
    /// fuzzer. Takes hours.
    All,
}

/// Numbers of random inputs relative to those that the tests name.
const BASIC: &str = "1";
const FEW: &str = "0.1";
const MANY: &str = "10";

/// Runs one part, or all but Firefox and the fuzzer. A part that fails does not keep the others
/// from running.
pub fn test(part: Option<Part>, filter: Option<String>) -> Result<()> {
    let begun = Instant::now();
    let done = match part {
        Some(Part::Quick) => vec![run(Part::Quick, &Chosen::of_changes(filter)?)],
        Some(Part::E2e) => vec![run(Part::E2e, &Chosen::tests(filter))],
        Some(Part::All) => {
            tell("Ten times as many random inputs, Firefox and the fuzzer: this takes hours.");
            let mut done = all(MANY);
            done.push(run(Part::Firefox, &Chosen::default()));
            done.push(attempt(Part::All, Watch::default(), |_| {
                crate::fuzz::run_targets(60)?;
                Ok(String::from("the fuzzer found nothing"))
            }));
            done
        }
        Some(part) => vec![run(part, &Chosen::new(filter))],
        None => all(BASIC),
    };
    let mut watch = Watch::default();
    let mut failed = Vec::new();
    println!("\nTested in {} s:", begun.elapsed().as_secs());
    for part in done {
        println!("  {}", part.message);
        if part.failed {
            failed.push(name(part.part));
        }
        watch.add(part.watch);
    }
    println!("Files of tests that took longest:{}", watch.slowest());
    let count = watch.count;
    println!(
        "\n{} passed, {} failed, {} skipped",
        count.passed, count.failed, count.skipped
    );
    if !failed.is_empty() {
        bail!("{} failed", failed.join(", "));
    }
    Ok(())
}

/// Runs all parts, in two lanes: one tests the code, the other builds the page. The tests of the
/// page come last, as they need the machine for themselves.
fn all(times: &'static str) -> Vec<Done> {
    let mut watch = Watch::default();
    let (mut done, page) = std::thread::scope(|scope| {
        let page = scope.spawn(|| in_lane("page", || e2e::build(&mut watch, true)));
        let code = scope.spawn(|| {
            let parts = [Part::Lint, Part::Native, Part::Wasm];
            in_lane("code", || {
                parts.map(|part| run_times(part, &Chosen::default(), times))
            })
        });
        let done = code
            .join()
            .map_or_else(|_| vec![Done::panic(Part::Native)], Vec::from);
        (done, page.join())
    });
    done.push(page.map_or_else(
        |_| Done::panic(Part::E2e),
        |page| {
            attempt(Part::E2e, watch, |watch| {
                // With the tests the program has been compiled as well.
                e2e::check(watch, &Chosen::default(), page?, native::program)
            })
        },
    ));
    done
}

/// The result of a part.
struct Done {
    part: Part,
    message: String,
    failed: bool,
    watch: Watch,
}

impl Done {
    /// Returns the result of a part whose lane panicked.
    fn panic(part: Part) -> Self {
        Self {
            part,
            message: format!("the lane of {} panicked", name(part)),
            failed: true,
            watch: Watch::default(),
        }
    }
}

fn run(part: Part, chosen: &Chosen) -> Done {
    run_times(part, chosen, BASIC)
}

/// Runs a part with `times` as many random inputs as its tests name.
fn run_times(part: Part, chosen: &Chosen, times: &str) -> Done {
    attempt(part, Watch::default(), |watch| match part {
        Part::Quick => quick::check(watch, chosen, FEW),
        Part::Lint => lint::check(watch, chosen),
        Part::Native => native::check(watch, chosen, times),
        Part::Wasm => wasm::check(watch, chosen),
        Part::E2e => {
            let page = e2e::build(watch, chosen.is_all())?;
            e2e::check(watch, chosen, page, e2e::program)
        }
        Part::Firefox => e2e::firefox(watch),
        Part::All => bail!("all is made of the others"),
    })
}

/// Does the work of a part, or the rest of it, and prints its result.
fn attempt(part: Part, mut watch: Watch, work: impl FnOnce(&mut Watch) -> Result<String>) -> Done {
    tell(&format!("\n== {} ==", name(part)));
    let result = work(&mut watch);
    let failed = result.is_err();
    let message = result.unwrap_or_else(|error| format!("FAILED: {error:#}"));
    let message = format!("{}: {message}{}", name(part), watch.steps());
    tell(&message);
    Done {
        part,
        message,
        failed,
        watch,
    }
}

fn name(part: Part) -> String {
    part.to_possible_value()
        .map_or_else(String::new, |value| value.get_name().to_owned())
}
