//! The built page in a real browser; the tests themselves are in `tests/`.

use super::{Chosen, Watch, portable};
use crate::page::{self, Build};
use crate::shell::{artifacts, cargo, command, executable, root, run, target};
use crate::{dist, tools};
use anyhow::{Result, bail};
use std::path::PathBuf;

/// Files of tests that measure how the page behaves in time: each has the machine to itself.
const ALONE: [&str; 2] = ["rest.test.mjs", "speed.test.mjs"];

/// What is tested, and with what.
pub struct Built {
    page: PathBuf,
    program: PathBuf,
    chromium: PathBuf,
}

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen, built: Built) -> Result<String> {
    let screenshots = target().join("screenshots");
    std::fs::create_dir_all(&screenshots)?;

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
    let count = tests.len();
    let (alone, together) = tests
        .into_iter()
        .partition(|name: &String| ALONE.contains(&name.as_str()));
    let run = |tests: Vec<String>, at_once: &str| {
        if tests.is_empty() {
            return Ok(());
        }
        let mut node = command("node", &["--test", "--test-reporter=spec", at_once]);
        if let Some(pattern) = pattern {
            node.args(["--test-name-pattern", pattern]);
        }
        run(node
            .args(tests)
            .current_dir(&folder)
            .env("CHROMIUM", &built.chromium)
            .env("SINEW_PAGE", &built.page)
            .env("SINEW_PROGRAM", &built.program)
            .env("SINEW_SCREENSHOTS", &screenshots))
    };
    watch.step("tests", || run(together, "--test-concurrency=2"))?;
    watch.step("alone", || run(alone, "--test-concurrency=1"))?;
    Ok(format!(
        "{count} files of tests passed, screenshots in {}",
        screenshots.display()
    ))
}

/// Builds the page and the program: those that are shipped, and whose sizes are held to limits, where everything is tested; else
/// what is built soonest. Installs what drives the page.
pub fn build(watch: &mut Watch, chosen: &Chosen) -> Result<Built> {
    let (page, program) = if *chosen == Chosen::All {
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
    let chromium = tools::chromium()?;
    Ok(Built {
        page,
        program,
        chromium,
    })
}
