//! Meshes fitted to points and outlines: the recovery of a known shape, the time against scipy's
//! solver, and how the cost of tracing an implicit mesh grows with its facets.

use crate::programs::{Figures, example};
use crate::report::{Report, Short, or_dash};
use crate::sinew::Sinew;
use anyhow::{Context, Result, anyhow};
use xtask::shell::{command, read, run_and_read};

/// Facets of the traced implicit meshes.
const FACETS: [u32; 4] = [2000, 8000, 30_000, 100_000];
/// The goal: the greatest ratio of the last mesh's time to the first's.
const GROWTH: f64 = 3.0;

/// The scene of a traced mesh, but for the mesh.
const SHELL: &str = "\
framesize 512 512
eyep 0 -9 0.4
vrp 0 0 -0.1
vup 0 0 1
fov 28
light White, position -6 -9 8
surface Shell, diffuse SeaGreen
";

/// Measures.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    recovery(&mut report)?;
    peer(&sinew, &mut report)?;
    growth(&sinew, &mut report)?;
    Ok(report)
}

fn recovery(report: &mut Report) -> Result<()> {
    let found = Figures::new(&example("fit", "recovery", &["json"])?)?.0;
    for name in ["controls", "points", "noise", "sights"] {
        report.set(name, &found[name]);
    }
    let rows = found["rows"].as_array().cloned().unwrap_or_default();
    let rows: Vec<Figures> = rows.into_iter().map(Figures).collect();
    for row in &rows {
        let numbers = ["error", "gap", "surface"].map(|name| or_dash(row.short(name).ok()));
        let (numbers, iterations) = (numbers.join(" | "), or_dash(row.0["iterations"].as_u64()));
        let to = match row.0["outlines"].as_bool() {
            Some(true) => "points, outlines",
            Some(false) => "points",
            None => "–",
        };
        let (mesh, kind) = (row.text("mesh"), row.text("kind"));
        report.row(
            "meshes",
            format!("{mesh} | {kind} | {to} | {numbers} | {iterations}"),
        );
    }
    let robust = found["robust"].as_array().cloned().unwrap_or_default();
    let robust: Vec<Figures> = robust.into_iter().map(Figures).collect();
    let mut worst = 0.0_f64;
    for row in &robust {
        let numbers = ["start", "error", "surface"].map(|name| or_dash(row.short(name).ok()));
        let iterations = or_dash(row.0["iterations"].as_u64());
        let (shape, measured) = (row.text("shape"), row.text("measured"));
        let numbers = numbers.join(" | ");
        report.row(
            "robust",
            format!("{shape} | {measured} | {numbers} | {iterations}"),
        );
        if measured == "40 % outliers" {
            worst = worst.max(row.number("error")?);
        }
    }
    let goal = "40 % of outliers: the worst error of four shapes | the noise σ | ≤ 1.5 σ";
    report.goal(goal, Ok(Short(worst)))?;
    let error = |mesh: &str, kind: &str| {
        let mut rows = rows.iter().filter(|row| row.text("mesh").starts_with(mesh));
        let row = rows.find(|row| row.text("kind") == kind && row.0["outlines"] == true);
        row.context("not in the table")?.short("error")
    };
    let ratio = |kind: &str| Ok(Short(error("420", kind)?.0 / error("420", "triangular")?.0));
    let goal = "error of a head that is found again, thin shells | the noise σ, away from the gap";
    report.goal(&format!("{goal} | ≤ 1.5 σ"), error("2,000", "triangular"))?;
    let goal = "coarse mesh: error of balls | thin shells | ≥ 2×";
    report.goal(goal, ratio("spherical"))?;
    let goal = "coarse mesh: error of nearest facets, squares | thin shells | ≥ 1.3×";
    report.goal(goal, ratio("explicit, squares"))
}

fn peer(sinew: &Sinew, report: &mut Report) -> Result<()> {
    let problem = sinew.path("problem.json");
    let own = Figures::new(&example("fit", "peer", &[&problem])?)?.short("seconds")?;
    let python = std::env::var("SINEW_PYTHON").unwrap_or_else(|_| "python3".into());
    let mut measured = Err(anyhow!("scipy is missing"));
    if read(&mut command(&python, &["-c", "import scipy"])).is_some() {
        let mut solve = command(&python, &["tests/bench/fit_scipy.py", &problem]);
        let other = Figures::new(&run_and_read(&mut solve)?)?;
        let (seconds, sum, ours) = (
            other.short("seconds")?,
            other.number("sum")?,
            other.number("ours")?,
        );
        let theirs = format!("{seconds} s to a sum of {sum:.4}");
        let ours = format!("here {own} s to {ours:.4}, with the control points' coordinates");
        report.set("peer", format!("{theirs}, {ours}"));
        measured = Ok(Short(seconds.0 / own.0));
    } else {
        report.set(
            "peer",
            "skipped, as Python or scipy is missing (SINEW_PYTHON names another Python)",
        );
    }
    let goal = "fit of 2,000 facets to 5,000 points | scipy.optimize.least_squares | ≥ 10×";
    report.goal(goal, measured)
}

fn growth(sinew: &Sinew, report: &mut Report) -> Result<()> {
    let mut times = Vec::new();
    let mut ratio = Short(1.0);
    for facets in FACETS {
        let name = format!("head-{facets}");
        let mesh = sinew.path(&format!("{name}.obj"));
        example("fit", "head", &[&facets.to_string(), &mesh, "even"])?;
        // The mean edge falls with the root of the number of facets; 2,000 have 0.17.
        let edge = 0.17 * (2000.0 / f64::from(facets)).sqrt();
        let (near, steep) = (0.1 * edge, 20.0 / edge);
        let mesh = format!("mesh Shell {name}.obj metaballs triangular {near} {steep}\n");
        let dataset = sinew.dataset(&name);
        std::fs::write(&dataset, SHELL.to_owned() + &mesh)?;
        let cost = sinew.time(&[&dataset])?;
        times.push(cost.seconds - cost.prepare);
        ratio = Short(times[times.len() - 1] / times[0]);
        let (seconds, prepare) = (Short(cost.seconds), Short(cost.prepare));
        report.row(
            "facets",
            format!("{facets} | {seconds} | {prepare} | {ratio}×"),
        );
    }
    let goal = format!("tracing 100,000 facets in thin shells | 2,000 facets | ≤ {GROWTH}×");
    report.goal(&goal, Ok(ratio))
}
