//! Building the page: three packages of wasm, and the files of `www/`.

use crate::shell::{artifacts, cargo, command, root, run, target};
use crate::tools;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use wasm_bindgen_cli_support::Bindgen;

/// How a page is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// Quickly. The tracer is optimised all the same: without, pictures take minutes.
    Development,
    /// Small and fast.
    Release,
}

/// Builds the page into a folder, which is emptied first.
pub fn build(build: Build, folder: &Path) -> Result<()> {
    tools::wasm_target()?;
    let profile = match build {
        Build::Development => "dev",
        Build::Release => "page",
    };
    let app = compile("studio", profile, &[])?;
    // The workers need a feature that the app must not have: hence separate builds.
    let tracer = compile("worker", "release", &["--features", "entry"])?;
    let jobs = compile("tools", "release", &["--features", "entry"])?;

    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("{} is in use", folder.display()))?;
    }
    fs::create_dir_all(folder)?;
    copy(&root().join("index.html"), &folder.join("index.html"))?;
    copy(&root().join("www"), folder)?;
    bind(&app, "studio", folder)?;
    bind(&tracer, "tracer", folder)?;
    bind(&jobs, "tools", folder)?;
    if build == Build::Release
        && let Some(wasm_opt) = tools::wasm_opt()
    {
        for (name, level) in [
            ("studio", "-O1"),
            ("tracer", WORKER_LEVEL),
            ("tools", WORKER_LEVEL),
        ] {
            let file = folder.join(format!("{name}_bg.wasm"));
            optimise(&wasm_opt, level, &file, &file)?;
        }
    }
    Ok(())
}

/// How hard wasm-opt tries with what a worker runs. Harder is slower: with -O3 flakes take a tenth longer, as numbers
/// side by side are moved about more.
pub const WORKER_LEVEL: &str = "-O1";

/// Has wasm-opt make a wasm of another.
pub fn optimise(wasm_opt: &Path, level: &str, from: &Path, to: &Path) -> Result<()> {
    let [wasm_opt, from, to] = [wasm_opt, from, to].map(Path::to_string_lossy);
    run(&mut command("node", &[&wasm_opt, &from, level, "-o", &to]))
}

/// Compiles a package to wasm and gives the file.
fn compile(package: &str, profile: &str, arguments: &[&str]) -> Result<PathBuf> {
    // Only a cdylib: with an rlib beside it, link-time optimisation is silently left out.
    let fixed = [
        "rustc",
        "--package",
        package,
        "--lib",
        "--crate-type",
        "cdylib",
        "--target",
        tools::WASM,
        "--profile",
        profile,
        "--message-format",
        "json-render-diagnostics",
    ];
    let mut command = cargo(&[&fixed, arguments].concat());
    eprintln!(
        "$ cargo rustc --package {package} --target {} --profile {profile}",
        tools::WASM
    );
    artifacts(&mut command)?
        .into_iter()
        .flat_map(|message| message["filenames"].as_array().cloned().unwrap_or_default())
        .filter_map(|file| file.as_str().map(PathBuf::from))
        .rfind(|file| {
            file.extension().is_some_and(|e| e == "wasm")
                && file.file_stem().is_some_and(|stem| stem == package)
        })
        .with_context(|| format!("cargo made no wasm of {package}"))
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
