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

    /// `(lint 12, build 34)`, in seconds.
    fn told(&self) -> String {
        let steps: Vec<String> = self
            .steps
            .iter()
            .map(|(name, seconds)| format!("{name} {seconds}"))
            .collect();
        if steps.is_empty() {
            String::new()
        } else {
            format!(" ({})", steps.join(", "))
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

/// All parts, in two lanes one after the other: the code's, then the page's, as tests in a browser want the machine for themselves.
fn all() -> Vec<Done> {
    let lane = |name, parts: &'static [Part]| {
        move || {
            in_lane(name, true, || {
                parts
                    .iter()
                    .map(|part| run(*part, &Chosen::All))
                    .collect::<Vec<Done>>()
            })
        }
    };
    let lanes = [
        (
            Part::Native,
            lane("code", &[Part::Lint, Part::Native, Part::Wasm]),
        ),
        (Part::E2e, lane("page", &[Part::E2e])),
    ];
    let done = lanes.into_iter().map(|(part, lane)| {
        // A thread of its own, so that a panic in one does not keep the other from being run.
        std::thread::spawn(lane).join().unwrap_or_else(|_| {
            let said = format!("the lane of {} panicked", name(part));
            let failed = true;
            vec![Done { part, said, failed }]
        })
    });
    done.flatten().collect()
}

/// What a part has come to.
struct Done {
    part: Part,
    said: String,
    failed: bool,
}

fn run(part: Part, chosen: &Chosen) -> Done {
    let begun = Instant::now();
    let mut watch = Watch::default();
    tell(&format!("\n== {} ==", name(part)));
    let result = match part {
        Part::Quick => quick::check(&mut watch, chosen),
        Part::Lint => lint::check(&mut watch, chosen),
        Part::Native => native::check(&mut watch, chosen),
        Part::Wasm => wasm::check(&mut watch, chosen),
        Part::E2e => e2e::check(&mut watch, chosen),
    };
    let failed = result.is_err();
    let said = result.unwrap_or_else(|error| format!("FAILED: {error:#}"));
    let said = format!(
        "{}: {said}, {} s{}",
        name(part),
        begun.elapsed().as_secs(),
        watch.told()
    );
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
        assert_eq!(watch.told(), " (build 0, run 0)");
    }
}
