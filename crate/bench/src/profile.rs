//! Profile: counts of work, and the functions that the processor spends its time in.

use crate::fields::Chart;
use crate::report::{Report, Short};
use crate::sinew::{SCENES, Sinew};
use anyhow::Result;
use std::process::Stdio;
use xtask::shell::{command, read};

/// Functions in which less of the time was spent are not listed, percent.
const LEAST: f64 = 2.0;

/// Counts and samples.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    report.set("least", LEAST);
    let chart = Chart::native()?;
    for (scene, kernel, kind) in SCENES {
        let mut cost = sinew.time(&[&sinew.dataset(scene)])?;
        cost.counts
            .retain(|(name, _)| name != "primary rays" && name != "shadow rays");
        let names: Vec<&str> = cost.counts.iter().map(|(name, _)| name.as_str()).collect();
        report.set("names", names.join(" | "));
        report.set("sides", "--:|".repeat(names.len()));
        let counts = cost
            .counts
            .iter()
            .map(|(_, count)| Short(count / cost.rays).to_string());
        let counts = counts.collect::<Vec<_>>().join(" | ");
        let evaluations = names.iter().position(|name| *name == "field evaluations");
        let evaluations = evaluations.map_or(f64::NAN, |at| cost.counts[at].1);
        let [ray, evaluation] =
            [cost.rays, evaluations].map(|count| Short(1e9 * cost.seconds / count));
        let alone = chart.speed(kernel, kind, 0).map(|millions| {
            let alone = Short(1e3 / millions * evaluations / cost.rays);
            format!("{alone} | {:.0} %", 100.0 * alone.0 / ray.0)
        });
        let alone = alone.unwrap_or("– | –".into());
        report.row(
            "counts",
            format!("{scene} | {ray} | {counts} | {evaluation} | {alone}"),
        );
    }
    for (scene, ..) in SCENES {
        let functions = sample(&sinew, scene).into_iter();
        let listed = functions.map(|(share, name)| format!("{share:.0} % `{name}`"));
        let listed = listed.collect::<Vec<_>>().join(", ");
        report.row("functions", format!("{scene} | {listed}"));
    }
    Ok(report)
}

/// Percents and functions; none if there is no `perf`, or this machine does not let itself be
/// sampled.
fn sample(sinew: &Sinew, scene: &str) -> Vec<(f64, String)> {
    let (data, dataset) = (sinew.path("perf.data"), sinew.dataset(scene));
    let mut record = command("perf", &["record", "-q", "-F", "1999", "-o", &data]);
    record.arg(&sinew.program).args(["time", &dataset]);
    let recorded = record.stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !recorded.is_ok_and(|status| status.success()) {
        return Vec::new();
    }
    let report = ["report", "-i", &data, "--stdio", "-F", "overhead,sym"];
    let report = read(&mut command("perf", &report)).unwrap_or_default();
    let functions = report.lines().filter_map(function);
    functions.filter(|(share, _)| *share >= LEAST).collect()
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
