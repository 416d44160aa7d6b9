//! The built page in a real browser; the tests themselves are in `tests/`.

use crate::shell::{command, root, run, target};
use crate::{dist, examples, tools};
use anyhow::{Result, bail};

/// Runs this part.
pub fn check() -> Result<String> {
    tools::node_packages()?;
    let chromium = tools::chromium()?;
    let page = dist::dist()?;
    let program = examples::sinew()?;
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
    let options = ["--test", "--test-concurrency=1", "--test-reporter=spec"];
    run(command("node", &options)
        .args(&tests)
        .current_dir(&folder)
        .env("CHROMIUM", chromium)
        .env("SINEW_PAGE", page)
        .env("SINEW_PROGRAM", program)
        .env("SINEW_SCREENSHOTS", &screenshots))?;
    let count = tests.len();
    Ok(format!(
        "{count} files of tests passed, screenshots in {}",
        screenshots.display()
    ))
}
