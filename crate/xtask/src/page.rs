//! Building the page: packages of wasm, and the files of `www/`.

use crate::packages::{MODULES, Module};
use crate::shell::{artifacts, cargo, command, root, run, target, tell};
use crate::tools;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use wasm_bindgen_cli_support::Bindgen;

/// How a page is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// Quickly. What draws and traces is optimised all the same: without, pictures take minutes.
    Development,
    /// Small and fast.
    Release,
}

/// Builds the page into a folder, which is emptied first.
pub fn build(build: Build, folder: &Path) -> Result<()> {
    tools::wasm_target()?;
    let mut compiled = Vec::new();
    for (i, module) in MODULES.iter().enumerate() {
        let (begun, count) = (Instant::now(), MODULES.len());
        let title = format!("Building {}, {} of {count}", module.name, i + 1);
        match build {
            Build::Development => tell(&format!(
                "{title}: about {} s the first time, then as long as what has changed takes.",
                module.seconds
            )),
            Build::Release => tell(&format!(
                "{title}, for a release: some minutes, as all of it is optimised at once."
            )),
        }
        compiled.push(compile(module, build)?);
        tell(&format!(
            "{} is built ({} s).",
            module.name,
            begun.elapsed().as_secs()
        ));
    }
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("{} is in use", folder.display()))?;
    }
    fs::create_dir_all(folder)?;
    copy(&root().join("index.html"), &folder.join("index.html"))?;
    copy(&root().join("www"), folder)?;
    for (module, wasm) in MODULES.iter().zip(&compiled) {
        bind(wasm, module.name, folder)?;
    }
    if build == Build::Release
        && let Some(wasm_opt) = tools::wasm_opt()
    {
        for module in MODULES {
            let file = folder.join(format!("{}_bg.wasm", module.name));
            optimise(&wasm_opt, LEVEL, &file, &file)?;
        }
    }
    Ok(())
}

/// How hard wasm-opt tries. Harder is slower for what a worker runs: with -O3 flakes take a tenth longer, as numbers
/// side by side are moved about more. The app is no smaller after brotli with -Oz.
pub const LEVEL: &str = "-O1";

/// Has wasm-opt make a wasm of another.
pub fn optimise(wasm_opt: &Path, level: &str, from: &Path, to: &Path) -> Result<()> {
    let [wasm_opt, from, to] = [wasm_opt, from, to].map(Path::to_string_lossy);
    run(&mut command("node", &[&wasm_opt, &from, level, "-o", &to]))
}

/// Settings for cargo of everything that is compiled to wasm for development: what tells lines of code would take as long to
/// write, and to read for wasm-bindgen, as all else.
pub const NO_LINES: (&str, &str) = ("CARGO_PROFILE_DEV_DEBUG", "false");

/// Compiles a package to wasm and gives the file.
fn compile(module: &Module, build: Build) -> Result<PathBuf> {
    let profile = match build {
        Build::Development => "dev",
        Build::Release => module.profile,
    };
    // Only a cdylib: with an rlib beside it, link-time optimisation is silently left out.
    let mut command = cargo(&[
        "rustc",
        "--package",
        module.package,
        "--features",
        module.features,
        "--lib",
        "--crate-type",
        "cdylib",
        "--target",
        tools::WASM,
        "--profile",
        profile,
        "--message-format",
        "json-render-diagnostics",
    ]);
    artifacts(command.env(NO_LINES.0, NO_LINES.1))?
        .into_iter()
        .flat_map(|message| message["filenames"].as_array().cloned().unwrap_or_default())
        .filter_map(|file| file.as_str().map(PathBuf::from))
        .rfind(|file| {
            file.extension().is_some_and(|e| e == "wasm")
                && file.file_stem().is_some_and(|stem| stem == module.package)
        })
        .with_context(|| format!("cargo made no wasm of {}", module.package))
}

/// Writes NAME.js and NAME_bg.wasm.
fn bind(wasm: &Path, name: &str, folder: &Path) -> Result<()> {
    Bindgen::new()
        .input_path(wasm)
        .web(true)?
        .typescript(false)
        // The script looks for its wasm beside itself.
        .omit_default_module_path(false)
        .out_name(name)
        .generate(folder)
        .with_context(|| format!("wasm-bindgen could not read {}", wasm.display()))
}

/// Copies a file, or what is in a folder.
fn copy(from: &Path, to: &Path) -> Result<()> {
    if !from.is_dir() {
        fs::copy(from, to).with_context(|| format!("{} is missing", from.display()))?;
        return Ok(());
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

/// Where `serve` builds the page.
pub fn served() -> PathBuf {
    target().join("page")
}
