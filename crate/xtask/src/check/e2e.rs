//! The built page in a real browser; the tests themselves are in `tests/`.

use crate::shell::{command, root, run, target};
use crate::{dist, examples, tools};
use anyhow::Result;

/// Runs this part.
pub fn check() -> Result<String> {
    tools::node_packages()?;
    let chromium = tools::chromium()?;
    let folder = dist::dist()?;
    let sinew = examples::sinew()?;
    let screenshots = target().join("screenshots");
    std::fs::create_dir_all(&screenshots)?;
    run(command(
        "node",
        &[
            "--test",
            "--test-concurrency=1",
            "--test-reporter=spec",
            ".",
        ],
    )
    .current_dir(root().join("tests"))
    .env("CHROMIUM", chromium)
    .env("SINEW_PAGE", folder)
    .env("SINEW_PROGRAM", sinew)
    .env("SINEW_SCREENSHOTS", &screenshots))?;
    Ok(format!("screenshots in {}", screenshots.display()))
}
