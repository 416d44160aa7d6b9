//! The cost of fields that never end: against those that do, and with more elements.

use super::goal::{Goal, Wanted, short};
use super::scenes::Scenes;
use super::series::alternate;
use super::{Piece, ours, plot, povray};
use crate::shell::{find, root};
use anyhow::{Context, Result};
use std::fmt::Write;
use std::fs;

/// Scenes: name, title, and how many times the cost of the same with the Gaussian kernel the Cauchy one may be.
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
/// The plot, from the repository's root.
const PLOT: &str = "tests/bench/growth.svg";

/// Measures.
pub fn measure() -> Result<Piece> {
    let scenes = Scenes::new()?;
    let mut goals = Vec::new();
    let mut page = format!(
        "Seconds of one processor, 512×512, one ray a pixel, one light without shadows; the quickest of {ROUNDS} runs in turn. \
         The Cauchy kernel never ends, so that every element counts everywhere; the Gaussian is cut off.\n\n\
         | scene | Gaussian | Cauchy | Cauchy ÷ Gaussian |\n|---|--:|--:|--:|\n"
    );
    for (name, title, most) in CASES {
        let [ends, goes_on] = [scenes.dataset(name), goes_on(&scenes, name)?];
        let mut ends = || Ok(ours::time(&scenes.sinew, &[&ends])?.seconds);
        let mut goes_on = || Ok(ours::time(&scenes.sinew, &[&goes_on])?.seconds);
        let [ends, goes_on] = alternate(ROUNDS, [&mut ends, &mut goes_on])?;
        let ratio = goes_on.best() / ends.best();
        let (ends, goes_on) = (ends.text(), goes_on.text());
        writeln!(page, "| {title} | {ends} | {goes_on} | {} |", short(ratio))?;
        goals.push(Goal {
            what: format!("{title}, Cauchy"),
            against: "the same, Gaussian".into(),
            wanted: Wanted::AtMost(most),
            unit: "×",
            measured: Ok(ratio),
        });
    }
    page.push('\n');
    goals.push(Goal {
        what: format!("{PEERS}, Cauchy"),
        against: "POV-Ray's blob, which ends".into(),
        wanted: Wanted::AtMost(1.0),
        unit: "×",
        measured: against_povray(&scenes)?,
    });
    page += &growth(&scenes)?;
    Ok((goals, page))
}

/// Writes a scene with the Cauchy kernel, and returns its dataset.
fn goes_on(scenes: &Scenes, name: &str) -> Result<String> {
    let known = format!("{name}-cauchy");
    let path = scenes.path(&format!("{known}.rat"));
    if !path.exists() {
        let text = fs::read_to_string(scenes.path(&format!("{name}.rat")))?;
        fs::write(&path, text.replace("kernel gauss", "kernel cauchy"))?;
    }
    Ok(scenes.dataset(&known))
}

fn against_povray(scenes: &Scenes) -> Result<Result<f64, String>> {
    if find("povray").is_none() {
        return Ok(Err("POV-Ray is not installed".into()));
    }
    let file = scenes.path(&format!("{PEERS}-blob.pov"));
    fs::write(&file, povray::blob(&scenes.compiled(PEERS)?, 1)?)?;
    let goes_on = goes_on(scenes, PEERS)?;
    let mut own = || Ok(ours::time(&scenes.sinew, &[&goes_on])?.seconds);
    let mut other = || Ok(povray::time(&file, false)?.seconds);
    let [own, other] = alternate(3, [&mut own, &mut other])?;
    Ok(Ok(own.best() / other.best()))
}

/// The table and the plot of cost and memory by the number of elements.
fn growth(scenes: &Scenes) -> Result<String> {
    let mut page = format!(
        "### More elements\n\nBalls spread evenly through a cube, {APART} radii apart (`sinew time --balls`), {SIDE}² pixels, one ray a \
         pixel: seconds, and the most memory that the program had.\n\n\
         | balls | Gaussian, s | Cauchy, s | Gaussian, MiB | Cauchy, MiB |\n|--:|--:|--:|--:|--:|\n"
    );
    let mut seconds = [Vec::new(), Vec::new()];
    let mut memory = [Vec::new(), Vec::new()];
    for balls in BALLS {
        let count = balls.to_string();
        let mut told = [
            [String::new(), String::new()],
            [String::new(), String::new()],
        ];
        for (i, kernel) in ["gauss", "cauchy"].into_iter().enumerate() {
            let arguments = [
                "--balls", &count, "--kernel", kernel, "--apart", APART, "--size", SIDE, SIDE,
            ];
            let runs = [0, 1].map(|_| ours::time(&scenes.sinew, &arguments));
            let [first, second] = runs;
            let (first, second) = (first?, second?);
            let best = first.seconds.min(second.seconds);
            seconds[i].push([f64::from(balls), best]);
            told[0][i] = short(best);
            told[1][i] = match first.memory {
                Some(bytes) => {
                    let size = bytes / f64::from(1 << 20);
                    memory[i].push([f64::from(balls), size]);
                    short(size)
                }
                None => "–".into(),
            };
        }
        let [[a, b], [c, d]] = told;
        writeln!(page, "| {balls} | {a} | {b} | {c} | {d} |")?;
    }
    let curve = |title: &str, points: &[[f64; 2]]| plot::Curve {
        title: title.into(),
        points: points.to_vec(),
    };
    let panels = [("seconds", &seconds), ("MiB", &memory)].map(|(title, both)| plot::Panel {
        title: title.into(),
        across: "balls".into(),
        curves: vec![curve("Gaussian", &both[0]), curve("Cauchy", &both[1])],
    });
    let path = root().join(PLOT);
    fs::write(&path, plot::svg(&panels)).with_context(|| format!("{PLOT} cannot be written"))?;
    writeln!(
        page,
        "\n![Cost and memory by the number of balls]({PLOT})\n"
    )?;
    Ok(page)
}
