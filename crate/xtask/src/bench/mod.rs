//! `cargo xtask bench`: measures, and writes BENCHMARKS.md. Nothing in that file is written by hand.
//!
//! Each module measures one thing and gives a piece of the page, and [`Goal`]s: the rows of the table
//! at its top. What cannot be measured here, as a program is missing, says so in its place. Each part is kept in
//! `tests/bench/measured/`, so that parts can be measured one by one.

mod browser;
mod certify;
mod fields;
mod fit;
mod fused;
mod goal;
mod growth;
mod memory;
mod meshes;
mod mirrors;
mod models;
mod ours;
mod peers;
mod plot;
mod povray;
mod profile;
mod scenes;
mod sculpt;
mod series;
mod wasm;

use crate::shell::{find, read, root};
use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use goal::Goal;
use std::path::PathBuf;
use std::process::Command;

/// A part of the measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// The tracer against other programs, and with more elements, samples and other root finders.
    Speed,
    /// Soft against hard models.
    Models,
    /// Mirrors and glass against POV-Ray, and what a lens costs.
    Mirrors,
    /// The tracer with fused multiply-adds against that of pictures.
    Fused,
    /// The tracer as wasm against native.
    Wasm,
    /// The page in a real browser.
    Browser,
    /// Pictures against a certified reference.
    Certify,
    /// Where the time goes.
    Profile,
    /// Fields that never end, and how their cost grows with the number of elements.
    Growth,
    /// Memory of very many elements.
    Memory,
    /// The formulas of the fields.
    Fields,
    /// Meshes fitted to measurements.
    Fit,
    /// Meshes against another mesher.
    Meshes,
    /// A step of a sculpting tool.
    Sculpt,
}

/// Result of a part: its rows of the table of goals, and its section of the page.
type Piece = (Vec<Goal>, String);

/// Measures everything, or one part, and writes the file: of parts not measured now what was measured last.
pub fn bench(part: Option<Part>) -> Result<()> {
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    let now = part.map_or_else(|| Part::value_variants().to_vec(), |part| vec![part]);
    for part in now {
        let (title, result) = measure(part);
        // The fields' tables have headings of their own.
        let mut text = if part == Part::Fields {
            String::new()
        } else {
            format!("## {title}\n\n")
        };
        let (goals, piece) = match result {
            Ok(measured) => measured,
            Err(error) => {
                // Earlier measurements stay.
                eprintln!("{title}: {error:#}");
                continue;
            }
        };
        let rows: Vec<String> = goals.iter().map(Goal::row).collect();
        text += &piece;
        let kept = serde_json::json!({
            "rows": rows,
            "text": text.trim_end(),
            "with": format!("{}; commit {}", versions(), commit()),
        });
        let path = kept_at(part);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(path, serde_json::to_string_pretty(&kept)? + "\n")?;
    }
    let (mut rows, mut pieces) = (Vec::new(), String::new());
    for &part in Part::value_variants() {
        let kept = std::fs::read_to_string(kept_at(part)).ok();
        let kept: Option<serde_json::Value> = kept.and_then(|k| serde_json::from_str(&k).ok());
        let Some(kept) = kept else {
            let name = part
                .to_possible_value()
                .map_or(String::new(), |v| v.get_name().into());
            pieces += &format!(
                "## {}\n\nNot measured: run `cargo xtask bench {name}`.\n\n",
                title(part)
            );
            continue;
        };
        let own = kept["rows"].as_array().into_iter().flatten();
        rows.extend(own.filter_map(|row| row.as_str().map(String::from)));
        let [text, with] = ["text", "with"].map(|key| kept[key].as_str().unwrap_or_default());
        pieces += &format!("{text}\n\n*{}*: {with}.\n\n", title(part));
    }
    let page = format!("{HEAD}{}{pieces}", goal::table(&rows));
    let page = page.trim_end().to_owned() + "\n";
    let path = root().join("BENCHMARKS.md");
    std::fs::write(&path, page).context("BENCHMARKS.md cannot be written")?;
    println!("wrote {}", path.display());
    Ok(())
}

/// Where a part is kept that was measured.
fn kept_at(part: Part) -> PathBuf {
    let name = format!("tests/bench/measured/{part:?}.json").to_lowercase();
    root().join(name)
}

/// The commit that is checked out.
fn commit() -> String {
    let git = read(
        Command::new("git")
            .args(["rev-parse", "--short", "HEAD"])
            .current_dir(root()),
    );
    git.map_or("unknown".into(), |commit| commit.trim().into())
}

fn title(part: Part) -> &'static str {
    match part {
        Part::Speed => "The tracer, one thread",
        Part::Models => "Soft and hard models",
        Part::Mirrors => "Mirrors and glass",
        Part::Fused => "With fused multiply-adds",
        Part::Wasm => "The tracer as wasm",
        Part::Browser => "The page in a browser",
        Part::Certify => "Certified",
        Part::Profile => "Where the time goes",
        Part::Growth => "Fields without end",
        Part::Memory => "Memory",
        Part::Fields => "Fields",
        Part::Fit => "Fitted meshes",
        Part::Meshes => "Meshes",
        Part::Sculpt => "Sculpting",
    }
}

fn measure(part: Part) -> (&'static str, Result<Piece>) {
    let result = match part {
        Part::Speed => peers::measure(),
        Part::Models => models::measure(),
        Part::Mirrors => mirrors::measure(),
        Part::Fused => fused::measure().map(|piece| (Vec::new(), piece)),
        Part::Wasm => wasm::measure(),
        Part::Browser => browser::measure(),
        Part::Certify => certify::measure(),
        Part::Profile => profile::measure(),
        Part::Growth => growth::measure(),
        Part::Memory => memory::measure(),
        Part::Fields => fields::measure().map(|piece| (Vec::new(), piece)),
        Part::Fit => fit::measure(),
        Part::Meshes => meshes::measure(),
        Part::Sculpt => sculpt::measure(),
    };
    (title(part), result)
}

/// Head of the page.
const HEAD: &str = "# Benchmarks\n\nWritten by `cargo xtask bench`, part by part; below each part stands what it \
was measured with. No figure is written by hand. Absolute figures are those of one machine and drift with what else it \
does: compare ratios within a table.\n\n";

/// Description of the machine and the tools.
fn versions() -> String {
    let version = |program: &str| read(Command::new(program).arg("--version")).unwrap_or_default();
    let mut versions = vec![version("rustc"), format!("node {}", version("node"))];
    versions.extend(povray::version());
    versions.push(format!(
        "{} {}, {}",
        std::env::consts::OS,
        std::env::consts::ARCH,
        processor()
    ));
    versions.join("; ")
}

/// The processor's name and how many cores it lends us.
fn processor() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let known = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = known
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map_or("unknown processor", |(_, name)| name.trim());
    format!("{name}, {cores} cores")
}
