//! The built page in a real browser; the tests themselves are in `tests/`.

use super::Chosen;
use super::files::{File, Watch};
use crate::page::{self, Build};
use crate::shell::{artifacts, cargo, command, executable, root, target};
use crate::{dist, package, tools};
use anyhow::{Result, bail};
use std::path::PathBuf;

/// The page that is tested, and the program whose pictures it is compared with.
struct Built {
    page: PathBuf,
    program: PathBuf,
}

impl Built {
    /// Returns the command `node --test` on a file in `tests/`, with the paths of the page and the
    /// program: for those of its tests whose names contain `pattern`.
    fn tests(&self, pattern: Option<&str>, file: &str) -> Result<std::process::Command> {
        let screenshots = target().join("screenshots");
        std::fs::create_dir_all(&screenshots)?;
        let mut node = command("node", &["--test", "--test-reporter=spec"]);
        if let Some(pattern) = pattern {
            node.args(["--test-name-pattern", pattern]);
        }
        node.arg(file)
            .current_dir(root().join("tests"))
            .env("SINEW_PAGE", &self.page)
            .env("SINEW_PACKAGE", package::folder())
            .env("SINEW_PROGRAM", &self.program)
            .env("SINEW_SCREENSHOTS", screenshots);
        Ok(node)
    }
}

/// Runs the tests in Firefox.
pub fn firefox(watch: &mut Watch) -> Result<String> {
    let page = build(watch, false)?;
    let program = watch.step("program", program)?;
    let built = Built { page, program };
    let firefox = tools::firefox()?;
    let mut command = built.tests(None, "firefox.mjs")?;
    command.env("FIREFOX", firefox);
    let name = String::from("browser firefox");
    watch.run(vec![File { name, command }])?;
    Ok(String::from("the page works in Firefox"))
}

/// Runs this part on a page, with a program that is built first.
pub fn check(
    watch: &mut Watch,
    chosen: &Chosen,
    page: PathBuf,
    program: fn() -> Result<PathBuf>,
) -> Result<String> {
    let program = watch.step("program", program)?;
    let built = Built { page, program };
    let folder = root().join("tests");
    let mut scripts: Vec<_> = std::fs::read_dir(&folder)?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".test.mjs"))
        .collect();
    scripts.sort();
    let mut pattern = None;
    if let Some(filter) = chosen.test.as_deref() {
        if scripts.iter().any(|name| name.contains(filter)) {
            scripts.retain(|name| name.contains(filter));
        } else {
            pattern = Some(filter);
        }
    }
    let chromium = tools::chromium()?;
    let mut files = Vec::new();
    for script in &scripts {
        let mut command = built.tests(pattern, script)?;
        command.env("CHROMIUM", &chromium);
        let name = format!("browser {}", script.trim_end_matches(".test.mjs"));
        files.push(File { name, command });
    }
    let count = watch.run(files)?;
    if count.passed == 0 {
        bail!("no test was run");
    }
    let screenshots = target().join("screenshots");
    Ok(format!(
        "{} tests passed, screenshots in {}",
        count.passed,
        screenshots.display()
    ))
}

/// Builds the page, and installs the packages that drive a browser. For a `release` it is the page
/// that is shipped, else the one that builds fastest.
pub fn build(watch: &mut Watch, release: bool) -> Result<PathBuf> {
    let page = if release {
        let page = watch.step("page", dist::dist)?;
        watch.step("package", || package::assemble(Build::Release))?;
        page
    } else {
        let page = page::serve_folder();
        watch.step("page", || page::build(Build::Development, &page))?;
        watch.step("package", || package::assemble(Build::Development))?;
        page
    };
    tools::node_packages()?;
    Ok(page)
}

/// Builds the program `sinew`.
pub fn program() -> Result<PathBuf> {
    let message = ["--message-format", "json-render-diagnostics"];
    let mut build = cargo(&["build", "--package", "cli", "--bin", "sinew"]);
    executable(&artifacts(build.args(message))?, "sinew")
}
