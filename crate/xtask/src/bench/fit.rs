//! Meshes fitted to points and outlines: the recovery of a known shape, the time against scipy's solver, and how the cost of
//! tracing an implicit mesh grows with its facets.

use super::goal::{Goal, Wanted, short};
use super::scenes::Scenes;
use super::{Piece, ours};
use crate::shell::{cargo, command, run_and_read};
use anyhow::{Context, Result};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Facets of the traced implicit meshes.
const FACETS: [u32; 4] = [2000, 8000, 30_000, 100_000];
/// Most that the last of them may take, in times of the first.
const GROWTH: f64 = 3.0;

/// Measures.
pub fn measure() -> Result<Piece> {
    let folder = std::env::temp_dir().join(format!("sinew-fit-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let measured = measure_in(&folder);
    // Leftovers in the temporary folder do no harm.
    let _ = std::fs::remove_dir_all(&folder);
    measured
}

fn measure_in(folder: &Path) -> Result<Piece> {
    let mut goals = Vec::new();
    let mut page = String::new();
    recovery(&mut goals, &mut page)?;
    peer(folder, &mut goals, &mut page)?;
    growth(folder, &mut goals, &mut page)?;
    Ok((goals, page))
}

fn example(name: &str, arguments: &[&str]) -> Result<String> {
    let mut run = cargo(&[
        "run",
        "--release",
        "--quiet",
        "-p",
        "fit",
        "--example",
        name,
        "--",
    ]);
    run_and_read(run.args(arguments))
}

fn recovery(goals: &mut Vec<Goal>, page: &mut String) -> Result<()> {
    let found: Value = serde_json::from_str(example("recovery", &["json"])?.trim())?;
    writeln!(
        page,
        "A head of 2,000 facets is deformed by {} control points and measured: {} points with noise of σ = {} in each \
         coordinate, a tenth of them outliers, a quarter of the head unseen, and {} lines of sight of six outlines. Two \
         meshes are fitted, from their shape before the deformation: the head's own, and one of 420 uneven facets. Errors are \
         distances of 4,000 points of the true shape (root of the mean square) from the fitted mesh, in σ; *surface* is \
         their distance from the implicit surface that was fitted. *Squares* sums squares of distances; all others let \
         distances count less beyond a scale, which falls as the fit goes on.\n",
        found["controls"], found["points"], found["noise"], found["sights"],
    )?;
    page.push_str(
        "| mesh | seen as | fitted to | error, σ | in the gap, σ | surface, σ | iterations |\n|---|---|---|--:|--:|--:|--:|\n",
    );
    let rows = found["rows"].as_array().cloned().unwrap_or_default();
    for row in &rows {
        let number = |key: &str| row[key].as_f64().map_or("–".into(), short);
        let to = match row["outlines"].as_bool() {
            Some(true) => "points, outlines",
            Some(false) => "points",
            None => "–",
        };
        writeln!(
            page,
            "| {} | {} | {to} | {} | {} | {} | {} |",
            row["mesh"].as_str().unwrap_or_default(),
            row["kind"].as_str().unwrap_or_default(),
            number("error"),
            number("gap"),
            number("surface"),
            row["iterations"]
                .as_u64()
                .map_or("–".into(), |n| n.to_string()),
        )?;
    }
    page.push('\n');
    let error = |mesh: &str, kind: &str| {
        let is_it = |row: &&Value| {
            row["mesh"].as_str().is_some_and(|m| m.starts_with(mesh))
                && row["kind"] == kind
                && row["outlines"] == true
        };
        let row = rows.iter().find(is_it);
        row.and_then(|row| row["error"].as_f64())
            .ok_or_else(|| String::from("not in the table"))
    };
    let ratio = |other: &str| -> Result<f64, String> {
        Ok(error("420", other)? / error("420", "triangular")?)
    };
    goals.push(Goal {
        what: "error of a head that is found again, thin shells".into(),
        against: "the noise σ, away from the gap".into(),
        wanted: Wanted::AtMost(1.5),
        unit: " σ",
        measured: error("2,000", "triangular"),
    });
    goals.push(Goal {
        what: "coarse mesh: error of balls".into(),
        against: "thin shells".into(),
        wanted: Wanted::AtLeast(2.0),
        unit: "×",
        measured: ratio("spherical"),
    });
    goals.push(Goal {
        what: "coarse mesh: error of nearest facets, squares".into(),
        against: "thin shells".into(),
        wanted: Wanted::AtLeast(1.3),
        unit: "×",
        measured: ratio("explicit, squares"),
    });
    Ok(())
}

fn peer(folder: &Path, goals: &mut Vec<Goal>, page: &mut String) -> Result<()> {
    let path = folder.join("problem.json");
    let path = path.to_string_lossy();
    let own: Value = serde_json::from_str(example("peer", &[&path])?.trim())?;
    let seconds = own["seconds"].as_f64().context("no seconds")?;
    let python = std::env::var("SINEW_PYTHON").unwrap_or_else(|_| "python3".into());
    let has_scipy = command(&python, &["-c", "import scipy"])
        .output()
        .is_ok_and(|output| output.status.success());
    let other = if has_scipy {
        let said = run_and_read(&mut command(&python, &["tests/bench/fit_scipy.py", &path]))?;
        let other: Value = serde_json::from_str(said.trim())?;
        writeln!(
            page,
            "The same head and noise without outliers, explicit and with plain squares of the points' distances, solved by \
             `scipy.optimize.least_squares` (trust region, sparse analytic Jacobian, LSMR; \
             `tests/bench/fit_scipy.py`): {} s to a sum of {}, here {} s to {}, with the control points' coordinates.\n",
            other["seconds"].as_f64().map_or("–".into(), short),
            other["sum"]
                .as_f64()
                .map_or("–".into(), |v| format!("{v:.4}")),
            short(seconds),
            other["ours"]
                .as_f64()
                .map_or("–".into(), |v| format!("{v:.4}")),
        )?;
        other["seconds"]
            .as_f64()
            .ok_or_else(|| String::from("scipy gave no seconds"))
    } else {
        page.push_str("`scipy.optimize.least_squares`: skipped, as Python or scipy is missing (SINEW_PYTHON names another Python).\n\n");
        Err(String::from("scipy is missing"))
    };
    goals.push(Goal {
        what: "fit of 2,000 facets to 5,000 points".into(),
        against: "scipy.optimize.least_squares".into(),
        wanted: Wanted::AtLeast(10.0),
        unit: "×",
        measured: other.map(|other| other / seconds),
    });
    Ok(())
}

fn growth(folder: &Path, goals: &mut Vec<Goal>, page: &mut String) -> Result<()> {
    let scenes = Scenes::new()?;
    page.push_str(
        "Tracing a head with thin shells around its facets, d₀ and 1/k in proportion to the mean edge (d₀ = edge/10, \
         k = 20/edge), 512×512, one thread, one light with shadows:\n\n| facets | s | of these preparing | against 2,000 |\n|--:|--:|--:|--:|\n",
    );
    let mut first = None;
    let mut last = Err(String::from("not traced"));
    for facets in FACETS {
        let mesh = folder.join(format!("head-{facets}.obj"));
        example(
            "head",
            &[&facets.to_string(), &mesh.to_string_lossy(), "even"],
        )?;
        // The mean edge falls with the root of the number of facets; 2,000 have 0.17.
        let edge = 0.17 * (2000.0 / f64::from(facets)).sqrt();
        let text = format!(
            "framesize 512 512\neyep 0 -9 0.4\nvrp 0 0 -0.1\nvup 0 0 1\nfov 28\nlight White, position -6 -9 8\n\
             surface Shell, diffuse SeaGreen\nmesh Shell head-{facets}.obj metaballs triangular {} {}\n",
            0.1 * edge,
            20.0 / edge
        );
        let scene = folder.join(format!("head-{facets}.rat"));
        std::fs::write(&scene, text)?;
        let cost = ours::time(&scenes.sinew, &[&scene.to_string_lossy()])?;
        let tracing = cost.seconds - cost.prepare;
        let base = *first.get_or_insert(tracing);
        writeln!(
            page,
            "| {facets} | {} | {} | {}× |",
            short(cost.seconds),
            short(cost.prepare),
            short(tracing / base)
        )?;
        last = Ok(tracing / base);
    }
    page.push('\n');
    goals.push(Goal {
        what: "tracing 100,000 facets in thin shells".into(),
        against: "2,000 facets".into(),
        wanted: Wanted::AtMost(GROWTH),
        unit: "×",
        measured: last,
    });
    Ok(())
}
