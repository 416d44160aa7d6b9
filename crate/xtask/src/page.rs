//! Building the page: packages of wasm, and the files of `www/`.

use crate::offline;
use crate::packages::{MODULES, Module};
use crate::shell::{at_once, cargo, command, in_lane, messages, root, run, target, tell};
use crate::tools;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Instant;
use wasm_bindgen_cli_support::Bindgen;

/// A way of building the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// Builds quickly, and runs as fast as a release where a visitor waits: for pictures and
    /// meshes.
    Development,
    /// Runs fast and is small, with each module optimised as a whole.
    Release,
}

/// Builds the page into a folder, which is emptied first.
pub fn build(build: Build, folder: &Path) -> Result<()> {
    tools::target(tools::WASM)?;
    let modules = modules();
    tell("Building the page: some minutes the first time, later only as long as changes take.");
    // For a release each has a folder of its own to build in, and is optimised by one core; else
    // they share what is compiled.
    let work = MODULES.map(|module| {
        let modules = &modules;
        move || in_lane(module.name, || make(&module, build, modules))
    });
    at_once(work.into()).into_iter().collect::<Result<()>>()?;
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("{} is in use", folder.display()))?;
    }
    copy(&root().join("www"), folder)?;
    copy(&root().join("index.html"), &folder.join("index.html"))?;
    for module in MODULES {
        copy_module(&module, &modules, folder)?;
    }
    for font in FONTS {
        copy(&modules.join(font), &folder.join(font))?;
    }
    if build == Build::Release {
        offline::list(folder)?;
    }
    Ok(())
}

/// Returns the folder in which modules are made.
pub fn modules() -> PathBuf {
    target().join("modules")
}

/// Makes NAME.js and NAME_bg.wasm.
pub fn make(module: &Module, build: Build, folder: &Path) -> Result<()> {
    let begun = Instant::now();
    fs::create_dir_all(folder)?;
    let profile = match build {
        Build::Development => "serve",
        Build::Release => module.profile,
    };
    let wasm = compile(module, profile, folder)?;
    tell(&format!("compiled ({} s)", begun.elapsed().as_secs()));
    Bindgen::new()
        .input_path(&wasm)
        .web(true)?
        .typescript(false)
        // The script looks for its wasm beside itself.
        .omit_default_module_path(false)
        .out_name(module.name)
        .generate(folder)
        .with_context(|| format!("wasm-bindgen could not read {}", wasm.display()))?;
    // It may have to be installed first.
    static WASM_OPT: LazyLock<Option<PathBuf>> = LazyLock::new(tools::wasm_opt);
    if (build == Build::Release || module.package != "studio")
        && let Some(wasm_opt) = &*WASM_OPT
    {
        let file = folder.join(format!("{}_bg.wasm", module.name));
        optimise(wasm_opt, &file, &file)?;
    }
    tell(&format!("built ({} s)", begun.elapsed().as_secs()));
    Ok(())
}

/// Copies what [`make`] has made of a module.
pub fn copy_module(module: &Module, from: &Path, to: &Path) -> Result<()> {
    for ending in [".js", "_bg.wasm"] {
        let file = format!("{}{ending}", module.name);
        copy(&from.join(&file), &to.join(&file))?;
    }
    Ok(())
}

/// The level of wasm-opt. Higher ones make workers slower: with -O3 flakes take a tenth longer, as
/// numbers side by side are moved about more. The app is no smaller after brotli with -Oz.
const LEVEL: &str = "-O1";

/// Optimises a wasm file with wasm-opt.
pub fn optimise(wasm_opt: &Path, from: &Path, to: &Path) -> Result<()> {
    let [wasm_opt, from, to] = [wasm_opt, from, to].map(Path::to_string_lossy);
    // Without the sections for tools: who made the file, and what it needs.
    let stripped = ["--strip-producers", "--strip-target-features"];
    run(command("node", &[&wasm_opt, &from, LEVEL, "-o", &to]).args(stripped))
}

/// The fonts, which the build script of `widgets` makes and the page fetches.
const FONTS: [&str; 2] = ["sans.ttf", "mono.ttf"];

/// Compiles a package to wasm and returns the file. The fonts, if it has some, are copied to a
/// folder.
fn compile(module: &Module, profile: &str, folder: &Path) -> Result<PathBuf> {
    // Only a cdylib: with an rlib beside it, link-time optimisation is silently left out.
    let Module {
        package, features, ..
    } = module;
    let mut command = cargo(&[
        "rustc",
        "--lib",
        "--crate-type=cdylib",
        "--message-format=json-render-diagnostics",
    ]);
    command.args(["--target", tools::WASM, "--profile", profile]);
    command.args(["--package", package, "--features", features]);
    let messages = messages(&mut command)?;
    for message in &messages {
        let package = message["package_id"].as_str();
        if message["reason"] == "build-script-executed"
            && package.is_some_and(|id| id.contains("/widgets#"))
            && let Some(made) = message["out_dir"].as_str()
        {
            for font in FONTS {
                copy(&Path::new(made).join(font), &folder.join(font))?;
            }
        }
    }
    let artifacts = messages.iter();
    artifacts
        .filter(|message| message["reason"] == "compiler-artifact")
        .filter(|artifact| artifact["target"]["name"] == *package)
        .filter_map(|artifact| Some(PathBuf::from(artifact["filenames"][0].as_str()?)))
        .rfind(|file| {
            file.extension()
                .is_some_and(|extension| extension == "wasm")
        })
        .with_context(|| format!("cargo made no wasm of {package}"))
}

/// Copies a file, or the contents of a folder.
pub fn copy(from: &Path, to: &Path) -> Result<()> {
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

/// Returns the folder in which `serve` builds the page.
pub fn serve_folder() -> PathBuf {
    target().join("page")
}
