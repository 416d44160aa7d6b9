//! The built page in a real browser; the tests themselves are in `tests/`.

use super::Chosen;
use super::files::{File, Watch};
use crate::page::{self, Build};
use crate::shell::{PORTABLE, artifacts, cargo, command, executable, root, target};
use crate::{dist, tools};
use anyhow::{Result, bail};
use std::path::PathBuf;

/// What is tested, and with what.
pub struct Built {
    page: PathBuf,
    program: PathBuf,
}

impl Built {
    /// Returns `node --test` on a file in `tests/`, told of the page and the program: those of its tests
    /// whose names have a pattern.
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
            .env("SINEW_PROGRAM", &self.program)
            .env("SINEW_SCREENSHOTS", screenshots);
        Ok(node)
    }
}

/// Runs the tests in Firefox.
pub fn firefox(watch: &mut Watch) -> Result<String> {
    let built = build(watch, false)?;
    let firefox = tools::firefox()?;
    let mut command = built.tests(None, "firefox.mjs")?;
    command.env("FIREFOX", firefox);
    let name = String::from("browser firefox");
    watch.run(vec![File { name, command }])?;
    Ok(String::from("the page works in Firefox"))
}

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen, built: Built) -> Result<String> {
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

/// Builds the page and the program, and installs the packages that drive a browser: of a `release`
/// those that are shipped, else those that are built soonest.
pub fn build(watch: &mut Watch, release: bool) -> Result<Built> {
    let (page, program) = if release {
        let page = watch.step("page", dist::dist)?;
        // The program for any processor of this kind: the page's pictures are compared with its own.
        let program = watch.step("program", || program(cfg!(target_arch = "x86_64")))?;
        (page, program)
    } else {
        let page = page::served();
        watch.step("page", || page::build(Build::Development, &page))?;
        (page, watch.step("program", || program(false))?)
    };
    tools::node_packages()?;
    Ok(Built { page, program })
}

/// Builds the program `sinew`; `portable`, for any processor of this one's kind.
fn program(portable: bool) -> Result<PathBuf> {
    let message = ["--message-format", "json-render-diagnostics"];
    let mut build = cargo(&["build", "--package", "cli", "--bin", "sinew"]);
    build.args(message);
    if portable {
        build.envs(PORTABLE.settings());
    }
    executable(&artifacts(&mut build)?, "sinew")
}
