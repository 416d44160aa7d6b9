//! The tests of crates: one program for those in `src/` and one for those in `tests/it/`, native or
//! as wasm.

use super::files::File;
use crate::shell::{Build, artifacts, cargo, command, read, root};
use crate::tools;
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Files that take longest: begun first, so that no core is idle at the end.
const LONGEST: [&str; 9] = [
    "preview traced",
    "worker pins",
    "mesher sculpted",
    "mesher scenes",
    "mesher contact",
    "tracer certified",
    "field taper",
    "field chart",
    "studio lab",
];

/// A crate's tests, compiled.
pub struct Program {
    package: String,
    /// Whether they are those of `tests/it/`, a module for each subject.
    of_modules: bool,
    path: PathBuf,
}

/// Builds what the tests need that some options of `cargo test` choose, in the usual way or as
/// `build` says. Returns cargo's artifacts.
pub fn build(options: &[&str], build: Option<Build>) -> Result<Vec<serde_json::Value>> {
    let mut cargo = cargo(&[
        "test",
        "--no-run",
        "--message-format",
        "json-render-diagnostics",
    ]);
    artifacts(
        cargo
            .args(options)
            .envs(build.into_iter().flat_map(Build::settings)),
    )
}

/// Compiles the tests that some options of `cargo test` choose.
pub fn compile(options: &[&str], way: Option<Build>) -> Result<Vec<Program>> {
    build(options, way)?
        .iter()
        .filter(|artifact| {
            artifact["profile"]["test"] == true && artifact["executable"].is_string()
        })
        .map(|artifact| {
            let [manifest, path] = [&artifact["manifest_path"], &artifact["executable"]]
                .map(|text| Path::new(text.as_str().unwrap_or_default()));
            let folder = manifest.parent().and_then(Path::file_name);
            Ok(Program {
                package: folder
                    .context("a crate has a folder")?
                    .to_string_lossy()
                    .into_owned(),
                of_modules: artifact["target"]["name"] == "it",
                path: path.to_owned(),
            })
        })
        .collect()
}

/// Returns the files of some programs, the longest first, with the tests whose names contain
/// `filter`. They take `times` as many random inputs as usual.
pub fn files(programs: &[Program], filter: Option<&str>, times: &str) -> Result<Vec<File>> {
    let mut files = Vec::new();
    for program in programs {
        for (module, tests) in program.modules(filter)? {
            let mut command = program.command();
            command
                .arg("--exact")
                .args(tests)
                .env("SINEW_TRIALS", times);
            let name = format!("{} {module}", program.package);
            files.push(File { name, command });
        }
    }
    files.sort_by_key(|file| {
        let rank = LONGEST.iter().position(|name| file.name.starts_with(name));
        rank.unwrap_or(LONGEST.len())
    });
    Ok(files)
}

impl Program {
    /// Returns the command that runs all tests.
    fn command(&self) -> Command {
        let mut command = if self.is_wasm() {
            tools::in_node(&self.path)
        } else {
            command(&self.path, &[])
        };
        command.current_dir(root().join("crate").join(&self.package));
        command
    }

    fn is_wasm(&self) -> bool {
        self.path
            .extension()
            .is_some_and(|extension| extension == "wasm")
    }

    /// Returns the names of the tests of each module.
    fn modules(&self, filter: Option<&str>) -> Result<BTreeMap<String, Vec<String>>> {
        let listed = read(self.command().args(["--list", "--format", "terse"]))
            .with_context(|| format!("{} does not list its tests", self.path.display()))?;
        let mut modules = BTreeMap::<String, Vec<String>>::new();
        for name in listed
            .lines()
            .filter_map(|line| line.strip_suffix(": test"))
        {
            if filter.is_some_and(|filter| !name.contains(filter)) {
                continue;
            }
            let module = match name.split_once("::") {
                // There is one thread as wasm: tests run side by side as files of their own.
                _ if self.is_wasm() => name,
                Some((module, _)) if self.of_modules => module,
                _ => "src",
            };
            modules.entry(module.into()).or_default().push(name.into());
        }
        Ok(modules)
    }
}
