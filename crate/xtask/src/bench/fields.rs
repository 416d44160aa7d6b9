//! Figures of the field's chart: values a second and rounding errors, natively and as wasm.

use crate::shell::{cargo, run_and_read};
use crate::tools;
use anyhow::Result;
use std::fmt::Write;
use std::process::Command;

/// Kernels and kinds of skeleton, in the order of the chart.
const KERNELS: [&str; 9] = [
    "cauchy",
    "gauss",
    "inverse",
    "squared",
    "metaballs",
    "soft",
    "quartic",
    "compact6",
    "cubed",
];
const KINDS: [&str; 7] = [
    "point", "segment", "arc", "triangle", "polygon", "plane", "curve",
];

/// The thesis's table 2.6: cost of Cauchy fields, the point's as unit.
const THESIS: [(&str, f64); 5] = [
    ("point", 1.0),
    ("segment", 4.48),
    ("arc", 8.17),
    ("triangle", 14.36),
    ("plane", 1.02),
];

/// Measures, and gives the tables.
pub fn measure() -> Result<String> {
    tools::wasm_target()?;
    let runner = tools::wasm_test_runner()?;
    let native = figures(cargo(&["test"]).args(["--release"]))?;
    let wasm = figures(
        cargo(&["test"])
            .args(["--release", "--target", tools::WASM])
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER", &runner),
    )?;
    page(&native, &wasm)
}

/// Nanoseconds that a value with its gradient takes natively in eight lanes, for each of them, by kernel and kind of skeleton.
pub fn nanoseconds(cells: &[[&str; 2]]) -> Result<Vec<Option<f64>>> {
    let native = figures(cargo(&["test"]).args(["--release"]))?;
    let of = |[kernel, kind]: &[&str; 2]| {
        let millions = cell(&native, "speed", kernel, kind, 0).parse::<f64>();
        millions.ok().map(|millions| 1e3 / millions)
    };
    Ok(cells.iter().map(of).collect())
}

/// Runs the measurement of the field's chart, ignored tests and all, and gives its lines.
fn figures(command: &mut Command) -> Result<Vec<Vec<String>>> {
    let test = ["--package", "field", "--test", "chart_figures", "--"];
    let output = run_and_read(
        command
            .args(test)
            .args(["--include-ignored", "--nocapture"]),
    )?;
    Ok(output
        .lines()
        .map(|line| {
            line.split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        })
        .filter(|words| {
            let first = words.first().map(String::as_str);
            matches!(first, Some("speed" | "error")) && words.len() >= 4
        })
        .collect())
}

/// A figure of a cell: the `index`th number of its line.
fn cell<'a>(
    lines: &'a [Vec<String>],
    what: &str,
    kernel: &str,
    kind: &str,
    index: usize,
) -> &'a str {
    lines
        .iter()
        .find(|words| words[0] == what && words[1] == kernel && words[2] == kind)
        .and_then(|words| words.get(3 + index))
        .map_or("–", String::as_str)
}

fn table(out: &mut String, of: impl Fn(&str, &str) -> String) -> Result<()> {
    writeln!(out, "| kernel | {} |", KINDS.join(" | "))?;
    writeln!(out, "|---|{}", "--:|".repeat(KINDS.len()))?;
    for kernel in KERNELS {
        let cells = KINDS.map(|kind| of(kernel, kind));
        writeln!(out, "| {kernel} | {} |", cells.join(" | "))?;
    }
    writeln!(out)?;
    Ok(())
}

fn page(native: &[Vec<String>], wasm: &[Vec<String>]) -> Result<String> {
    let mut out = String::new();
    writeln!(
        out,
        "## Fields: million values with gradients a second\n\nOne thread, a skeleton about five radii \
         long, places near it (`crate/field/tests/chart_figures.rs`). Which formula serves which cell \
         stands in `crate/field/src/form.rs`.\n\n### Eight lanes (`f32x8`), native / wasm with simd128\n"
    )?;
    table(&mut out, |kernel, kind| {
        let of = |lines| cell(lines, "speed", kernel, kind, 0).to_owned();
        format!("{} / {}", of(native), of(wasm))
    })?;
    writeln!(out, "### Scalar (`f32`), native / wasm\n")?;
    table(&mut out, |kernel, kind| {
        let of = |lines| cell(lines, "speed", kernel, kind, 1).to_owned();
        format!("{} / {}", of(native), of(wasm))
    })?;
    writeln!(out, "### Reference (`f64`), native / wasm\n")?;
    table(&mut out, |kernel, kind| {
        let of = |lines| cell(lines, "speed", kernel, kind, 2).to_owned();
        format!("{} / {}", of(native), of(wasm))
    })?;
    writeln!(
        out,
        "### Cost of Cauchy fields, the point's as unit (thesis, table 2.6)\n\n\
         | | thesis | f32x8 | f32 | f64 | f32x8, wasm |\n|---|--:|--:|--:|--:|--:|"
    )?;
    for (kind, thesis) in THESIS {
        let ratio = |lines: &[Vec<String>], index| -> String {
            let of = |kind| cell(lines, "speed", "cauchy", kind, index).parse::<f64>();
            match (of("point"), of(kind)) {
                (Ok(point), Ok(this)) if this > 0.0 => format!("{:.2}", point / this),
                _ => String::from("–"),
            }
        };
        writeln!(
            out,
            "| {kind} | {thesis} | {} | {} | {} | {} |",
            ratio(native, 0),
            ratio(native, 1),
            ratio(native, 2),
            ratio(wasm, 0)
        )?;
    }
    writeln!(
        out,
        "\n## Fields: worst relative error of single precision\n\nAgainst double precision, at points 0.05 or more \
         from the skeleton where the field is at least T/10, of random primitives of radius 1 that are a \
         hundredth to ten long and no needles. The test `single_precision_is_as_exact_as_listed` \
         bounds every cell. The same bits natively and as wasm.\n"
    )?;
    table(&mut out, |kernel, kind| {
        let (n, w) = (
            cell(native, "error", kernel, kind, 0),
            cell(wasm, "error", kernel, kind, 0),
        );
        if n == w {
            n.to_owned()
        } else {
            format!("{n} / {w}")
        }
    })?;
    Ok(out)
}
