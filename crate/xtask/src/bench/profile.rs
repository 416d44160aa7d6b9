//! Where the time goes: counts of work, the functions that the processor was seen in.

use super::goal::short;
use super::scenes::Scenes;
use super::{Piece, fields, ours};
use crate::shell::{command, find, read};
use anyhow::Result;
use std::fmt::Write;
use std::path::Path;
use std::process::Stdio;

/// The scenes that are looked into, with kernel and kind of most of their primitives.
const SCENES: [(&str, [&str; 2]); 7] = [
    ("flake-10", ["gauss", "point"]),
    ("flake-820", ["gauss", "point"]),
    ("flake-7381", ["gauss", "point"]),
    ("flake-820-cauchy", ["cauchy", "point"]),
    ("coral", ["gauss", "segment"]),
    ("seahorse", ["cauchy", "arc"]),
    ("tee", ["cauchy", "segment"]),
];
/// Functions in which less of the time was spent are not listed, percent.
const LEAST: f64 = 2.0;

/// Counts and samples.
pub fn measure() -> Result<Piece> {
    let scenes = Scenes::new()?;
    let mut page = String::from(
        "Counts of work for a ray from the eye, one ray a pixel, and what they come to. The last columns say what the evaluations would \
         take if each took as long as one with its gradient in the part *Fields*, and which share of the time that is: where it is \
         large, evaluating is what bounds the tracer; where it is small, it is what saves evaluations (bounds, lists, steps and \
         their proofs), roots, and colours.\n\n",
    );
    counts(&scenes, &mut page)?;
    if find("perf").is_some() {
        sampled(&scenes, &mut page)?;
    } else {
        page += "Not sampled: `perf` is not installed.\n\n";
    }
    Ok((Vec::new(), page))
}

fn counts(scenes: &Scenes, page: &mut String) -> Result<()> {
    let alone = fields::nanoseconds(&SCENES.map(|(_, cell)| cell))?;
    for (i, ((scene, _), alone)) in SCENES.iter().zip(alone).enumerate() {
        let cost = ours::time(&scenes.sinew, &[&scenes.dataset(scene)])?;
        let counts: Vec<&(String, f64)> = cost
            .counts
            .iter()
            .filter(|(name, _)| name != "primary rays" && name != "shadow rays")
            .collect();
        if i == 0 {
            let names: Vec<&str> = counts.iter().map(|(name, _)| name.as_str()).collect();
            writeln!(
                page,
                "| scene | ns a ray | {} | ns a field evaluation | evaluating alone, ns a ray | share |\n\
                 |---|--:|{}--:|--:|--:|",
                names.join(" | "),
                "--:|".repeat(names.len())
            )?;
        }
        let nanoseconds = |count: f64| 1e9 * cost.seconds / count;
        let cells: Vec<String> = counts
            .iter()
            .map(|(_, count)| short(count / cost.rays))
            .collect();
        let evaluations = counts
            .iter()
            .find(|(name, _)| name == "field evaluations")
            .map_or(f64::NAN, |(_, count)| *count);
        writeln!(
            page,
            "| {scene} | {} | {} | {} | {} |",
            short(nanoseconds(cost.rays)),
            cells.join(" | "),
            short(nanoseconds(evaluations)),
            alone.map_or("– | –".into(), |alone| {
                let share = 100.0 * alone / nanoseconds(evaluations);
                format!("{} | {share:.0} %", short(alone * evaluations / cost.rays))
            })
        )?;
    }
    page.push('\n');
    Ok(())
}

fn sampled(scenes: &Scenes, page: &mut String) -> Result<()> {
    writeln!(
        page,
        "Functions in which `perf record` saw the processor, with what is inlined into them; those over {LEAST} %.\n\n\
         | scene | share of the time |\n|---|---|"
    )?;
    for (scene, _) in SCENES {
        let data = scenes.path("perf.data");
        let functions = sample(&scenes.sinew, &scenes.dataset(scene), &data);
        let listed: Vec<String> = functions
            .iter()
            .map(|(share, name)| format!("{share:.0} % `{name}`"))
            .collect();
        writeln!(page, "| {scene} | {} |", listed.join(", "))?;
    }
    page.push('\n');
    Ok(())
}

/// Percents and functions; none if this machine does not let itself be sampled.
fn sample(sinew: &Path, dataset: &str, data: &Path) -> Vec<(f64, String)> {
    let (sinew, data) = (sinew.to_string_lossy(), data.to_string_lossy());
    let record = [
        "record", "-q", "-F", "1999", "-o", &data, &sinew, "time", dataset,
    ];
    let recorded = command("perf", &record)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    if !recorded.is_ok_and(|status| status.success()) {
        return Vec::new();
    }
    let report = ["report", "-i", &data, "--stdio", "-F", "overhead,sym"];
    read(&mut command("perf", &report))
        .unwrap_or_default()
        .lines()
        .filter_map(function)
        .filter(|(share, _)| *share >= LEAST)
        .collect()
}

/// A line `23.15%  [.] tracer::slabs::Slabs::add`.
fn function(line: &str) -> Option<(f64, String)> {
    let (share, rest) = line.trim().split_once('%')?;
    let (_, name) = rest.trim().split_once(' ')?;
    Some((share.parse().ok()?, name.trim().to_owned()))
}

#[cfg(test)]
mod tests {
    #[test]
    fn functions_are_read_from_a_report() {
        assert_eq!(
            super::function("    23.15%  [.] tracer::slabs::Slabs::add  "),
            Some((23.15, String::from("tracer::slabs::Slabs::add")))
        );
        assert_eq!(
            super::function("# Samples: 501  of event 'cpu-clock'"),
            None
        );
    }
}
