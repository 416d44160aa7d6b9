//! Formatting and lints, for this machine and for wasm.

use super::files::Watch;
use super::{Chosen, english};
use crate::packages::{EMBED, MODULES};
use crate::shell::{cargo, root, run};
use crate::tools;
use anyhow::{Context, Result, bail};
use std::fs;

const DENY: [&str; 3] = ["--", "-D", "warnings"];

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    format()?;
    modules()?;
    english::check()?;
    watch.step("native", || clippy(&chosen.packages()))?;
    tools::target(tools::WASM)?;
    watch.step("wasm", || {
        // The tests of these packages are for this machine only.
        let mut options = vec![String::from("--target"), tools::WASM.into()];
        let all = MODULES.iter().chain([&EMBED]);
        for module in all.filter(|module| chosen.has(module.package)) {
            options.extend(["--package".into(), module.package.into()]);
            if !module.features.is_empty() {
                options.push(format!("--features={}/{}", module.package, module.features));
            }
        }
        if options.len() == 2 {
            return Ok(());
        }
        lint(&options)
    })?;
    Ok(String::from("clean"))
}

/// Checks that each file of tests is a module of its program; otherwise it would never run.
fn modules() -> Result<()> {
    for package in fs::read_dir(root().join("crate"))? {
        let tests = package?.path().join("tests");
        let Ok(program) = fs::read_to_string(tests.join("it/main.rs")) else {
            continue;
        };
        let beside = fs::read_dir(&tests)?.chain(fs::read_dir(tests.join("it"))?);
        for file in beside {
            let path = file?.path();
            let is_module = path.extension().is_some_and(|extension| extension == "rs")
                || path.join("mod.rs").is_file();
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            if is_module && name != "main" && !program.contains(&format!("mod {name};")) {
                bail!("{} is no module of tests/it/main.rs", path.display());
            }
        }
    }
    Ok(())
}

/// Checks the format of all code.
pub fn format() -> Result<()> {
    run(&mut cargo(&["fmt", "--all", "--check"]))
        .context("The code is not formatted. Run: cargo fmt --all")
}

/// Lints packages with their tests.
pub fn clippy(packages: &[&str]) -> Result<()> {
    lint(&[&["--all-targets"], packages].concat())
}

fn lint(options: &[impl AsRef<std::ffi::OsStr>]) -> Result<()> {
    run(cargo(&["clippy"]).args(options).args(DENY))
}
