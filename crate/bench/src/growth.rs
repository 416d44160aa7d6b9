//! The cost of fields that never end: compared with fields that do, and as elements become more.

use crate::povray;
use crate::report::{Report, Short, or_dash};
use crate::series::in_turn;
use crate::sinew::Sinew;
use anyhow::Result;
use std::fs;

/// Scenes: name, title, and the goal, the greatest ratio of the cost with the Cauchy kernel to that
/// with the Gaussian.
const CASES: [(&str, &str, f64); 3] = [
    ("flake-820", "sphereflake 820", 5.0),
    ("flake-7381", "sphereflake 7381", 6.0),
    ("coral", "coral, 543 lines", 6.0),
];
/// The scene that POV-Ray traces with its fields, which end.
const PEERS: &str = "flake-7381";
/// Rounds of programs that are compared.
const ROUNDS: usize = 5;
/// Numbers of balls, and of pixels along a side.
const BALLS: [u32; 7] = [100, 300, 1000, 3000, 10_000, 30_000, 100_000];
const SIDE: &str = "256";
/// Distance of the balls' middles, in radii.
const APART: &str = "4";

/// Measures.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    report.set("rounds", ROUNDS);
    report.set("apart", APART);
    report.set("side", SIDE);
    for (name, title, most) in CASES {
        let [ends, goes_on] = [sinew.dataset(name), goes_on(&sinew, name)?];
        let [ends, goes_on] = sinew.compare(ROUNDS, [&[&ends], &[&goes_on]])?;
        let ratio = goes_on.over(&ends);
        report.row("scenes", format!("{title} | {ends} | {goes_on} | {ratio}"));
        let goal = format!("{title}, Cauchy | the same, Gaussian | ≤ {most}×");
        report.goal(&goal, Ok(ratio))?;
    }
    let goal = format!("{PEERS}, Cauchy | POV-Ray's blob, which ends | ≤ 1×");
    report.goal(&goal, against_povray(&sinew))?;
    for balls in BALLS {
        let balls = balls.to_string();
        let ([a, c], [b, d]) = (
            cost(&sinew, &balls, "gauss")?,
            cost(&sinew, &balls, "cauchy")?,
        );
        report.row("balls", format!("{balls} | {a} | {b} | {c} | {d}"));
    }
    Ok(report)
}

/// Writes a scene with the Cauchy kernel, and returns its dataset.
fn goes_on(sinew: &Sinew, name: &str) -> Result<String> {
    sinew.variant(name, &format!("{name}-goes-on"), |text| {
        text.replace("kernel gauss", "kernel cauchy")
    })
}

fn against_povray(sinew: &Sinew) -> Result<Short> {
    let file = sinew.path(&format!("{PEERS}-blob.pov"));
    fs::write(&file, povray::blob(&sinew.scene(PEERS)?, 1)?)?;
    let goes_on = goes_on(sinew, PEERS)?;
    let [other, own] = in_turn(3, |i| match i {
        0 => Ok(povray::time(&file, false)?.seconds),
        _ => Ok(sinew.time(&[&goes_on])?.seconds),
    })?;
    Ok(own.over(&other))
}

/// Measures the seconds and MiB that a picture of balls takes.
fn cost(sinew: &Sinew, balls: &str, kernel: &str) -> Result<[String; 2]> {
    let scene = ["--balls", balls, "--kernel", kernel, "--apart", APART];
    let arguments = [&scene[..], &["--size", SIDE, SIDE]].concat();
    let (first, second) = (sinew.time(&arguments)?, sinew.time(&arguments)?);
    let seconds = Short(first.seconds.min(second.seconds));
    let memory = first.memory.map(|bytes| Short(bytes / f64::from(1 << 20)));
    Ok([seconds.to_string(), or_dash(memory)])
}
