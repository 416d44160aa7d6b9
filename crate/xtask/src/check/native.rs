//! The tests of all crates, on this machine.

use super::{Chosen, Watch, passed, portable};
use crate::shell::{artifacts, at_once, cargo, command, run, run_and_read, run_apart};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Tests that take longest: begun first, so that no core is idle at the end.
const LONGEST: [&str; 8] = [
    "taper of field",
    "certified of tracer",
    "assist of assist",
    "pins of worker",
    "picture of tracer",
    "nearly_right of assist",
    "chart of field",
    "tracer of tracer",
];

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    let outputs = if *chosen == Chosen::All {
        let tests = watch.step("build", compiled)?;
        watch.step("run", || run_all(tests))?
    } else {
        let packages = chosen.packages();
        let mut test = vec!["test"];
        test.extend(&packages);
        watch.step("build", || run(cargo(&test).arg("--no-run")))?;
        let filter = chosen.test().map(|name| ["--", name]);
        vec![watch.step("run", || {
            run_and_read(cargo(&test).args(filter.into_iter().flatten()))
        })?]
    };
    match outputs.iter().map(|output| passed(output)).sum() {
        0 => bail!("no test was run"),
        count => Ok(format!("{count} tests passed")),
    }
}

/// A file of tests, or the tests in `src/` of a package.
struct Tests {
    /// `chart of field`.
    name: String,
    program: PathBuf,
    /// The folder of the package, where they are run.
    folder: PathBuf,
}

/// Compiles all tests, and gives them without [`portable::SAME`], which the part `wasm` runs.
fn compiled() -> Result<Vec<Tests>> {
    let message = ["--message-format", "json-render-diagnostics"];
    let all = ["test", "--no-run", "--workspace"];
    let mut tests = Vec::new();
    for made in artifacts(cargo(&all).args(message))? {
        let (manifest, file) = (&made["manifest_path"], &made["target"]["name"]);
        let (Some(program), Some(manifest), Some(file)) = (
            made["executable"].as_str(),
            manifest.as_str(),
            file.as_str(),
        ) else {
            continue;
        };
        if made["profile"]["test"] != true || file == portable::SAME {
            continue;
        }
        let folder = Path::new(manifest)
            .parent()
            .context("a package has a folder")?;
        let package = folder.file_name().unwrap_or_default().to_string_lossy();
        tests.push(Tests {
            name: format!("{file} of {package}"),
            program: program.into(),
            folder: folder.to_owned(),
        });
    }
    let rank = |tests: &Tests| LONGEST.iter().position(|name| *name == tests.name);
    tests.sort_by_key(|tests| rank(tests).unwrap_or(LONGEST.len()));
    Ok(tests)
}

/// Runs tests, as many files at a time as there are cores, and the examples of all documentation, and gives what they write.
/// One that fails does not keep the others from being run.
fn run_all(tests: Vec<Tests>) -> Result<Vec<String>> {
    let documentation = (
        String::from("documentation"),
        cargo(&["test", "--doc", "--workspace"]),
    );
    let tests = tests.into_iter().map(|tests| {
        let mut program = command(&tests.program, &[]);
        program.current_dir(&tests.folder);
        (tests.name, program)
    });
    let work = |(name, mut command): (String, Command)| {
        move || run_apart(&mut command).with_context(|| name)
    };
    let done = at_once([documentation].into_iter().chain(tests).map(work).collect());
    let failed: Vec<String> = done
        .iter()
        .filter_map(|done| Some(format!("{:#}", done.as_ref().err()?)))
        .collect();
    if !failed.is_empty() {
        bail!("{}", failed.join("; "));
    }
    done.into_iter().collect()
}
