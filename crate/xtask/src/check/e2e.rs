//! The built page in a real browser; the tests themselves are in `tests/`.

use super::{Chosen, Watch, portable};
use crate::page::{self, Build};
use crate::shell::{artifacts, cargo, command, executable, root, run, target};
use crate::{dist, tools};
use anyhow::{Result, bail};
use std::path::PathBuf;

/// What is tested, and with what.
pub struct Built {
    page: PathBuf,
    program: PathBuf,
}

/// Which page and program are built.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// Those that are shipped, whose sizes are held to limits.
    Release,
    /// Those that are built soonest.
    Development,
}

impl Built {
    /// `node --test` on files in `tests/`, told of the page and the program.
    fn tests(&self, options: &[&str], files: &[String]) -> Result<std::process::Command> {
        let screenshots = target().join("screenshots");
        std::fs::create_dir_all(&screenshots)?;
        let mut node = command("node", &["--test", "--test-reporter=spec"]);
        node.args(options)
            .args(files)
            .current_dir(root().join("tests"))
            .env("SINEW_PAGE", &self.page)
            .env("SINEW_PROGRAM", &self.program)
            .env("SINEW_SCREENSHOTS", screenshots);
        Ok(node)
    }
}

/// Runs the tests in Firefox.
pub fn firefox(watch: &mut Watch) -> Result<String> {
    let built = build(watch, Of::Development)?;
    let firefox = tools::firefox()?;
    let mut tests = built.tests(&[], &[String::from("firefox.mjs")])?;
    watch.step("tests", || run(tests.env("FIREFOX", firefox)))?;
    Ok(String::from("the page works in Firefox"))
}

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen, built: Built) -> Result<String> {
    let folder = root().join("tests");
    let mut tests: Vec<_> = std::fs::read_dir(&folder)?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".test.mjs"))
        .collect();
    tests.sort();
    if tests.is_empty() {
        bail!("tests/ holds no tests");
    }
    let mut pattern = None;
    if let Some(filter) = chosen.test() {
        if tests.iter().any(|name| name.contains(filter)) {
            tests.retain(|name| name.contains(filter));
        } else {
            pattern = Some(filter);
        }
    }
    // Two side by side: a browser waits more than it works.
    let mut options = vec!["--test-concurrency=2"];
    if let Some(pattern) = pattern {
        options.extend(["--test-name-pattern", pattern]);
    }
    let mut node = built.tests(&options, &tests)?;
    node.env("CHROMIUM", tools::chromium()?);
    watch.step("tests", || run(&mut node))?;
    let count = tests.len();
    let screenshots = target().join("screenshots");
    Ok(format!(
        "{count} files of tests passed, screenshots in {}",
        screenshots.display()
    ))
}

/// Builds the page and the program, and installs the packages that drive a browser.
pub fn build(watch: &mut Watch, of: Of) -> Result<Built> {
    let (page, program) = if of == Of::Release {
        let page = watch.step("page", dist::dist)?;
        let program = watch.step("program", portable::build)?.program;
        (page, program)
    } else {
        let page = page::served();
        watch.step("page", || page::build(Build::Development, &page))?;
        let build = ["build", "--package", "cli"];
        let message = ["--message-format", "json-render-diagnostics"];
        let made = watch.step("program", || artifacts(cargo(&build).args(message)))?;
        (page, executable(&made, "sinew")?)
    };
    tools::node_packages()?;
    Ok(Built { page, program })
}
