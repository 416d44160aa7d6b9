//! Recovers a head from points and outlines whose true shape is known, seen in several ways: the
//! tables of BENCHMARKS.md; and other shapes from measurements of which many are wrong.
//!
//! `cargo run --release -p fit --example recovery`; with `json` as JSON.

use fit::recovery::{NOISE, Trial, Way, coarse};
use fit::{Deformation, Disturbance, Kind, Loss, Options, Rigid, cage, shapes, trial};
use glam::{DMat3, DVec3};
use mesh::TriangleMesh;
use serde_json::{Value, json};

fn main() -> Result<(), fit::Error> {
    let as_json = std::env::args().nth(1).is_some_and(|word| word == "json");
    let truth = Trial::new(2000, 6667, 0.1)?;
    let models = [
        ("2,000 facets, those of the truth", trial::head(2000)),
        ("420 uneven facets", coarse(420)?),
    ];
    const SHELLS: Kind = Kind::Triangular { thickness: 0.0 };
    let ways = [
        ("explicit, squares", Kind::Explicit, 20.0, Loss::Squares),
        ("spherical, 1 − F", Kind::Spherical, 20.0, Loss::Algebraic),
        ("triangular, 1 − F", SHELLS, 20.0, Loss::Algebraic),
        ("explicit", Kind::Explicit, 20.0, Loss::Saturating),
        ("spherical", Kind::Spherical, 20.0, Loss::Saturating),
        ("triangular", SHELLS, 20.0, Loss::Saturating),
        ("triangular, k three times", SHELLS, 60.0, Loss::Saturating),
    ];
    let mut rows: Vec<Value> = Vec::new();
    for (name, model) in models {
        let [near, gap] = truth.start(&model);
        rows.push(json!({
            "mesh": name, "kind": "before the fit", "error": near, "gap": gap,
        }));
        for outlines in [true, false] {
            for (kind, seen, sharpness, loss) in ways {
                let way = Way {
                    kind: seen,
                    sharpness,
                    loss,
                    outlines,
                };
                let found = truth.run(&model, way)?;
                rows.push(json!({
                    "mesh": name,
                    "kind": kind,
                    "outlines": outlines,
                    "error": found.mesh,
                    "gap": found.gap,
                    "surface": found.surface,
                    "iterations": found.iterations,
                }));
            }
        }
    }
    let robust = survey()?;
    let [controls, points, sights] = truth.counts();
    if as_json {
        println!(
            "{}",
            json!({
                "controls": controls, "points": points, "sights": sights, "noise": NOISE,
                "rows": rows, "robust": robust
            })
        );
        return Ok(());
    }
    println!("{controls} controls, {points} points, {sights} lines of sight, σ = {NOISE}");
    for row in rows.iter().chain(&robust) {
        println!("{row}");
    }
    Ok(())
}

/// Fits four shapes to measurements with many outliers, uneven noise, a gap, from a turned start,
/// with thick shells, and to outlines alone.
fn survey() -> Result<Vec<Value>, fit::Error> {
    const SHELLS: Kind = Kind::Triangular { thickness: 0.0 };
    let clean = Disturbance {
        noise: NOISE,
        seed: 8,
        ..Disturbance::default()
    };
    let worst = Disturbance {
        outliers: 0.4,
        uneven: 0.8,
        gap: 0.25,
        ..clean
    };
    let thick = Kind::Triangular {
        thickness: 2.0 * NOISE,
    };
    let cases = [
        (
            "15 % outliers",
            SHELLS,
            Disturbance {
                outliers: 0.15,
                ..clean
            },
            false,
            [true, false],
        ),
        (
            "25 % outliers",
            SHELLS,
            Disturbance {
                outliers: 0.25,
                ..clean
            },
            false,
            [true, false],
        ),
        (
            "40 % outliers",
            SHELLS,
            Disturbance {
                outliers: 0.4,
                ..clean
            },
            false,
            [true, false],
        ),
        ("the same, gap, turned", SHELLS, worst, true, [true, false]),
        (
            "shells 2 σ thick",
            thick,
            Disturbance {
                outliers: 0.1,
                ..clean
            },
            false,
            [true, false],
        ),
        (
            "balls",
            Kind::Spherical,
            Disturbance {
                outliers: 0.1,
                ..clean
            },
            false,
            [true, false],
        ),
        ("outlines alone", SHELLS, clean, false, [false, true]),
    ];
    let mut rows = Vec::new();
    for (name, model) in [
        ("head", trial::head(2000)),
        ("ball", shapes::ball(0.13)),
        ("hand", shapes::hand(0.06)),
        ("vase", shapes::vase(0.09)),
    ] {
        let cage = cage(&model.positions, &model.triangles, 60);
        let deformation = Deformation::new(&model.positions, &cage.positions)?;
        let size = model.bounds().size().z;
        let moves = trial::moves(&cage.positions, 0.05 * size, 11);
        let moved = deformation.apply(&model.positions, &moves);
        let truth = TriangleMesh::new(moved, model.triangles.clone());
        for (measured, kind, disturbance, is_turned, data) in cases {
            let mut trial = Trial::of(&truth, cage.clone(), 5000, disturbance);
            if is_turned {
                let (sine, cosine) = libm::sincos(20_f64.to_radians());
                let [x, y] = [
                    DVec3::new(cosine, sine, 0.0),
                    DVec3::new(-sine, cosine, 0.0),
                ];
                trial = trial.turn(&Rigid {
                    turn: DMat3::from_cols(x, y, DVec3::Z),
                    shift: 0.1 * size * DVec3::new(2.0, -1.0, 2.0) / 3.0,
                });
            }
            let options = Options {
                kind,
                ..Options::default()
            };
            let [start, _] = trial.start(&model);
            let (_, found) = trial.run_with(&model, options, data)?;
            rows.push(json!({
                "shape": name,
                "measured": measured,
                "start": start,
                "error": found.mesh,
                "surface": found.surface,
                "iterations": found.iterations,
                "failed": found.failed,
            }));
        }
    }
    Ok(rows)
}
