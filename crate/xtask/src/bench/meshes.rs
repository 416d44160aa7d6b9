//! Meshes against `LevelSet` of manifold-rust: what `crate/mesher/examples/peers.rs` prints.

use super::Piece;
use super::goal::{Goal, Wanted, short};
use crate::shell::{cargo, run_and_read};
use anyhow::{Context, Result};
use serde_json::Value;
use std::fmt::Write;

const SCENES: [&str; 3] = ["seahorse", "coral", "flake-820"];
/// How many times as fast, and at most which share of the triangles.
const FASTER: f64 = 5.0;
const FEWER: f64 = 1.0 / 3.0;

/// Measures.
pub fn measure() -> Result<Piece> {
    let files: Vec<String> = SCENES
        .iter()
        .map(|name| format!("tests/bench/{name}.rat"))
        .collect();
    let mut options = vec![
        "run",
        "--release",
        "--package",
        "mesher",
        "--example",
        "peers",
        "--",
    ];
    options.extend(files.iter().map(String::as_str));
    let output = run_and_read(&mut cargo(&options))?;
    let mut page = String::from(
        "One thread, a tolerance of a thousandth of the box's diagonal. The other is `LevelSet` of manifold-rust with the same \
         field, evaluated by what matters in each cell of a grid, with the edge length at which its measured error is ours. Errors \
         are the largest distances found, either way.\n\n\
         | scene | s | triangles | proved error | measured | LevelSet: s | triangles | measured |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    let mut goals = Vec::new();
    for line in output.lines().filter(|line| line.starts_with('{')) {
        let row: Value = serde_json::from_str(line)?;
        let number = |key: &str| {
            row[key]
                .as_f64()
                .with_context(|| format!("no {key} in {line}"))
        };
        let name = row["scene"].as_str().unwrap_or_default();
        let (seconds, theirs) = (number("seconds")?, number("peer_seconds")?);
        let (count, their_count) = (number("triangles")?, number("peer_triangles")?);
        writeln!(
            page,
            "| {name} | {} | {count} | {:.1e} | {:.1e} | {} | {their_count} | {:.1e} |",
            short(seconds),
            number("proved")?,
            number("error")?,
            short(theirs),
            number("peer_error")?,
        )?;
        let against = || String::from("LevelSet at equal measured error");
        goals.push(Goal {
            what: format!("mesh of {name}, speed"),
            against: against(),
            wanted: Wanted::AtLeast(FASTER),
            unit: "×",
            measured: Ok(theirs / seconds),
        });
        goals.push(Goal {
            what: format!("mesh of {name}, triangles"),
            against: against(),
            wanted: Wanted::AtMost(FEWER),
            unit: "×",
            measured: Ok(count / their_count),
        });
    }
    Ok((goals, page + "\n"))
}
