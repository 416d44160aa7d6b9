//! Figures of the field's chart: values a second and rounding errors, natively and as wasm.

use crate::report::{Report, Short, or_dash};
use anyhow::Result;
use xtask::shell::{cargo, run_and_read, words};
use xtask::tools;

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
pub fn measure() -> Result<Report> {
    let (native, wasm) = (Chart::native()?, Chart::wasm()?);
    let mut report = Report::default();
    let sides = "--:|".repeat(KINDS.len());
    report.set(
        "head",
        format!("| kernel | {} |\n|---|{sides}", KINDS.join(" | ")),
    );
    for kernel in KERNELS {
        let tables = ["eight", "single", "double"].into_iter().enumerate();
        for (i, mark) in tables {
            let cells = KINDS.map(|kind| {
                let [native, wasm] =
                    [&native, &wasm].map(|chart| chart.cell("speed", kernel, kind, i));
                format!("{native} / {wasm}")
            });
            report.row(mark, format!("{kernel} | {}", cells.join(" | ")));
        }
        // The same as wasm, where a test compares the bits.
        let errors = KINDS.map(|kind| native.cell("error", kernel, kind, 0));
        report.row("errors", format!("{kernel} | {}", errors.join(" | ")));
    }
    for (kind, thesis) in THESIS {
        let ratios = [(&native, 0), (&native, 1), (&native, 2), (&wasm, 0)].map(|(chart, i)| {
            let [point, this] = ["point", kind].map(|kind| chart.speed("cauchy", kind, i));
            or_dash(point.zip(this).map(|(point, this)| Short(point / this)))
        });
        report.row(
            "costs",
            format!("{kind} | {thesis} | {}", ratios.join(" | ")),
        );
    }
    Ok(report)
}

/// The lines `speed KERNEL KIND FIGURES…` and `error KERNEL KIND FIGURE` of the measurement, as
/// words.
pub struct Chart(Vec<Vec<String>>);

impl Chart {
    /// Measures on this machine.
    pub fn native() -> Result<Self> {
        Self::new("")
    }

    /// Measures as wasm, in node.
    fn wasm() -> Result<Self> {
        tools::target(tools::WASI)?;
        Self::new(&format!("--target {}", tools::WASI))
    }

    fn new(options: &str) -> Result<Self> {
        let line = format!(
            "test --release {options} --package field --test it chart_figures:: -- \
             --include-ignored --nocapture"
        );
        let output = run_and_read(&mut cargo(&words(&line)))?;
        let lines = output
            .lines()
            .map(|line| words(line).into_iter().map(str::to_owned));
        Ok(Self(lines.map(Iterator::collect).collect()))
    }

    /// The `i`th figure of a cell, or a dash.
    fn cell(&self, what: &str, kernel: &str, kind: &str, i: usize) -> &str {
        let mut lines = self.0.iter();
        let line = lines.find(|words| words.starts_with(&[what, kernel, kind].map(str::to_owned)));
        line.and_then(|words| words.get(3 + i))
            .map_or("–", String::as_str)
    }

    /// Million values with gradients a second in eight lanes, as `f32`, and as `f64`.
    pub fn speed(&self, kernel: &str, kind: &str, i: usize) -> Option<f64> {
        let speed = self.cell("speed", kernel, kind, i).parse().ok();
        speed.filter(|speed| *speed > 0.0)
    }
}
