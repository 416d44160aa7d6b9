//! The tests of the mathematics as wasm, in node and in a browser, and its pictures against those of this machine.

use super::{Chosen, Watch, passed, portable};
use crate::packages::{TESTED_AS_WASM, TESTED_IN_BROWSER};
use crate::page::NO_LINES;
use crate::shell::{artifacts, at_once, cargo, command, find, root, run_and_read, run_apart};
use crate::tools;
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A file of tests that run as wasm has one of these: the attribute, or the macro that adds it.
const MARKS: [&str; 2] = ["wasm_bindgen_test", "tests! {"];
/// Files of tests that take longest: begun first, so that no core is idle at the end.
const LONGEST: [&str; 1] = ["pins"];

/// A file of tests that is compiled to wasm.
struct Binary {
    package: &'static str,
    /// `same`, or the package's name for those in `src/`.
    name: String,
    wasm: PathBuf,
}

/// Runs this part.
pub fn check(watch: &mut Watch, chosen: &Chosen) -> Result<String> {
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    tools::wasm_target()?;
    let runner = watch.step("runner", tools::wasm_test_runner)?;
    let packages: Vec<&'static str> = TESTED_AS_WASM
        .into_iter()
        .filter(|package| chosen.has(package))
        .collect();
    if packages.is_empty() {
        bail!("the tests of {chosen:?} do not run as wasm");
    }
    let binaries = watch.step("build", || build(&packages))?;
    let outputs = watch.step("node", || run(&runner, &binaries, chosen.test()))?;
    let mut said = Vec::new();
    for package in &packages {
        let of_it = binaries.iter().zip(&outputs);
        let count = of_it
            .filter(|(binary, _)| binary.package == *package)
            .map(|(_, output)| passed(output))
            .sum::<usize>();
        // A test without the attribute of wasm-bindgen-test is silently left out.
        if count == 0 && chosen.test().is_none() {
            bail!("no test of {package} was run as wasm");
        }
        said.push(format!("{package} {count}"));
    }
    let mut said = format!("tests passed: {}", said.join(", "));
    let all = *chosen == Chosen::All;
    let in_browsers = if all {
        &TESTED_IN_BROWSER[..1]
    } else {
        &TESTED_IN_BROWSER
    };
    for package in in_browsers.iter().filter(|p| packages.contains(p)) {
        let test = || in_browser(&runner, &binaries, package, chosen.test());
        said += &match watch.step("browser", test)? {
            Some(count) => format!(", {package} in a browser {count}"),
            None => String::from(", none in a browser, as there is no chromedriver"),
        };
    }
    if packages.contains(&"worker") && chosen.test().is_none() {
        let wasm: Vec<String> = outputs.iter().flat_map(|o| pictures(o)).collect();
        let count = watch.step("same", || same(&wasm))?;
        said += &format!(
            "; {count} pictures and scenes equal to those of this machine and of any of its kind"
        );
    }
    Ok(said)
}

/// Compiles what is run as wasm of some packages.
fn build(packages: &[&'static str]) -> Result<Vec<Binary>> {
    let mut test = cargo(&[
        "test",
        "--no-run",
        "--target",
        tools::WASM,
        "--message-format",
        "json-render-diagnostics",
    ]);
    // Each is said once, whichever packages it is for.
    let mut options = BTreeSet::new();
    let mut wanted = 0;
    for package in packages {
        test.args(["--package", package]);
        let folder = root().join("crate").join(package);
        if mentions(&folder.join("src"))? {
            options.insert(String::from("--lib"));
            wanted += 1;
        }
        for file in fs::read_dir(folder.join("tests"))? {
            let path = file?.path();
            let main = if path.is_dir() {
                path.join("main.rs")
            } else {
                path.clone()
            };
            // Of a folder without `main.rs` others have parts.
            if main.is_file() && mentions(&path)? {
                let name = path.file_stem().context("a test has a name")?;
                options.insert(format!("--test={}", name.to_string_lossy()));
                wanted += 1;
            }
        }
    }
    test.args(options);
    let made = artifacts(test.env(NO_LINES.0, NO_LINES.1))?;
    let mut binaries = Vec::new();
    for made in made.iter().filter(|made| made["profile"]["test"] == true) {
        let text = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_owned();
        let manifest = text(&made["manifest_path"]);
        let folder = Path::new(&manifest).parent().and_then(Path::file_name);
        let package = packages
            .iter()
            .find(|package| folder.is_some_and(|folder| folder == **package));
        if let (Some(package), Some(wasm)) = (package, made["executable"].as_str()) {
            binaries.push(Binary {
                package,
                name: text(&made["target"]["name"]),
                wasm: wasm.into(),
            });
        }
    }
    if binaries.len() < wanted {
        bail!(
            "{} of {wanted} files of tests were compiled",
            binaries.len()
        );
    }
    let rank = |binary: &Binary| LONGEST.iter().position(|name| *name == binary.name);
    binaries.sort_by_key(|binary| rank(binary).unwrap_or(LONGEST.len()));
    Ok(binaries)
}

/// Whether a file, or one in a folder, has tests that run as wasm.
fn mentions(path: &Path) -> Result<bool> {
    if !path.is_dir() {
        let text = fs::read(path)?;
        let text = String::from_utf8_lossy(&text);
        return Ok(MARKS.iter().any(|mark| text.contains(mark)));
    }
    for entry in fs::read_dir(path)? {
        if mentions(&entry?.path())? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Runs them in node, as many at a time as there are cores, and gives what they write.
fn run(runner: &Path, binaries: &[Binary], filter: Option<&str>) -> Result<Vec<String>> {
    let work = |binary| move || run_one(runner, binary, filter, &[]);
    at_once(binaries.iter().map(work).collect())
        .into_iter()
        .collect()
}

fn run_one(
    runner: &Path,
    binary: &Binary,
    filter: Option<&str>,
    settings: &[(&str, &str)],
) -> Result<String> {
    run_apart(
        tools::in_node(runner, &binary.wasm)
            .arg("--nocapture")
            .args(filter)
            .current_dir(root().join("crate").join(binary.package))
            .envs(settings.iter().copied()),
    )
    .with_context(|| format!("{} of {}", binary.name, binary.package))
}

/// Runs one package's tests in a browser's worker and gives how many there are; none without a chromedriver.
fn in_browser(
    runner: &Path,
    binaries: &[Binary],
    package: &str,
    filter: Option<&str>,
) -> Result<Option<usize>> {
    // It is installed with the browser.
    tools::chromium()?;
    let Some(driver) = find("chromedriver") else {
        return Ok(None);
    };
    let driver = driver.to_string_lossy();
    let settings = [(tools::IN_WORKER, "1"), ("CHROMEDRIVER", &driver)];
    let mut count = 0;
    for binary in binaries {
        if binary.package == package {
            count += passed(&run_one(runner, binary, filter, &settings)?);
        }
    }
    if count == 0 && filter.is_none() {
        bail!("no test of {package} was run in a browser");
    }
    Ok(Some(count))
}

/// Compares what is told of pictures as wasm with what is told of them on this machine, once built for its processor and once for
/// any of its kind, and gives how many there are.
fn same(wasm: &[String]) -> Result<usize> {
    // The whole workspace, as then nothing is built anew that the tests on this machine have built.
    let options = [
        "test",
        "--workspace",
        "--test",
        portable::SAME,
        "--",
        "--nocapture",
    ];
    let native = pictures(&run_and_read(&mut cargo(&options))?);
    let count = compare(wasm, &native)?;
    let portable = portable::build()?.same;
    let package = root().join("crate/worker");
    let output = run_and_read(command(portable, &["--nocapture"]).current_dir(package))?;
    compare(wasm, &pictures(&output)).context("built for any processor of this kind")?;
    Ok(count)
}

/// The lines `picture …` of `crate/worker/tests/it/same.rs`. What is run in node is written with spaces before it.
fn pictures(output: &str) -> Vec<String> {
    output
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with("picture "))
        .map(str::to_owned)
        .collect()
}

/// Compares what is told of pictures as wasm with what is told of them natively, and gives how many
/// there are.
fn compare(wasm: &[String], native: &[String]) -> Result<usize> {
    if let Some((wasm, native)) = wasm.iter().zip(native).find(|(a, b)| a != b) {
        bail!("pictures differ:\n  as wasm  {wasm}\n  natively {native}");
    }
    if wasm.is_empty() || wasm.len() != native.len() {
        let (as_wasm, natively) = (wasm.len(), native.len());
        bail!("{as_wasm} pictures were told of as wasm, {natively} natively");
    }
    Ok(native.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_that_differ_or_are_missing_are_found() {
        let wasm = ["picture a Full 1", "picture b Full 2"].map(str::to_owned);
        let count = |native: &str| compare(&wasm, &pictures(native)).ok();
        let same = "running 1 test\n picture a Full 1\n    picture b Full 2\n";
        assert_eq!(count(same), Some(2));
        assert_eq!(count(&same.replace("Full 2", "Full 3")), None);
        assert_eq!(count("picture a Full 1"), None);
        assert!(compare(&[], &[]).is_err());
    }
}
