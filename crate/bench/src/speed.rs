//! The tracer against other programs, and against itself with more elements, samples and other root
//! finders.

use crate::povray;
use crate::report::{Report, Short, or_dash};
use crate::series::{Runs, in_turn};
use crate::sinew::{self, Sinew};
use anyhow::{Context, Result};
use std::collections::HashMap;
use std::path::PathBuf;
use xtask::pictures;
use xtask::shell::{PORTABLE, find};

/// Rounds of programs that are compared.
const ROUNDS: usize = 7;
/// The sphereflakes with Gaussian fields, by their number of balls.
const FLAKES: [u32; 5] = [1, 10, 91, 820, 7381];

/// Scenes: name, title, POV-Ray's object, and the goal, the least ratio of its time to ours.
type Case = (&'static str, &'static str, Pov, Option<f64>);

#[derive(Clone, Copy, PartialEq)]
enum Pov {
    /// A `blob`, with each arc as this number of cylinders.
    Blob(u32),
    /// An `isosurface` of the exact field.
    Isosurface,
}

const ARCS: &str = "seahorse, 40 exact Cauchy arcs";
const CASES: [Case; 9] = [
    ("flake-1", "sphereflake 1", Pov::Blob(1), None),
    ("flake-10", "sphereflake 10", Pov::Blob(1), None),
    ("flake-91", "sphereflake 91", Pov::Blob(1), None),
    ("flake-820", "sphereflake 820", Pov::Blob(1), Some(4.0)),
    ("flake-7381", "sphereflake 7381", Pov::Blob(1), Some(3.0)),
    (
        "coral",
        "coral, 543 Gaussian lines",
        Pov::Blob(1),
        Some(3.0),
    ),
    ("seahorse", ARCS, Pov::Blob(4), None),
    ("seahorse", ARCS, Pov::Blob(12), Some(3.0)),
    (
        "tee",
        "T, 2 exact Cauchy lines",
        Pov::Isosurface,
        Some(60.0),
    ),
];

/// Measures all of it.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    report.set("rounds", ROUNDS);
    report.set("options", povray::options(false).join(" "));
    report.set("smooth_options", povray::options(true)[4..8].join(" "));
    report.set("portable", PORTABLE.flags);
    let any = cfg!(target_arch = "x86_64");
    let portable = any.then(|| pictures::sinew(Some(PORTABLE))).transpose()?;
    let programs = [Some(sinew.program.clone()), portable];
    let mut best = HashMap::new();
    for smooth in [false, true] {
        for case in CASES {
            let seconds = against_povray(&sinew, &programs, case, smooth, &mut report)?;
            best.entry(case.0).or_insert(seconds);
        }
    }
    let [ours, theirs] = [0, 1].map(|i| Short(best["flake-7381"][i] / best["flake-10"][i]));
    let what = "sphereflake 10 → 7381, growth of the time";
    let goal = format!("{what} | POV-Ray grows {theirs}× | ≤ 1.5×");
    report.goal(&goal, Ok(ours))?;

    let dataset = sinew.dataset("flake-820-cauchy");
    let [with, without] = sinew.compare(3, [&[&dataset], &[&dataset, "--hierarchy=off"]])?;
    let ratio = without.over(&with);
    report.row("hierarchy", format!("{with} | {without} | {ratio}"));
    let goal = "sphereflake 820, Cauchy | our own without far-field hierarchy | ≥ 5×";
    report.goal(goal, Ok(ratio))?;

    let mut worst = f64::INFINITY;
    for balls in FLAKES {
        let name = format!("flake-{balls}");
        let datasets = [
            sinew.dataset(&name),
            sinew.variant(&name, "flake-lg", |text| format!("digger LG\n{text}"))?,
        ];
        let [hermite, lg] = sinew.compare(3, [&[&datasets[0]], &[&datasets[1]]])?;
        let ratio = lg.over(&hermite);
        worst = worst.min(ratio.0);
        report.row("diggers", format!("{balls} | {hermite} | {lg} | {ratio}"));
    }
    let goal = "sphereflake series, the least of the ratios | our own `digger LG` | ≥ 4×";
    report.goal(goal, Ok(Short(worst)))?;
    Ok(report)
}

/// Traces a scene with our programs, of which the second may be missing, and with POV-Ray, and
/// gives the best times of the first and of POV-Ray.
fn against_povray(
    sinew: &Sinew,
    programs: &[Option<PathBuf>; 2],
    (scene, title, pov, goal): Case,
    smooth: bool,
    report: &mut Report,
) -> Result<[f64; 2]> {
    let compiled = sinew.scene(scene)?;
    let (peer, text) = match pov {
        Pov::Blob(1) => ("blob".into(), povray::blob(&compiled, 1)?),
        Pov::Blob(pieces) => {
            let text = povray::blob(&compiled, pieces)?;
            (format!("blob, arcs as {pieces} cylinders"), text)
        }
        Pov::Isosurface => ("isosurface".into(), povray::cauchy_lines(&compiled)?),
    };
    let file = sinew.path(&format!("{scene}.pov"));
    std::fs::write(&file, text)?;

    let installed = find("povray").is_some();
    let mut arguments = vec![sinew.dataset(scene)];
    let mut probe = None;
    if smooth {
        arguments.push("--pass=smooth".into());
    }
    if smooth && installed {
        // One run before the others tells how many rays ours should have.
        let cost = povray::time(&file, true)?;
        arguments.push(format!("--rays={}", cost.rays));
        // An isosurface takes long, with anti-aliasing so long that once is enough.
        probe = Some(cost).filter(|_| pov == Pov::Isosurface);
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (mut our_rays, mut pov_rays) = (f64::NAN, f64::NAN);
    let rounds = if smooth || pov == Pov::Isosurface {
        3
    } else {
        ROUNDS
    };
    let [us, slow, them] = in_turn(rounds, |i| match programs.get(i) {
        Some(Some(program)) => {
            let cost = sinew::time(program, &arguments)?;
            our_rays = cost.rays;
            Ok(cost.seconds)
        }
        None if installed => {
            let cost = probe.map_or_else(|| povray::time(&file, smooth), Ok)?;
            pov_rays = cost.rays;
            Ok(cost.seconds)
        }
        _ => Ok(f64::NAN),
    })?;
    let slow = programs[1].is_some().then_some(slow);
    let quicker = |us: &Runs| installed.then(|| Short(them.over(us).0 * our_rays / pov_rays));
    let ratio = quicker(&us);
    let portable = or_dash(slow.as_ref().and_then(quicker));
    let (pov_rays, them_shown) = (installed.then_some(pov_rays), installed.then_some(&them));
    let seconds = format!("{us} | {} | {}", or_dash(slow), or_dash(them_shown));
    let rays = format!("{our_rays} | {}", or_dash(pov_rays));
    let ratios = format!("{} | {portable}", or_dash(ratio));
    let wanted = or_dash(goal.map(|goal| format!("≥ {goal}")));
    let row = format!("{title} | POV-Ray {peer} | {seconds} | {rays} | {ratios} | {wanted}");
    report.row(if smooth { "smooth" } else { "plain" }, row);
    if let Some(goal) = goal {
        let what = if smooth { ", anti-aliased" } else { "" };
        let goal = format!("{title}{what} | POV-Ray {peer} | ≥ {goal}×");
        report.goal(&goal, ratio.context("POV-Ray is not installed"))?;
    }
    Ok([us.best(), them.best()])
}
