//! `cargo xtask bench`: measures, and writes BENCHMARKS.md. Nothing in that file is written by hand.
//!
//! Each module measures one thing and gives a piece of the page, and rows of the table of goals at its top. What cannot be
//! measured here, as a program is missing, says so in its place. Each part is kept in `tests/bench/measured/`, so that parts
//! can be measured one by one.

mod browser;
mod certify;
mod fields;
mod fit;
mod fused;
mod growth;
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

/// A part of the measurements: its name, its title, its text with marks, and what measures it.
type Part = (
    &'static str,
    &'static str,
    &'static str,
    fn() -> Result<Report>,
);

macro_rules! parts {
    ($($name:ident: $title:literal,)*) => {
        [$((
            stringify!($name),
            $title,
            include_str!(concat!("../page/", stringify!($name), ".md")),
            $name::measure,
        ),)*]
    };
}

const PARTS: [Part; 14] = parts! {
    speed: "The tracer, one thread",
    models: "Soft and hard models",
    mirrors: "Mirrors and glass",
    fused: "With fused multiply-adds",
    wasm: "The tracer as wasm",
    browser: "The page in a browser",
    certify: "Certified",
    profile: "Where the time goes",
    growth: "Fields without end",
    memory: "Memory",
    fields: "Fields",
    fit: "Fitted meshes",
    meshes: "Meshes",
    sculpt: "Sculpting",
};

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
    if let Err(error) = bench(&named) {
        eprintln!("\nbench: {error:#}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

/// Measures everything, or the named parts, and writes the file: of parts not measured now what was measured last.
fn bench(named: &[String]) -> Result<()> {
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    let names = PARTS.map(|(name, ..)| name);
    if let Some(unknown) = named.iter().find(|name| !names.contains(&name.as_str())) {
        bail!(
            "There is no part {unknown}. The parts: {}.",
            names.join(", ")
        );
    }
    for (name, title, text, measure) in PARTS {
        if !named.is_empty() && !named.iter().any(|named| named == name) {
            continue;
        }
        match measure() {
            Ok(report) => keep(name, text, report)?,
            // Earlier measurements stay.
            Err(error) => eprintln!("{title}: {error:#}"),
        }
    }
    let (mut goals, mut pieces) = (Vec::new(), String::new());
    for (name, title, ..) in PARTS {
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
    let path = root().join("BENCHMARKS.md");
    fs::write(&path, page).context("BENCHMARKS.md cannot be written")?;
    println!("wrote {}", path.display());
    Ok(())
}

/// Where a part is kept that was measured.
fn path(name: &str) -> PathBuf {
    root().join(format!("tests/bench/measured/{name}.json"))
}

/// Keeps a part.
fn keep(name: &str, text: &str, report: Report) -> Result<()> {
    let text = report.fill(text)?;
    let commit = read(&mut command("git", &["rev-parse", "--short", "HEAD"]));
    let with = format!(
        "{}; commit {}",
        versions(),
        commit.unwrap_or("unknown".into())
    );
    let rows = report.goals.into_iter().map(|row| row + "\n").collect();
    let kept = serde_json::to_string_pretty(&Kept { rows, text, with })?;
    fs::create_dir_all(path("").with_file_name(""))?;
    Ok(fs::write(path(name), kept + "\n")?)
}

/// Description of the machine and the tools.
fn versions() -> String {
    let version = |program: &str| read(Command::new(program).arg("--version")).unwrap_or_default();
    let mut versions = vec![version("rustc"), format!("node {}", version("node"))];
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
