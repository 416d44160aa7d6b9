//! Cost of a step of a sculpting tool, natively and as wasm.

use crate::programs::{Figures, example, example_as_wasm};
use crate::report::{Report, Short};
use anyhow::Result;

/// A frame of a display with 60 Hz, ms.
const FRAME: f64 = 1000.0 / 60.0;
/// Vertices of the step that has to fit in a part of a frame.
const VERTICES: f64 = 2000.0;

/// Measures.
pub fn measure() -> Result<Report> {
    let mut report = Report::default();
    add(
        "native",
        &example("sculpt", "cost", &[])?,
        0.33,
        &mut report,
    )?;
    match example_as_wasm("sculpt", "cost", &[]) {
        Ok(said) => add("wasm", &said, 0.5, &mut report)?,
        Err(error) => report.row(
            "steps",
            format!("wasm | not measured: {error:#} | | | | | |"),
        ),
    }
    Ok(report)
}

/// Adds rows of what the program said, and the goals: the same time on a large mesh, and a share of
/// a frame.
fn add(with: &str, said: &str, frames: f64, report: &mut Report) -> Result<()> {
    let (mut times, mut share) = (0.0f64, 0.0f64);
    for line in said.lines().filter(|line| line.starts_with('{')) {
        let found = Figures::new(line)?;
        let (small, large) = (found.number("small")?, found.number("large")?);
        let (small_ms, large_ms) = (found.short("small_ms")?, found.short("large_ms")?);
        let (each, passes) = (found.short("times")?, found.short("passes")?);
        let action = found.text("action");
        let steps = format!("{small} | {small_ms} | {large} | {large_ms}");
        report.row(
            "steps",
            format!("{with} | {action} | {steps} | {each}× | {passes}"),
        );
        // Steps of a few vertices are too short for a clock.
        if large > 1000.0 {
            times = times.max(each.0);
            share = share.max(large_ms.0 * VERTICES / large / FRAME);
        }
    }
    let what = format!("a step of sculpting on 10⁶ faces, {with}");
    let against = "the same on 10⁴, for each vertex";
    report.goal(&format!("{what} | {against} | ≤ 1.5×"), Ok(Short(times)))?;
    let what = format!("a step that moves 2,000 vertices, {with}");
    report.goal(
        &format!("{what} | a frame of 60 Hz | ≤ {frames} frames"),
        Ok(Short(share)),
    )
}
