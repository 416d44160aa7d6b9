//! `cargo xtask bench`: measures, and writes BENCHMARKS.md. Nothing in that file is written by hand.
//!
//! Each module measures one thing and gives a piece of the page, and [`Goal`]s: the rows of the table
//! at its top. What cannot be measured here, as a program is missing, says so in its place.

mod browser;
mod certify;
mod fields;
mod goal;
mod models;
mod ours;
mod peers;
mod povray;
mod profile;
mod scenes;
mod series;
mod wasm;

use crate::shell::{find, read, root};
use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use goal::Goal;
use std::process::Command;

/// A part of the measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// The tracer against other programs, and with more elements, samples and other root finders.
    Speed,
    /// Soft against hard models.
    Models,
    /// The tracer as wasm against native.
    Wasm,
    /// The page in a real browser.
    Browser,
    /// Pictures against a certified reference.
    Certify,
    /// Where the time goes, and the memory.
    Profile,
    /// The formulas of the fields.
    Fields,
}

/// What a part came to: the rows it adds to the table of goals, and its piece of the page.
type Piece = (Vec<Goal>, String);

/// Measures everything and writes the file; or measures one part and prints what it came to.
pub fn bench(part: Option<Part>) -> Result<()> {
    if find("node").is_none() {
        bail!("Node.js is missing. Install Node.js 20 or newer (https://nodejs.org).");
    }
    let parts = part.map_or_else(|| Part::value_variants().to_vec(), |part| vec![part]);
    let mut goals = Vec::new();
    let mut pieces = String::new();
    for part in parts {
        let (title, result) = measure(part);
        // The fields' tables have headings of their own.
        if part != Part::Fields {
            pieces += &format!("## {title}\n\n");
        }
        match result {
            Ok((rows, piece)) => {
                goals.extend(rows);
                pieces += &piece;
            }
            Err(error) => {
                eprintln!("{title}: {error:#}");
                pieces += &format!("Not measured: {error:#}.\n\n");
            }
        }
    }
    let page = format!("{}{}{pieces}", head(), goal::table(&goals));
    let page = page.trim_end().to_owned() + "\n";
    if part.is_some() {
        println!("\n{page}");
        return Ok(());
    }
    let path = root().join("BENCHMARKS.md");
    std::fs::write(&path, page).context("BENCHMARKS.md cannot be written")?;
    println!("wrote {}", path.display());
    Ok(())
}

fn measure(part: Part) -> (&'static str, Result<Piece>) {
    match part {
        Part::Speed => ("The tracer, one thread", peers::measure()),
        Part::Models => ("Soft and hard models", models::measure()),
        Part::Wasm => ("The tracer as wasm", wasm::measure()),
        Part::Browser => ("The page in a browser", browser::measure()),
        Part::Certify => ("Certified", certify::measure()),
        Part::Profile => ("Where the time goes", profile::measure()),
        Part::Fields => ("Fields", fields::measure().map(|piece| (Vec::new(), piece))),
    }
}

/// What was measured with what.
fn head() -> String {
    let version = |program: &str| read(Command::new(program).arg("--version")).unwrap_or_default();
    let mut versions = vec![version("rustc"), format!("node {}", version("node"))];
    versions.extend(povray::version());
    versions.push(format!(
        "{} {}, {}",
        std::env::consts::OS,
        std::env::consts::ARCH,
        processor()
    ));
    format!(
        "# Benchmarks\n\nWritten by `cargo xtask bench`, which makes all figures anew; none is written by \
         hand. Absolute figures are those of one machine and drift with what else it does: compare \
         ratios within a table. {}.\n\n",
        versions.join("; ")
    )
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
