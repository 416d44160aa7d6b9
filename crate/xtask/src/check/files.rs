//! Files of tests: running them side by side, counting what passed, and telling which took longest.

use crate::shell::{at_once, say, tell};
use anyhow::{Context, Result, bail};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A file of tests: a module of a crate's test program, or a script that drives a browser.
pub struct File {
    /// Its name, as `field chart`.
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
    /// Parses what libtest and node's test runner write when they end.
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

/// Seconds that steps and files of tests took, and numbers of tests.
#[derive(Default)]
pub struct Watch {
    steps: Vec<(&'static str, Duration)>,
    files: Vec<(String, Duration)>,
    /// The tests of all files.
    pub count: Count,
}

impl Watch {
    /// Does something and keeps how long it takes.
    pub fn step<T>(&mut self, name: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let begun = Instant::now();
        let done = work();
        self.steps.push((name, begun.elapsed()));
        done
    }

    /// Runs files of tests, as many at a time as there are cores, in their order, and gives how
    /// many tests there were. A file that fails does not keep the others from being run.
    ///
    /// # Errors
    /// If a file fails: their names. What they wrote has been told.
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
        let step = |(name, time): &(&str, Duration)| format!("{name} {}", time.as_secs());
        let steps: Vec<String> = self.steps.iter().map(step).collect();
        format!(", {} s ({})", all.as_secs(), steps.join(", "))
    }

    /// Returns a line for each of the ten files that took longest.
    pub fn slowest(&self) -> String {
        let mut files: Vec<_> = self.files.iter().collect();
        files.sort_by_key(|(_, time)| std::cmp::Reverse(*time));
        let line = |(name, time): &&(String, Duration)| {
            format!("\n  {:6.1} s  {name}", time.as_secs_f64())
        };
        files.iter().take(10).map(line).collect()
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

/// Runs a file, and tells how many tests passed, or all that it wrote if it failed.
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
                // A program that ended before it could tell has failed as a whole.
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
        let counts = |passed, failed, skipped| Count {
            passed,
            failed,
            skipped,
        };
        assert_eq!(Count::read(libtest), counts(23, 2, 1));
        let node = "ℹ tests 5\nℹ pass 3\nℹ fail 1\nℹ cancelled 0\nℹ skipped 1\nℹ todo 0\n";
        assert_eq!(Count::read(node), counts(3, 1, 1));
        assert_eq!(Count::read("no tests to run!"), Count::default());
    }

    #[test]
    fn files_that_fail_are_told_and_the_others_run() {
        let file = |name: &str, program: &str| File {
            name: name.into(),
            command: Command::new(program),
        };
        let mut watch = Watch::default();
        let done = watch.run(vec![
            file("a", "there is no such program"),
            file("b", "true"),
        ]);
        assert!(done.is_err_and(|error| error.to_string().starts_with("a: ")));
        assert_eq!(watch.count.failed, 1);
        assert!(watch.slowest().contains(" s  b"));
    }

    #[test]
    fn steps_are_told_with_their_seconds() {
        let mut watch = Watch::default();
        assert_eq!(watch.steps(), "");
        assert_eq!(watch.step("build", || Ok(3)).ok(), Some(3));
        let failed: Result<()> = watch.step("run", || bail!("no"));
        assert!(failed.is_err());
        assert_eq!(watch.steps(), ", 0 s (build 0, run 0)");
    }
}
