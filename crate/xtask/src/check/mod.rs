//! All tests: `cargo xtask test`.

mod chosen;
mod e2e;
mod lint;
mod native;
mod portable;
mod quick;
mod wasm;

use crate::shell::{in_lane, tell};
use anyhow::{Result, bail};
use chosen::Chosen;
use clap::ValueEnum;
use std::time::Instant;

/// A part of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// Formatting, lints and tests of the packages that have been changed since the last commit, and the pins of pictures: after
    /// each edit. Runs only where it is asked for, as the others do all of it.
    Quick,
    /// Formatting and lints.
    Lint,
    /// Tests on this machine.
    Native,
    /// The mathematics' tests as wasm, in node and in a browser, and pictures on every kind of processor.
    Wasm,
    /// The page in a real browser.
    E2e,
    /// The page in Firefox. Runs only where it is asked for.
    Firefox,
}

/// What a part takes, step by step.
#[derive(Default)]
pub struct Watch {
    steps: Vec<(&'static str, u64)>,
}

impl Watch {
    /// Does something and keeps how long it takes.
    pub fn step<T>(&mut self, name: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let begun = Instant::now();
        let done = work();
        self.steps.push((name, begun.elapsed().as_secs()));
        done
    }

    /// `, 46 s (lint 12, build 34)`.
    fn told(&self) -> String {
        let all: u64 = self.steps.iter().map(|(_, seconds)| seconds).sum();
        let steps: Vec<String> = self
            .steps
            .iter()
            .map(|(name, seconds)| format!("{name} {seconds}"))
            .collect();
        if steps.is_empty() {
            String::new()
        } else {
            format!(", {all} s ({})", steps.join(", "))
        }
    }
}

/// Runs one part, or all. A part that fails does not keep the others from being run.
pub fn test(part: Option<Part>, filter: Option<String>) -> Result<()> {
    let begun = Instant::now();
    let done = match part {
        Some(Part::Quick) => vec![run(Part::Quick, &Chosen::changed(filter)?)],
        // Crates are not to be seen there.
        Some(Part::E2e) => vec![run(Part::E2e, &filter.map_or(Chosen::All, Chosen::Test))],
        Some(Part::Firefox) => vec![run(Part::Firefox, &Chosen::All)],
        Some(part) => vec![run(part, &Chosen::new(filter))],
        None => all(),
    };
    let summary: String = done
        .iter()
        .map(|done| format!("\n  {}", done.said))
        .collect();
    println!("\nTested in {} s:{summary}", begun.elapsed().as_secs());
    let failed: Vec<String> = done
        .iter()
        .filter(|done| done.failed)
        .map(|done| name(done.part))
        .collect();
    if !failed.is_empty() {
        bail!("{} failed", failed.join(", "));
    }
    Ok(())
}

/// All parts, in two lanes: the code's, and beside it the page is built. Its tests come last, as they want the machine for
/// themselves.
fn all() -> Vec<Done> {
    let mut watch = Watch::default();
    let (mut done, built) = std::thread::scope(|scope| {
        let page = scope.spawn(|| in_lane("page", || e2e::build(&mut watch, e2e::Of::Release)));
        let code = scope.spawn(|| {
            let parts = [Part::Lint, Part::Native, Part::Wasm];
            in_lane("code", || parts.map(|part| run(part, &Chosen::All)))
        });
        let done = code
            .join()
            .map_or_else(|_| vec![panicked(Part::Native)], Vec::from);
        (done, page.join())
    });
    done.push(built.map_or_else(
        |_| panicked(Part::E2e),
        |built| {
            attempt(Part::E2e, watch, |watch| {
                e2e::check(watch, &Chosen::All, built?)
            })
        },
    ));
    done
}

/// What a part has come to.
struct Done {
    part: Part,
    said: String,
    failed: bool,
}

/// What a part has come to whose lane panicked.
fn panicked(part: Part) -> Done {
    let said = format!("the lane of {} panicked", name(part));
    let failed = true;
    Done { part, said, failed }
}

fn run(part: Part, chosen: &Chosen) -> Done {
    attempt(part, Watch::default(), |watch| match part {
        Part::Quick => quick::check(watch, chosen),
        Part::Lint => lint::check(watch, chosen),
        Part::Native => native::check(watch, chosen),
        Part::Wasm => wasm::check(watch, chosen),
        Part::E2e => {
            let of = if *chosen == Chosen::All {
                e2e::Of::Release
            } else {
                e2e::Of::Development
            };
            let built = e2e::build(watch, of)?;
            e2e::check(watch, chosen, built)
        }
        Part::Firefox => e2e::firefox(watch),
    })
}

/// Does the work of a part, or what is left of it, and tells what has come of it.
fn attempt(part: Part, mut watch: Watch, work: impl FnOnce(&mut Watch) -> Result<String>) -> Done {
    tell(&format!("\n== {} ==", name(part)));
    let result = work(&mut watch);
    let failed = result.is_err();
    let said = result.unwrap_or_else(|error| format!("FAILED: {error:#}"));
    let said = format!("{}: {said}{}", name(part), watch.told());
    tell(&said);
    Done { part, said, failed }
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

    #[test]
    fn steps_are_told_with_their_seconds() {
        let mut watch = super::Watch::default();
        assert_eq!(watch.told(), "");
        assert_eq!(watch.step("build", || Ok(3)).ok(), Some(3));
        let failed: anyhow::Result<()> = watch.step("run", || anyhow::bail!("no"));
        assert!(failed.is_err());
        assert_eq!(watch.told(), ", 0 s (build 0, run 0)");
    }
}
