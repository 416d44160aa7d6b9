//! Fits the trial head to points without outliers by plain squares, and writes the problem for
//! another program to solve.
//!
//! `cargo run --release -p fit --example peer -- problem.json` prints the seconds that the fit
//! took; the comparison is `tests/bench/fit_scipy.py`.

use fit::recovery::{Trial, Way};
use fit::{Deformation, Kind, Loss, trial};
use serde_json::json;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("give a file to write")?;
    let truth = Trial::new(2000, 6667, 0.0)?;
    let head = trial::head(2000);
    let cage = trial::cage();
    let way = Way {
        kind: Kind::Explicit,
        sharpness: 20.0,
        loss: Loss::Squares,
        outlines: false,
    };
    let problem = truth.problem(&head, way)?;
    // The other program is given the deformation's coefficients, too.
    let start = Instant::now();
    let fitted = fit::fit(&problem, &mut |_| true)?;
    let seconds = start.elapsed().as_secs_f64();
    let deformation = Deformation::new(&head.positions, &cage.positions)?;
    let mut weights = Vec::new();
    for vertex in 0..deformation.vertices() {
        let row = deformation.weights(vertex).iter();
        weights.extend(row.map(|(control, weight)| json!([vertex, control, weight])));
    }
    let [vertices, points, moves] = [&head.positions[..], truth.points(), &fitted.moves]
        .map(|points| points.iter().map(glam::DVec3::to_array).collect::<Vec<_>>());
    let problem = json!({
        "vertices": vertices,
        "triangles": head.triangles,
        "controls": cage.positions.len(),
        "weights": weights,
        "points": points,
        "stiffness": problem.stiffness(),
        "smooth": fitted.smooth,
        "moves": moves,
    });
    std::fs::write(path, problem.to_string())?;
    println!(
        "{}",
        json!({ "seconds": seconds, "iterations": fitted.last.iteration })
    );
    Ok(())
}
