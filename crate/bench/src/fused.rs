//! The program with fused multiply-adds, an option that no picture of ours is drawn with: how much
//! sooner it is done, by how much its pictures differ, and whether they are as near to the true
//! surface.

use crate::certify::certify;
use crate::report::Report;
use crate::series::in_turn;
use crate::sinew::{SCENES, Sinew, time};
use anyhow::{Context, Result, bail};
use std::path::Path;
use xtask::pictures;
use xtask::shell::{FUSED, command, run};

/// Rounds of both in turn.
const ROUNDS: usize = 5;
/// The number of rays that are held to the reference.
const RAYS: &str = "100000";

/// Measures all of it.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let fused = pictures::sinew(Some(FUSED))?;
    let mut report = Report::default();
    report.set("flags", FUSED.flags);
    report.set("rounds", ROUNDS);
    report.set("rays", RAYS);
    let programs = [&*sinew.program, &*fused];
    for (scene, ..) in SCENES {
        let dataset = sinew.dataset(scene);
        let [ours, theirs] = in_turn(ROUNDS, |i| Ok(time(programs[i], &[&dataset])?.seconds))?;
        let [ours_drawn, theirs_drawn] = [0, 1].map(|i| {
            let picture = sinew.path(&format!("{scene}-{i}.png"));
            let render = ["render", &dataset, "-o", &picture, "-r", "512", "512"];
            run(&mut command(programs[i], &render))?;
            let read = pictures::read_picture(Path::new(&picture));
            Ok::<_, anyhow::Error>(read.context(picture)?.1)
        });
        let (pixels, most) = difference(&ours_drawn?, &theirs_drawn?)?;
        let ratio = ours.over(&theirs);
        let differ = format!("{pixels} | {most}");
        report.row(
            "scenes",
            format!("{scene} | {ours} | {theirs} | {ratio} | {differ}"),
        );
    }
    let (_, output) = certify(RAYS, Some(FUSED))?;
    let table: Vec<&str> = output
        .lines()
        .filter(|line| line.starts_with('|'))
        .collect();
    let [heading, rule, .., all] = table[..] else {
        bail!("the certifier wrote no table");
    };
    report.set("certified", [heading, rule, all].join("\n"));
    Ok(report)
}

/// Counts the pixels of four bytes that differ; returns their number and the largest difference.
fn difference(a: &[u8], b: &[u8]) -> Result<(usize, u8)> {
    if a.len() != b.len() {
        bail!("the pictures are not of one size");
    }
    Ok(pictures::difference(a, b, 4))
}
