//! The tracer against other programs, and against itself with more elements, samples and other root
//! finders.

use super::goal::{Goal, Wanted, short};
use super::scenes::{FLAKES, Scenes};
use super::series::{ROUNDS, Runs, alternate};
use super::{Piece, ours, povray};
use crate::examples;
use crate::shell::{PORTABLE, find};
use anyhow::Result;
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// A scene, what POV-Ray makes of it, and how many times quicker we want to be.
struct Case {
    scene: &'static str,
    title: &'static str,
    peer: &'static str,
    pov: Pov,
    goal: Option<f64>,
}

#[derive(Clone, Copy)]
enum Pov {
    /// A `blob`; arcs as so many cylinders.
    Blob(u32),
    /// An `isosurface` of the exact field.
    Isosurface,
}

const fn flake(scene: &'static str, title: &'static str, goal: Option<f64>) -> Case {
    Case {
        scene,
        title,
        peer: "POV-Ray blob",
        pov: Pov::Blob(1),
        goal,
    }
}

const CASES: [Case; 9] = [
    flake("flake-1", "sphereflake 1", None),
    flake("flake-10", "sphereflake 10", None),
    flake("flake-91", "sphereflake 91", None),
    flake("flake-820", "sphereflake 820", Some(4.0)),
    flake("flake-7381", "sphereflake 7381", Some(3.0)),
    flake("coral", "coral, 543 Gaussian lines", Some(3.0)),
    Case {
        scene: "seahorse",
        title: "seahorse, 40 exact Cauchy arcs",
        peer: "POV-Ray blob, arcs as 4 cylinders",
        pov: Pov::Blob(4),
        goal: None,
    },
    Case {
        scene: "seahorse",
        title: "seahorse, 40 exact Cauchy arcs",
        peer: "POV-Ray blob, arcs as 12 cylinders",
        pov: Pov::Blob(12),
        goal: Some(3.0),
    },
    Case {
        scene: "tee",
        title: "T, 2 exact Cauchy lines",
        peer: "POV-Ray isosurface",
        pov: Pov::Isosurface,
        goal: Some(60.0),
    },
];

/// Measures all of it.
pub fn measure() -> Result<Piece> {
    let scenes = Scenes::new()?;
    let mut goals = Vec::new();
    let mut page = format!(
        "Seconds of one processor, 512×512, one light without shadows, nothing written; the quickest of \
         up to {ROUNDS} runs in turn, and how much longer the middle one took. Ours (`sinew time`) with what it takes \
         to prepare the scene; POV-Ray's (`povray {}`) without. The scenes are \
         `tests/bench/*.rat`; how they are told to POV-Ray stands in `crate/xtask/src/bench/povray.rs`.\n\n",
        povray::options(false).join(" ")
    );
    page += "Ours is built for this machine's processor, as `.cargo/config.toml` says; the columns called portable are of the \
             same program built with `RUSTFLAGS=\"-C target-cpu=x86-64\"`, for any. It draws the same pictures, bit for \
             bit. POV-Ray is what its package brings, as a rule built for any processor, too.\n\n";
    let portable = cfg!(target_arch = "x86_64")
        .then(|| examples::sinew_built(PORTABLE))
        .transpose()?;
    let mut best = HashMap::new();
    for smooth in [false, true] {
        let programs = (&scenes, portable.as_deref());
        against_povray(programs, smooth, &mut goals, &mut page, &mut best)?;
    }
    growth(&best, &mut goals);
    hierarchy(&scenes, &mut goals, &mut page)?;
    diggers(&scenes, &mut goals, &mut page)?;
    Ok((goals, page))
}

/// Seconds by scene; for POV-Ray by `pov SCENE`.
type Best = HashMap<String, f64>;

fn against_povray(
    (scenes, portable): (&Scenes, Option<&Path>),
    smooth: bool,
    goals: &mut Vec<Goal>,
    page: &mut String,
    best: &mut Best,
) -> Result<()> {
    let installed = find("povray").is_some();
    if smooth {
        write!(
            page,
            "### With anti-aliasing\n\nPOV-Ray with `{}`; ours with up to 4×4 rays a pixel and the contrast that \
             brings the number of rays nearest to POV-Ray's. The ratio is that of the times for a ray.\n\n",
            povray::options(true)[4..8].join(" ")
        )?;
    } else {
        *page += "### One ray a pixel\n\n";
    }
    *page += "| scene | peer | ours | ours, portable | peer's | rays, ours | rays, peer's | times quicker | portable | goal |\n\
              |---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for case in &CASES {
        let dataset = scenes.dataset(case.scene);
        let file = scenes.path(&format!("{}-{}.pov", case.scene, pieces(case.pov)));
        let compiled = scenes.compiled(case.scene)?;
        let text = match case.pov {
            Pov::Blob(pieces) => povray::blob(&compiled, pieces)?,
            Pov::Isosurface => povray::cauchy_lines(&compiled)?,
        };
        std::fs::write(&file, text)?;

        let mut arguments = vec![dataset];
        let mut probe = None;
        if smooth {
            arguments.push(String::from("--pass=smooth"));
            if installed {
                // One run before the others tells how many rays ours should have.
                let cost = povray::time(&file, true)?;
                arguments.push(format!("--rays={}", cost.rays));
                probe = Some(cost);
            }
        }
        let mut pov_rays = f64::NAN;
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let mut our_rays = f64::NAN;
        let mut our = || {
            let cost = ours::time(&scenes.sinew, &arguments)?;
            our_rays = cost.rays;
            Ok(cost.seconds)
        };
        let mut slow = || Ok(ours::time(portable.unwrap_or(&scenes.sinew), &arguments)?.seconds);
        let mut pov = || {
            // An isosurface takes long, with anti-aliasing so long that once is enough.
            let cost = match (case.pov, probe) {
                (Pov::Isosurface, Some(probe)) => probe,
                _ => povray::time(&file, smooth)?,
            };
            pov_rays = cost.rays;
            Ok(cost.seconds)
        };
        let rounds = match case.pov {
            Pov::Blob(_) if !smooth => ROUNDS,
            _ => 3,
        };
        let (us, slow, them) = if installed {
            let [us, slow, them] = alternate(rounds, [&mut our, &mut slow, &mut pov])?;
            (us, slow, Some(them))
        } else {
            let [us, slow] = alternate(rounds, [&mut our, &mut slow])?;
            (us, slow, None)
        };
        let slow = portable.map(|_| slow);
        let quicker = |us: &Runs| {
            let them = them.as_ref()?;
            Some((them.best() / pov_rays) / (us.best() / our_rays))
        };
        let ratio = quicker(&us);
        let row = format!(
            "| {} | {} | {} | {} | {} | {our_rays:.0} | {} | {} | {} | {} |",
            case.title,
            case.peer,
            us.text(),
            slow.as_ref().map_or("–".into(), Runs::text),
            them.as_ref().map_or("not installed".into(), Runs::text),
            them.as_ref()
                .map_or("–".into(), |_| format!("{pov_rays:.0}")),
            ratio.map_or("–".into(), short),
            slow.as_ref().and_then(quicker).map_or("–".into(), short),
            case.goal.map_or("–".into(), |goal| format!("≥ {goal}")),
        );
        println!("{row}");
        *page += &row;
        page.push('\n');
        if !smooth {
            best.insert(case.scene.into(), us.best());
            if let Some(them) = &them {
                best.insert(format!("pov {}", case.scene), them.best());
            }
        }
        if let Some(goal) = case.goal {
            goals.push(Goal {
                what: case.title.to_owned() + if smooth { ", anti-aliased" } else { "" },
                against: case.peer.into(),
                wanted: Wanted::AtLeast(goal),
                unit: "×",
                measured: ratio.ok_or_else(|| String::from("POV-Ray is not installed")),
            });
        }
    }
    page.push('\n');
    Ok(())
}

fn pieces(pov: Pov) -> u32 {
    match pov {
        Pov::Blob(pieces) => pieces,
        Pov::Isosurface => 0,
    }
}

/// How the time grows with the number of elements.
fn growth(best: &Best, goals: &mut Vec<Goal>) {
    let of = |program: &str| {
        let [few, many] =
            ["flake-10", "flake-7381"].map(|scene| best.get(&format!("{program}{scene}")));
        Some(many? / few?)
    };
    let pov = of("pov ").map_or("POV-Ray".into(), |growth| {
        format!("POV-Ray grows {}×", short(growth))
    });
    goals.push(Goal {
        what: "sphereflake 10 → 7381, growth of the time".into(),
        against: pov,
        wanted: Wanted::AtMost(1.5),
        unit: "×",
        measured: of("").ok_or_else(|| String::from("not timed")),
    });
}

/// Gain of groups of far primitives and of shared interpolants.
fn hierarchy(scenes: &Scenes, goals: &mut Vec<Goal>, page: &mut String) -> Result<()> {
    let dataset = scenes.dataset("flake-820-cauchy");
    let with = [dataset.as_str()];
    let without = [dataset.as_str(), "--hierarchy=off"];
    let mut with = || Ok(ours::time(&scenes.sinew, &with)?.seconds);
    let mut without = || Ok(ours::time(&scenes.sinew, &without)?.seconds);
    let [with, without] = alternate(3, [&mut with, &mut without])?;
    let ratio = without.best() / with.best();
    writeln!(
        page,
        "### Far fields\n\nThe sphereflake of 820 balls with the Cauchy kernel, which nowhere ends: far balls judged in \
         groups and interpolated for many rays at once, or each followed by itself (`--hierarchy off`).\n\n\
         | with | without | ratio |\n|--:|--:|--:|\n| {} | {} | {} |\n",
        with.text(),
        without.text(),
        short(ratio)
    )?;
    goals.push(Goal {
        what: "sphereflake 820, Cauchy".into(),
        against: "our own without far-field hierarchy".into(),
        wanted: Wanted::AtLeast(5.0),
        unit: "×",
        measured: Ok(ratio),
    });
    Ok(())
}

/// Our root finder against that of Kalra and Barr, on the thesis's series (table 4.4).
fn diggers(scenes: &Scenes, goals: &mut Vec<Goal>, page: &mut String) -> Result<()> {
    *page += "### Root finders\n\nThe certified digger against our own `digger LG` (Kalra and Barr 1989), \
              full pictures, one ray a pixel. Thesis, table 4.4: 3.0 to 3.6.\n\n";
    let mut worst: Result<f64, String> = Ok(f64::INFINITY);
    let mut rows = String::new();
    for balls in FLAKES {
        let name = format!("flake-{balls}");
        let hermite = scenes.dataset(&name);
        let lg = scenes.variant(&name, "digger LG", &format!("{name}-lg"))?;
        if let Some(complaint) = scenes.complaint(&lg, "digger") {
            worst = Err(format!("there is no such digger: {complaint}"));
            break;
        }
        let mut hermite = || Ok(ours::time(&scenes.sinew, &[&hermite])?.seconds);
        let mut lg = || Ok(ours::time(&scenes.sinew, &[&lg])?.seconds);
        let [hermite, lg] = alternate(3, [&mut hermite, &mut lg])?;
        let ratio = lg.best() / hermite.best();
        worst = worst.map(|worst| worst.min(ratio));
        let row = format!(
            "| {balls} | {} | {} | {} |\n",
            hermite.text(),
            lg.text(),
            short(ratio)
        );
        print!("{row}");
        rows += &row;
    }
    if let Err(reason) = &worst {
        writeln!(page, "Not measured: {reason}.\n")?;
    } else {
        writeln!(
            page,
            "| balls | hermite | LG | ratio |\n|--:|--:|--:|--:|\n{rows}"
        )?;
    }
    goals.push(Goal {
        what: "sphereflake series, the least of the ratios".into(),
        against: "our own `digger LG`".into(),
        wanted: Wanted::AtLeast(4.0),
        unit: "×",
        measured: worst,
    });
    Ok(())
}
