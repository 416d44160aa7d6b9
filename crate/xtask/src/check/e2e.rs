//! The built page in a real browser; the tests themselves are in `tests/`.

use super::{Chosen, Watch, portable};
use crate::page::{self, Build};
use crate::shell::{artifacts, cargo, command, executable, root, run, target};
use crate::{dist, tools};
use anyhow::{Result, bail};
use std::path::PathBuf;

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    let (page, program) = built(watch, chosen)?;
    tools::node_packages()?;
    let chromium = tools::chromium()?;
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
    // One after the other: each has the machine to itself.
    let mut options = vec!["--test", "--test-concurrency=1", "--test-reporter=spec"];
    if let Some(filter) = chosen.test() {
        let named: Vec<String> = tests
            .iter()
            .filter(|name| name.contains(filter))
            .cloned()
            .collect();
        if named.is_empty() {
            options.extend(["--test-name-pattern", filter]);
        } else {
            tests = named;
        }
    }
    watch.step("tests", || {
        run(command("node", &options)
            .args(&tests)
            .current_dir(&folder)
            .env("CHROMIUM", chromium)
            .env("SINEW_PAGE", page)
            .env("SINEW_PROGRAM", program)
            .env("SINEW_SCREENSHOTS", &screenshots))
    })?;
    let count = tests.len();
    Ok(format!(
        "{count} files of tests passed, screenshots in {}",
        screenshots.display()
    ))
}

/// The page and the program: those that are shipped, and whose sizes are held to limits, where everything is tested; else what is
/// built soonest.
fn built(watch: &mut Watch, chosen: &Chosen) -> Result<(PathBuf, PathBuf)> {
    if *chosen == Chosen::All {
        let page = watch.step("page", dist::dist)?;
        let program = watch.step("program", portable::build)?.program;
        return Ok((page, program));
    }
    let folder = page::served();
    watch.step("page", || page::build(Build::Development, &folder))?;
    let build = ["build", "--package", "cli"];
    let message = ["--message-format", "json-render-diagnostics"];
    let made = watch.step("program", || artifacts(cargo(&build).args(message)))?;
    Ok((folder, executable(&made, "sinew")?))
}
