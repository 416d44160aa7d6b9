//! The memory of very many elements: the most that `sinew time --balls` ever had.

use crate::report::{Report, Short, or_dash};
use crate::sinew::Sinew;
use anyhow::{Context, Result};

/// Scenes of balls: their number, kernel and distance in radii, and the picture's sides. A ray
/// meets many more balls with the Cauchy kernel, whose field has no end: they are further apart,
/// and the pictures smaller.
const SCENES: [(&str, &str, &str, &str); 4] = [
    ("10000", "gauss", "3", "512"),
    ("100000", "gauss", "3", "512"),
    ("1000000", "gauss", "3", "512"),
    ("10000", "cauchy", "4", "64"),
];
/// The number of balls of the scene that has a goal.
const MANY: &str = "1000000";
/// The goal: the most memory of that scene, GiB.
const MOST: f64 = 1.5;

/// Measures.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    for (count, kernel, apart, side) in SCENES {
        let balls = ["--balls", count, "--kernel", kernel, "--apart", apart];
        let cost = sinew.time(&[&balls[..], &["--size", side, side]].concat())?;
        let memory = |unit: f64| cost.memory.map(|bytes| Short(bytes / unit));
        let (size, each) = (memory(f64::from(1 << 20)), memory(cost.elements));
        let (size, each) = (or_dash(size), or_dash(each));
        let (seconds, prepare) = (Short(cost.seconds), Short(cost.prepare));
        let scene = format!("{count} | {kernel} | {side}²");
        report.row(
            "scenes",
            format!("{scene} | {size} | {each} | {seconds} | {prepare}"),
        );
        if count == MANY {
            let goal = format!("memory of {count} elements | natively, one thread | ≤ {MOST} GiB");
            let measured = memory(f64::from(1 << 30)).context("this system does not tell");
            report.goal(&goal, measured)?;
        }
    }
    Ok(report)
}
