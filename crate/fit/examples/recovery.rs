//! Recovers a head from points and outlines whose true shape is known, seen in several ways: the
//! table of BENCHMARKS.md.
//!
//! `cargo run --release -p fit --example recovery`; with `json` as JSON.

use fit::recovery::{NOISE, Trial, Way, coarse};
use fit::{Kind, trial};
use serde_json::{Value, json};

fn main() -> Result<(), fit::Error> {
    let as_json = std::env::args().nth(1).is_some_and(|word| word == "json");
    let truth = Trial::new(2000, 6667, 0.1)?;
    let models = [
        ("2,000 facets, those of the truth", trial::head(2000)),
        ("420 uneven facets", coarse(420)?),
    ];
    let ways = [
        ("explicit, squares", Kind::Explicit, 20.0, false),
        ("explicit", Kind::Explicit, 20.0, true),
        ("spherical", Kind::Spherical, 20.0, true),
        (
            "triangular",
            Kind::Triangular { thickness: 0.0 },
            20.0,
            true,
        ),
        (
            "triangular, k three times",
            Kind::Triangular { thickness: 0.0 },
            60.0,
            true,
        ),
    ];
    let mut rows: Vec<Value> = Vec::new();
    for (name, model) in models {
        let [near, gap] = truth.start(&model);
        rows.push(json!({
            "mesh": name, "kind": "before the fit", "error": near, "gap": gap,
        }));
        for outlines in [true, false] {
            for (kind, seen, sharpness, saturates) in ways {
                let way = Way {
                    kind: seen,
                    sharpness,
                    saturates,
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
    let [controls, points, sights] = truth.counts();
    if as_json {
        println!(
            "{}",
            json!({
                "controls": controls, "points": points, "sights": sights, "noise": NOISE,
                "rows": rows
            })
        );
        return Ok(());
    }
    println!("{controls} controls, {points} points, {sights} lines of sight, σ = {NOISE}");
    for row in rows {
        println!("{row}");
    }
    Ok(())
}
