//! Compares pictures with the true surface on very many rays, and prints a table.
//!
//! `cargo run --release -p tracer --example certify -- [--exact] [--endless | --clouds] [RAYS
//! [THREADS [FIRST | KERNEL KIND SEED]]]`
//!
//! Scenes have the seeds from FIRST (or 0) on. With a kernel, a kind and a seed only that scene is
//! judged. Faults go to standard error. With `--exact` before the others the crossings that picking
//! uses are judged instead of those of pictures. `--endless` takes only kernels that never end, and
//! `--clouds` only their scenes of very many points, which have a hierarchy of far fields.

use field::Kernel;
use oracle::rays::{Row, Trial, check, parameters};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tracer::Picture;
use trials::scenes::{KINDS, Kind};

/// Returns the number of packets of eight rays in each scene; fewer if there are hundreds of
/// primitives.
fn packets(kind: Kind) -> usize {
    if matches!(kind, Kind::Cluster | Kind::Cloud | Kind::Patch) {
        3
    } else {
        8
    }
}

/// Returns every kind of scene.
fn all_kinds() -> impl Iterator<Item = Kind> {
    KINDS.into_iter().chain([Kind::Patch])
}

/// Finds the first crossings of rays as pictures do.
fn cast_pictures(trial: &Trial, picture: &Picture) -> Vec<Option<f64>> {
    parameters(&picture.cast(&trial.rays))
}

/// Finds the first crossings of rays as picking does.
fn cast_picking(trial: &Trial, picture: &Picture) -> Vec<Option<f64>> {
    let rays = trial.rays.iter();
    rays.map(|&(origin, direction)| picture.hits(origin, direction).first().map(|hit| hit.t))
        .collect()
}

fn main() {
    let mut args: Vec<String> = std::env::args().skip(1).collect();
    let [exact, endless, clouds] = ["--exact", "--endless", "--clouds"].map(|name| {
        let is_given = args.first().is_some_and(|a| a == name);
        if is_given {
            args.remove(0);
        }
        is_given
    });
    let cast = if exact { cast_picking } else { cast_pictures };
    let number =
        |i: usize, default: usize| args.get(i).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (rays, threads) = (number(0, 1_000_000), number(1, 1));
    if let (Some(kernel), Some(kind)) = (args.get(2), args.get(3)) {
        let kernel = Kernel::named(kernel).expect("a kernel");
        let kind = all_kinds()
            .find(|k| format!("{k:?}").eq_ignore_ascii_case(kind))
            .expect("a kind");
        let mut faults = String::new();
        let seed = number(4, 0) as u64;
        let trial = Trial::new(kernel, kind, seed, packets(kind));
        let row = check(trial, &cast, &mut faults);
        println!("{faults}{row:?}");
        return;
    }
    let first = number(2, 0);
    let kernels = Kernel::ALL.into_iter();
    let kernels =
        kernels.filter(|kernel| !(endless || clouds) || field::far_field::power(*kernel).is_some());
    let kinds = all_kinds().filter(|kind| !clouds || matches!(kind, Kind::Cloud));
    let kinds: Vec<Kind> = kinds.collect();
    let cells = kernels.flat_map(|kernel| kinds.iter().map(move |&kind| (kernel, kind)));
    let cells: Vec<(Kernel, Kind)> = cells.collect();
    let in_each: usize = cells.iter().map(|&(_, kind)| 8 * packets(kind)).sum();
    let scenes = rays.div_ceil(in_each);
    let rows = Mutex::new(vec![Row::default(); cells.len()]);
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let job = next.fetch_add(1, Ordering::Relaxed);
                    let (cell, scene) = (job % cells.len(), job / cells.len());
                    if scene >= scenes {
                        break;
                    }
                    let seed = first + scene;
                    let (kernel, kind) = cells[cell];
                    let mut faults = String::new();
                    let trial = Trial::new(kernel, kind, seed as u64, packets(kind));
                    let row = check(trial, &cast, &mut faults);
                    eprint!("{faults}");
                    if let Ok(mut rows) = rows.lock() {
                        rows[cell].add(&row);
                    }
                }
            });
        }
    });
    println!(
        "| kernel | primitives | rays | hits | missed | missed grazing | invented | \
         worst distance ÷ tolerance | undecided |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|");
    let mut total = Row::default();
    let line = |kernel: &str, kind: &str, r: &Row| {
        println!(
            "| {kernel} | {kind} | {} | {} | {} | {} | {} | {:.3} | {} |",
            r.rays, r.hits, r.missed, r.grazed, r.invented, r.worst, r.uncertain
        );
    };
    if let Ok(rows) = rows.lock() {
        for ((kernel, kind), row) in cells.iter().zip(rows.iter()) {
            line(kernel.name(), &format!("{kind:?}").to_lowercase(), row);
            total.add(row);
        }
    }
    line("all", "all", &total);
}
