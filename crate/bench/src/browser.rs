//! The page in a real browser, by its own clock: `tests/speed.test.mjs`.

use crate::programs::Figures;
use crate::report::{Report, Short};
use crate::series::in_turn;
use crate::sinew::Sinew;
use anyhow::{Context, Result, anyhow};
use serde_json::Value;
use std::time::Instant;
use xtask::shell::{command, root, run};
use xtask::{dist, tools};

/// Milliseconds from a keystroke to the coarse picture and to the full one that we want.
const WANTED: [(&str, f64); 2] = [("coarse", 100.0), ("full", 1000.0)];
/// The passes that are timed.
const PASSES: [&str; 3] = ["coarse", "full", "smooth"];

/// Rounds of measuring the program.
const ROUNDS: usize = 7;
/// The picture that two programs trace at a time.
const PICTURE: [&str; 6] = [
    "www/examples/seahorse.rat",
    "--pass",
    "smooth",
    "--size",
    "512",
    "512",
];

/// Builds the page, opens it and measures.
pub fn measure() -> Result<Report> {
    tools::node_packages()?;
    let chromium = tools::chromium()?;
    let page = dist::dist()?;
    let sinew = Sinew::new()?;
    let file = sinew.path("browser.json");
    run(command("node", &["--test", "speed.test.mjs"])
        .current_dir(root().join("tests"))
        .env("CHROMIUM", chromium)
        .env("SINEW_PAGE", page)
        .env("SINEW_SCREENSHOTS", sinew.path(""))
        .env("SINEW_FIGURES", &file))?;
    let figures: Value = serde_json::from_str(&std::fs::read_to_string(&file)?)?;
    let two = two_at_a_time(&sinew)?;
    tables(&figures, &|name| natively(&sinew, name), two)
}

/// Measures the milliseconds of each pass of a model's picture by the program, on one thread: the
/// quickest of some runs.
fn natively(sinew: &Sinew, model: &str) -> Result<[f64; 3]> {
    let dataset = format!("www/examples/{model}.rat");
    let passes = in_turn(ROUNDS, |i| {
        let arguments = [&dataset, "--pass", PASSES[i], "--size", "512", "512"];
        Ok(1e3 * sinew.time(&arguments)?.seconds)
    })?;
    Ok(passes.map(|runs| runs.best()))
}

/// Measures the gain of a second program at the same time, 0 … 2, by the quickest of runs in turn.
/// Processors share more than they admit: no page can gain more.
fn two_at_a_time(sinew: &Sinew) -> Result<f64> {
    let trace = || {
        let begun = Instant::now();
        sinew.time(&PICTURE).map(|_| begun.elapsed().as_secs_f64())
    };
    let [alone, both] = in_turn(ROUNDS, |i| {
        if i == 0 {
            return trace();
        }
        let (one, other) = std::thread::scope(|scope| {
            let other = scope.spawn(trace);
            (trace(), other.join())
        });
        let other = other.map_err(|_| anyhow!("a thread of the bench panicked"))??;
        Ok(0.5 * (one? + other))
    })?;
    Ok(2.0 * alone.over(&both).0)
}

/// Returns milliseconds as cells of a table.
fn cells(passes: [f64; 3]) -> String {
    passes.map(|time| format!("{time:.0}")).join(" | ")
}

fn tables(
    figures: &Value,
    natively: &dyn Fn(&str) -> Result<[f64; 3]>,
    two: f64,
) -> Result<Report> {
    let mut report = Report::default();
    report.set("keystrokes", &figures["rounds"]);
    report.set("browser", figures["browser"].as_str().unwrap_or_default());
    report.set("rounds", ROUNDS);
    report.set("picture", PICTURE.join(" "));
    report.set("two", Short(two));
    let mut gains = Vec::new();
    for model in list(&figures["models"])? {
        let name = model["name"].as_str().context("a model without a name")?;
        let native = natively(name)?;
        report.row(
            "models",
            format!("{name} | natively | {} | – | 1 | 1 | 1", cells(native)),
        );
        let mut tracing = [f64::NAN; 2];
        for run in list(&model["runs"])? {
            let run = Figures(run.clone());
            let [coarse, full, smooth] = PASSES.map(|pass| run.number(pass));
            let passes = [coarse?, full?, smooth?];
            let ratios = [0, 1, 2]
                .map(|i| Short(passes[i] / native[i]).to_string())
                .join(" | ");
            let (workers, compile) = (run.number("workers")?, run.number("compile")?);
            let cells = cells(passes);
            report.row(
                "models",
                format!("{name} | {workers} | {cells} | {compile:.1} | {ratios}"),
            );
            tracing[usize::from(workers == 2.0)] = run.number("tracing")?;
            if workers == 2.0 {
                for (pass, most) in WANTED {
                    let what = format!("{name}, keystroke to the {pass} picture");
                    let goal = format!("{what} | 2 workers, in the browser | ≤ {most} ms");
                    report.goal(&goal, run.short(pass))?;
                }
            }
        }
        let gain = Short(tracing[0] / tracing[1]);
        gains.push(format!("{name}, 2 workers {gain}"));
        let goal = format!("{name}, 2 workers | 1 worker, in the browser | ≥ 1.8×");
        report.goal(&goal, Ok(gain))?;
    }
    report.set("gains", gains.join("; "));
    Ok(report)
}

fn list(value: &Value) -> Result<&Vec<Value>> {
    value.as_array().context("the page told too few figures")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_become_rows_and_goals() {
        let runs = [(1, 100.0), (2, 50.0)].map(|(workers, coarse)| {
            serde_json::json!({
                "workers": workers, "coarse": coarse, "full": 8.0 * coarse, "smooth": 16.0 * coarse,
                "compile": 0.25, "tracing": 15.0 * coarse,
            })
        });
        let figures = serde_json::json!({
            "rounds": 3, "browser": "a browser",
            "models": [{"name": "crab", "runs": runs}],
        });
        let report = tables(&figures, &|_| Ok([40.0, 200.0, 500.0]), 1.9).unwrap();
        let text = report.fill("{models}").unwrap();
        for row in [
            "| crab | natively | 40 | 200 | 500 | – | 1 | 1 | 1 |",
            "| crab | 2 | 50 | 400 | 800 | 0.2 | 1.25 | 2.00 | 1.60 |",
        ] {
            assert!(text.contains(row), "{text}");
        }
        let goal = "| crab, 2 workers | 1 worker, in the browser | ≥ 1.8× | 2.00× | met |";
        assert!(report.goals.contains(&goal.into()), "{:?}", report.goals);
        assert!(tables(&serde_json::json!({}), &|_| Ok([1.0; 3]), 1.9).is_err());
    }
}
