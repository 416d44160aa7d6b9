//! The npm package: the page's workers, and the program that hands them work from other pages.

use crate::packages::{EMBED, MODULES};
use crate::page::{self, Build};
use crate::shell::{root, target, tell};
use crate::{dist, tools};
use anyhow::Result;
use std::fs;
use std::path::PathBuf;

/// Builds the package and returns its folder, which `npm pack` and `npm publish` take.
pub fn package() -> Result<PathBuf> {
    tools::target(tools::WASM)?;
    let modules = page::modules();
    for module in MODULES.iter().filter(|module| module.package != "studio") {
        page::make(module, Build::Release, &modules)?;
    }
    assemble(Build::Release)
}

/// Returns the package's folder.
pub fn folder() -> PathBuf {
    target().join("npm/sinew")
}

/// Builds the package of workers that have been built.
pub fn assemble(build: Build) -> Result<PathBuf> {
    let modules = page::modules();
    page::make(&EMBED, build, &modules)?;
    let folder = folder();
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    page::copy(&root().join("crate/embed/package"), &folder)?;
    let workers = MODULES.iter().filter(|module| module.package != "studio");
    for module in workers.chain([&EMBED]) {
        page::copy_module(module, &modules, &folder)?;
    }
    for script in ["worker.js", "digger_worker.js", "tools_worker.js"] {
        page::copy(&root().join("www").join(script), &folder.join(script))?;
    }
    for license in ["LICENSE-APACHE", "LICENSE-MIT"] {
        page::copy(&root().join(license), &folder.join(license))?;
    }
    if build == Build::Release {
        dist::weigh(&folder, &[EMBED])?;
    }
    tell(&format!("Wrote {}.", folder.display()));
    Ok(folder)
}
