//! The cost of a step of a tool: the same brush, in vertices, on 10,000 and on 1,000,000 faces, and
//! a step that touches 2,000 vertices against a plain pass over as many. Medians, a JSON object a
//! line; best run with `--release`, or by `cargo xtask bench sculpt`.

use glam::DVec3;
use sculpt::{Action, Clay, Decay, Drag, Form, PathPoint, Shape, Start, Sweep, Tool};
use std::time::Instant;

/// Returns a ball with about so many faces.
fn ball(faces: u32) -> Clay {
    let n = (f64::from(faces) / 8.0).sqrt().round() as u32;
    Clay::of_shape(&Start::new(Shape::Sphere, n)).expect("a ball")
}

/// Returns a tool whose range holds about so many vertices of the ball where it touches it.
fn sweep(clay: &Clay, action: Action, vertices: f64) -> Sweep {
    // A cap of the height h has a share of h / 2 of the ball, and the radius √(2 h).
    let share = vertices / clay.mesh().vertex_count() as f64;
    let radius = (4.0 * share).sqrt();
    let mut sweep = Sweep::new(action, Tool::new(Form::Sphere, DVec3::splat(0.6 * radius)));
    sweep.decay = Decay::Bell;
    sweep.range = 0.4 * radius;
    sweep
}

/// The median seconds of a step for each vertex that it and the step before move, that of a step,
/// and the median number of these vertices. The steps are in proportion to the tool, so that on any
/// number of faces the same happens.
fn step(clay: &mut Clay, sweep: &Sweep) -> (f64, f64, usize) {
    let radius = sweep.range / 0.4;
    let mut seen = Vec::new();
    for k in 0..31 {
        let angle = 0.2 * f64::from(k);
        // Pushed and smoothed from just above, pulled from within.
        let [from, to] = match sweep.action {
            Action::Pull => [1.0, 1.0 + 0.1 * radius],
            _ => [1.0 + 0.2 * radius, 1.0 + 0.1 * radius],
        }
        .map(|t| PathPoint::new(DVec3::new(libm::cos(angle) * t, libm::sin(angle) * t, 0.0)));
        let before: Vec<DVec3> = positions(clay);
        let mut drag = Drag::new(clay, sweep);
        // As on a stroke, the step before has brought what is touched into the processor's cache.
        drag.step(clay, from);
        let start = Instant::now();
        drag.step(clay, to);
        let seconds = start.elapsed().as_secs_f64();
        let moved = positions(clay)
            .iter()
            .zip(&before)
            .filter(|(a, b)| a != b)
            .count();
        drag.finish(clay);
        if moved > 0 {
            seen.push((seconds / moved as f64, seconds, moved));
        }
    }
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    seen[seen.len() / 2]
}

fn positions(clay: &Clay) -> Vec<DVec3> {
    let mesh = clay.mesh();
    mesh.vertices().map(|v| mesh.position(v)).collect()
}

/// The median seconds of a pass that adds a vector to so many positions.
fn pass(count: usize) -> f64 {
    let mut places: Vec<DVec3> = (0..count).map(|i| DVec3::splat(i as f64)).collect();
    let mut times: Vec<f64> = (0..101)
        .map(|k| {
            let start = Instant::now();
            let way = DVec3::splat(f64::from(k));
            for p in &mut places {
                *p += way * (1.0 / (1.0 + p.length_squared()));
            }
            std::hint::black_box(&mut places);
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[50]
}

fn main() {
    for (name, action) in [
        ("push", Action::Push),
        ("pull", Action::Pull),
        ("smooth", Action::Smooth),
    ] {
        for vertices in [200.0, 2000.0] {
            // Whole balls: a tool meets nothing where an earlier one has left a dent.
            let [mut small, mut large] = [10_000, 1_000_000].map(ball);
            let of_small = sweep(&small, action, vertices);
            let (each_a, a, moved_a) = step(&mut small, &of_small);
            let of_large = sweep(&large, action, vertices);
            let (each_b, b, moved_b) = step(&mut large, &of_large);
            let plain = pass(moved_b);
            println!(
                "{{\"action\": \"{name}\", \"small\": {moved_a}, \"small_ms\": {:.4}, \
                 \"large\": {moved_b}, \"large_ms\": {:.4}, \
                 \"times\": {:.3}, \"passes\": {:.1}}}",
                1e3 * a,
                1e3 * b,
                each_b / each_a,
                b / plain,
            );
        }
    }
}
