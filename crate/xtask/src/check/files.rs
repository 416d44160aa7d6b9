//! Files of tests: running them side by side, counting the tests that passed, and listing the files
//! that took longest.

use crate::shell::{at_once, say, tell};
use anyhow::{Context, Result, bail};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A file of tests: a module of a crate's test program, or a script that drives a browser.
pub struct File {
    /// The name, such as `field chart`.
    pub name: String,
    /// The command that runs it alone.
    pub command: Command,
}

/// Numbers of tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    pub passed: usize,
    pub failed: usize,
    pub skipped: usize,
}

impl std::ops::AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

impl Count {
    /// Parses the summary of libtest or node's test runner.
    pub fn read(output: &str) -> Self {
        let mut count = Self::default();
        for line in output.lines() {
            let words: Vec<&str> = line
                .split([' ', ';'])
                .filter(|word| !word.is_empty())
                .collect();
            match *words.as_slice() {
                [
                    "test",
                    "result:",
                    _,
                    passed,
                    "passed",
                    failed,
                    "failed",
                    skipped,
                    "ignored",
                    ..,
                ] => {
                    count.passed += passed.parse().unwrap_or(0);
                    count.failed += failed.parse().unwrap_or(0);
                    count.skipped += skipped.parse().unwrap_or(0);
                }
                [_, "pass", n] => count.passed += n.parse().unwrap_or(0),
                [_, "fail" | "cancelled", n] => count.failed += n.parse().unwrap_or(0),
                [_, "skipped" | "todo", n] => count.skipped += n.parse().unwrap_or(0),
                _ => {}
            }
        }
        count
    }
}

/// Times of steps and of files of tests, and numbers of tests.
#[derive(Default)]
pub struct Watch {
    steps: Vec<(&'static str, Duration)>,
    files: Vec<(String, Duration)>,
    /// The tests of all files.
    pub count: Count,
}

impl Watch {
    /// Does something and records the time it takes.
    pub fn step<T>(&mut self, name: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let begun = Instant::now();
        let result = work();
        self.steps.push((name, begun.elapsed()));
        result
    }

    /// Runs files of tests in their order, as many at a time as there are cores, and returns the
    /// numbers of tests. A file that fails does not keep the others from running.
    ///
    /// # Errors
    /// If files fail. The message names them; their output has been printed.
    pub fn run(&mut self, files: Vec<File>) -> Result<Count> {
        let begun = Instant::now();
        let done = at_once(files.into_iter().map(|file| move || run(file)).collect());
        self.steps.push(("tests", begun.elapsed()));
        let (mut all, mut failed) = (Count::default(), Vec::new());
        for file in done {
            let Ran {
                name,
                time,
                count,
                error,
            } = file;
            all += count;
            if let Some(error) = error {
                failed.push(format!("{name}: {error}"));
            }
            self.files.push((name, time));
        }
        self.count += all;
        if !failed.is_empty() {
            bail!("{}", failed.join("; "));
        }
        Ok(all)
    }

    /// Adds the times and counts of another part.
    pub fn add(&mut self, other: Self) {
        self.files.extend(other.files);
        self.count += other.count;
    }

    /// Returns `, 46 s (lint 12, build 34)`; nothing if there were no steps.
    pub fn steps(&self) -> String {
        if self.steps.is_empty() {
            return String::new();
        }
        let all: Duration = self.steps.iter().map(|(_, time)| *time).sum();
        let steps = self.steps.iter();
        let steps = steps.map(|(name, time)| format!("{name} {}", time.as_secs()));
        let steps: Vec<String> = steps.collect();
        format!(", {} s ({})", all.as_secs(), steps.join(", "))
    }

    /// Returns a line for each of the ten files that took longest.
    pub fn slowest(&self) -> String {
        let mut files: Vec<_> = self.files.iter().collect();
        files.sort_by_key(|(_, time)| std::cmp::Reverse(*time));
        let files = files.into_iter().take(10);
        files
            .map(|(name, time)| format!("\n  {:6.1} s  {name}", time.as_secs_f64()))
            .collect()
    }
}

/// A file that has been run.
struct Ran {
    name: String,
    time: Duration,
    count: Count,
    /// The reason why it failed.
    error: Option<String>,
}

/// Runs a file, and prints the number of tests that passed, and all its output if it failed.
fn run(File { name, mut command }: File) -> Ran {
    let begun = Instant::now();
    let output = command.stdin(Stdio::null()).output();
    let time = begun.elapsed();
    let (mut count, mut error) = (Count::default(), None);
    match output.with_context(|| format!("{:?} could not be run", command.get_program())) {
        Ok(output) => {
            let text = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
            count = Count::read(&text[0]);
            if !output.status.success() {
                // A program that ended before its summary has failed as a whole.
                count.failed = count.failed.max(1);
                error = Some(output.status.to_string());
                say(&command);
                tell(&text.concat());
            }
        }
        Err(failure) => {
            count.failed = 1;
            error = Some(format!("{failure:#}"));
        }
    }
    let Count { passed, failed, .. } = count;
    let failures = if failed > 0 {
        format!(", {failed} FAILED")
    } else {
        String::new()
    };
    tell(&format!(
        "{name}: {passed} passed{failures} ({:.1} s)",
        time.as_secs_f64()
    ));
    Ran {
        name,
        time,
        count,
        error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_counted() {
        let libtest = "test a ... ok\ntest result: ok. 3 passed; 0 failed; 1 ignored; 0 measured\n\
            \ntest result: FAILED. 20 passed; 2 failed; 0 ignored; 0 measured";
        let node = "ℹ tests 5\nℹ pass 3\nℹ fail 1\nℹ cancelled 0\nℹ skipped 1\nℹ todo 0\n";
        for (output, counts) in [
            (libtest, [23, 2, 1]),
            (node, [3, 1, 1]),
            ("no tests to run!", [0; 3]),
        ] {
            let count = Count::read(output);
            assert_eq!([count.passed, count.failed, count.skipped], counts);
        }
    }

    #[test]
    fn files_that_fail_are_named_and_the_others_run() {
        let files = [("a", "there is no such program"), ("b", "true")];
        let files = files.map(|(name, program)| File {
            name: name.into(),
            command: Command::new(program),
        });
        let mut watch = Watch::default();
        let result = watch.run(files.into());
        assert!(result.is_err_and(|error| error.to_string().starts_with("a: ")));
        assert_eq!(watch.count.failed, 1);
        assert!(watch.slowest().contains(" s  b"));
    }

    #[test]
    fn steps_are_listed_with_their_seconds() {
        let mut watch = Watch::default();
        assert_eq!(watch.steps(), "");
        assert_eq!(watch.step("build", || Ok(3)).ok(), Some(3));
        let failed: Result<()> = watch.step("run", || bail!("no"));
        assert!(failed.is_err());
        assert_eq!(watch.steps(), ", 0 s (build 0, run 0)");
    }
}
