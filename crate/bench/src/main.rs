//! `cargo xtask bench`: measures, and writes BENCHMARKS.md. Nothing in that file is written by
//! hand.
//!
//! Each module measures one thing; the words and the heads of its tables stand in `page/`, with
//! marks `{…}` for what is measured. What cannot be measured here, as a program is missing, says so
//! in its place. Each part is kept in `tests/bench/measured/`, so that parts can be measured one by
//! one.

mod browser;
mod certify;
mod fields;
mod fit;
mod fused;
mod growth;
mod limbs;
mod memory;
mod meshes;
mod mirrors;
mod models;
mod povray;
mod profile;
mod programs;
mod report;
mod sculpt;
mod series;
mod sinew;
mod speed;
mod wasm;

use anyhow::{Context, Result, bail};
use report::Report;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::PathBuf;
use std::process::{Command, ExitCode};
use xtask::shell::{command, find, read, root};

/// A part of the measurements: its name, its text with marks, and what measures it.
type Part = (&'static str, &'static str, fn() -> Result<Report>);

macro_rules! part {
    ($name:ident) => {{
        let text = include_str!(concat!("../page/", stringify!($name), ".md"));
        (stringify!($name), text, $name::measure)
    }};
}

const PARTS: [Part; 15] = [
    part!(speed),
    part!(models),
    part!(mirrors),
    part!(fused),
    part!(wasm),
    part!(browser),
    part!(certify),
    part!(profile),
    part!(growth),
    part!(memory),
    part!(limbs),
    part!(fields),
    part!(fit),
    part!(meshes),
    part!(sculpt),
];

/// Head of the page.
const HEAD: &str = include_str!("../page/head.md");

/// A part as it is kept.
#[derive(Serialize, Deserialize)]
struct Kept {
    rows: Vec<String>,
    text: String,
    with: String,
}

fn main() -> ExitCode {
    let named: Vec<String> = std::env::args().skip(1).collect();
    xtask::end(bench(&named))
}

/// Measures everything, or the parts that are named, and writes the file: of parts not measured now
/// what was measured last.
fn bench(named: &[String]) -> Result<()> {
    let names = PARTS.map(|(name, ..)| name);
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    if let Some(unknown) = named.iter().find(|named| !names.contains(&named.as_str())) {
        bail!(
            "There is no part {unknown}. The parts: {}.",
            names.join(", ")
        );
    }
    let (mut goals, mut pieces) = (Vec::new(), String::new());
    for (name, text, measure) in PARTS {
        let wanted = named.is_empty() || named.iter().any(|named| named == name);
        if wanted && let Err(error) = measure().and_then(|report| keep(name, text, report)) {
            // Earlier measurements stay.
            eprintln!("{name}: {error:#}");
        }
        let title = text.trim_start_matches("## ").split([':', '\n']).next();
        let title = title.unwrap_or(name);
        let kept = fs::read_to_string(path(name)).ok();
        let kept: Option<Kept> = kept.and_then(|kept| serde_json::from_str(&kept).ok());
        if let Some(Kept { rows, text, with }) = kept {
            goals.extend(rows);
            pieces += &format!("{text}\n\n*{title}*: {with}.\n\n");
        } else {
            pieces += &format!("## {title}\n\nNot measured: run `cargo xtask bench {name}`.\n\n");
        }
    }
    let page = format!("{HEAD}{}\n{}\n", goals.concat(), pieces.trim_end());
    fs::write(root().join("BENCHMARKS.md"), page).context("BENCHMARKS.md cannot be written")?;
    println!("wrote BENCHMARKS.md");
    Ok(())
}

/// Returns the file that keeps the figures of a part.
fn path(name: &str) -> PathBuf {
    root().join(format!("tests/bench/measured/{name}.json"))
}

/// Keeps a part.
fn keep(name: &str, text: &str, report: Report) -> Result<()> {
    let text = report.fill(text)?;
    let commit = read(&mut command("git", &["rev-parse", "--short", "HEAD"]));
    let commit = commit.unwrap_or("unknown".into());
    let with = format!("{}; commit {commit}", versions());
    let rows = report.goals.into_iter().map(|row| row + "\n").collect();
    let kept = serde_json::to_string_pretty(&Kept { rows, text, with })?;
    fs::create_dir_all(path("").with_file_name(""))?;
    Ok(fs::write(path(name), kept + "\n")?)
}

/// Description of the machine and the tools.
fn versions() -> String {
    let [rustc, node] = ["rustc", "node"]
        .map(|program| read(Command::new(program).arg("--version")).unwrap_or_default());
    let mut versions = vec![rustc, format!("node {node}")];
    versions.extend(povray::version());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let known = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = known.lines();
    let name = lines.find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let name = name.map_or("unknown processor", |(_, name)| name.trim());
    let [system, kind] = [std::env::consts::OS, std::env::consts::ARCH];
    versions.push(format!("{system} {kind}, {name}, {cores} cores"));
    versions.join("; ")
}
