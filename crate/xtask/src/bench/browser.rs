//! The page in a real browser, by its own clock: `tests/speed.test.mjs`.

use super::goal::{Goal, Wanted, short};
use super::{Piece, ours};
use crate::shell::{command, root, run, target};
use crate::{dist, examples, tools};
use anyhow::{Context, Result, anyhow};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Milliseconds from a keystroke to the coarse picture and to the full one that we want.
const COARSE: f64 = 100.0;
const FULL: f64 = 1000.0;

/// How often it is measured what two programs at a time can do.
const ROUNDS: usize = 7;
/// The picture that they trace.
const PICTURE: [&str; 6] = [
    "www/examples/seahorse.rat",
    "--pass",
    "smooth",
    "--size",
    "512",
    "512",
];

/// Builds the page, opens it and measures.
pub fn measure() -> Result<Piece> {
    tools::node_packages()?;
    let chromium = tools::chromium()?;
    let page = dist::dist()?;
    let folder = target().join("bench");
    std::fs::create_dir_all(&folder)?;
    let file = folder.join("browser.json");
    run(command("node", &["--test", "speed.test.mjs"])
        .current_dir(root().join("tests"))
        .env("CHROMIUM", chromium)
        .env("SINEW_PAGE", page)
        .env("SINEW_SCREENSHOTS", &folder)
        .env("SINEW_FIGURES", &file))?;
    let figures: Value = serde_json::from_str(&std::fs::read_to_string(&file)?)?;
    let sinew = examples::sinew()?;
    let two = two_at_a_time(&sinew)?;
    let models = figures["models"].as_array().into_iter().flatten();
    let native: Vec<(&str, [f64; 3])> = models
        .filter_map(|model| model["name"].as_str())
        .map(|name| Ok((name, natively(&sinew, name)?)))
        .collect::<Result<_>>()?;
    tables(&figures, &native, two).context("the page told too few figures")
}

/// Milliseconds that each pass of a model's picture takes the program, on one thread: the quickest of some runs.
fn natively(sinew: &Path, model: &str) -> Result<[f64; 3]> {
    let dataset = format!("www/examples/{model}.rat");
    let mut best = [f64::INFINITY; 3];
    for _ in 0..ROUNDS {
        for (best, pass) in best.iter_mut().zip(["coarse", "full", "smooth"]) {
            let arguments = [&dataset, "--pass", pass, "--size", "512", "512"];
            *best = best.min(1e3 * ours::time(sinew, &arguments)?.seconds);
        }
    }
    Ok(best)
}

/// How many times as much two programs do that run at the same time and have nothing to do with each other: processors
/// share more than they admit, and no page can be quicker than that. The quickest of runs in turn.
fn two_at_a_time(sinew: &Path) -> Result<f64> {
    let trace = || {
        let begun = Instant::now();
        ours::time(sinew, &PICTURE).map(|_| begun.elapsed().as_secs_f64())
    };
    let (mut alone, mut both) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        alone = alone.min(trace()?);
        let (one, other) = std::thread::scope(|scope| {
            let other = scope.spawn(trace);
            (trace(), other.join())
        });
        let other = other.map_err(|_| anyhow!("a thread of the bench panicked"))??;
        both = both.min(0.5 * (one? + other));
    }
    Ok(2.0 * alone / both)
}

/// `None` if figures are missing. `native` gives what [`natively`] does, by model.
fn tables(figures: &Value, native: &[(&str, [f64; 3])], two: f64) -> Option<Piece> {
    let mut goals = Vec::new();
    let mut page = format!(
        "From a keystroke to the traced picture of 512×512 pixels on the screen, milliseconds by the page's own \
         clock, with a pause in typing waited for and the text compiled; the quickest of {} keystrokes, with one worker and with two in turn \
         (`tests/speed.test.mjs`, {}). Natively each pass is timed by itself (`sinew time`, one thread, the quickest of {ROUNDS}); the \
         last columns say how many times as long the page takes.\n\n\
         | model | workers | coarse | full | smooth | of that, compiling | coarse ÷ native | full ÷ native | smooth ÷ native |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|\n",
        figures["rounds"],
        figures["browser"].as_str()?,
    );
    for model in figures["models"].as_array()? {
        let name = model["name"].as_str()?;
        let (_, native) = native.iter().find(|(model, _)| *model == name)?;
        let cells = native.map(|time| format!("{time:.0}")).join(" | ");
        let _ = writeln!(page, "| {name} | natively | {cells} | – | 1 | 1 | 1 |");
        let mut tracing = Vec::new();
        for run in model["runs"].as_array()? {
            let of = |key: &str| run[key].as_f64();
            let workers = of("workers")?;
            let passes = [of("coarse")?, of("full")?, of("smooth")?];
            let ratios = [0, 1, 2].map(|i| short(passes[i] / native[i]));
            // Writing to a string never fails.
            let _ = writeln!(
                page,
                "| {name} | {workers} | {} | {:.1} | {} |",
                passes.map(|time| format!("{time:.0}")).join(" | "),
                of("compile")?,
                ratios.join(" | ")
            );
            tracing.push((workers, of("tracing")?));
            if workers == 2.0 {
                for (what, key, most) in [("coarse", "coarse", COARSE), ("full", "full", FULL)] {
                    goals.push(Goal {
                        what: format!("{name}, keystroke to the {what} picture"),
                        against: "2 workers, in the browser".into(),
                        wanted: Wanted::AtMost(most),
                        unit: " ms",
                        measured: of(key).ok_or_else(String::new),
                    });
                }
            }
        }
        let of = |count: f64| {
            let found = tracing.iter().find(|(workers, _)| *workers == count);
            found.map(|(_, seconds)| *seconds)
        };
        goals.push(Goal {
            what: format!("{name}, 2 workers"),
            against: "1 worker, in the browser".into(),
            wanted: Wanted::AtLeast(1.8),
            unit: "×",
            measured: Ok(of(1.0)? / of(2.0)?),
        });
    }
    let ratios: Vec<String> = goals
        .iter()
        .filter(|goal| goal.unit == "×")
        .filter_map(|goal| {
            Some(format!(
                "{} {}",
                goal.what,
                short(*goal.measured.as_ref().ok()?)
            ))
        })
        .collect();
    let _ = writeln!(
        page,
        "\nTimes quicker than with one worker, from the start of the picture to its end: {}. Two programs (`sinew time {}`) that run \
         at the same time do {} times what one does alone.\n",
        ratios.join("; "),
        PICTURE.join(" "),
        short(two)
    );
    Some((goals, page))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_become_rows_and_goals() {
        let run = |workers: u32, coarse: f64| {
            serde_json::json!({
                "workers": workers, "coarse": coarse, "full": 8.0 * coarse, "smooth": 16.0 * coarse,
                "compile": 0.25, "tracing": 15.0 * coarse,
            })
        };
        let figures = serde_json::json!({
            "rounds": 3, "browser": "a browser",
            "models": [{"name": "crab", "runs": [run(1, 100.0), run(2, 50.0)]}],
        });
        let (goals, page) = tables(&figures, &[("crab", [40.0, 200.0, 500.0])], 1.9).unwrap();
        assert!(
            page.contains("| crab | natively | 40 | 200 | 500 | – | 1 | 1 | 1 |"),
            "{page}"
        );
        let row = "| crab | 2 | 50 | 400 | 800 | 0.2 | 1.25 | 2.00 | 1.60 |";
        assert!(page.contains(row), "{page}");
        let rows: String = goals.iter().map(Goal::row).collect();
        assert!(
            rows.contains("| crab, 2 workers | 1 worker, in the browser | ≥ 1.8× | 2.00× | met |"),
            "{rows}"
        );
        assert!(tables(&figures, &[], 1.9).is_none());
    }
}
