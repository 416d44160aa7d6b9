//! The cost of a step of a tool: the same brush, in vertices, on 10,000 and on 1,000,000 faces, and a step that touches 2,000
//! vertices against a plain pass over as many. Medians; best run with `--release`.

use glam::DVec3;
use sculpt::{Action, Clay, Decay, Drag, Form, PathPoint, Shape, Start, Sweep, Tool};
use std::time::Instant;

/// A ball with about so many faces.
fn ball(faces: u32) -> Clay {
    let n = (f64::from(faces) / 8.0).sqrt().round() as u32;
    Clay::of_shape(&Start::new(Shape::Sphere, n)).expect("a ball")
}

/// A tool on the ball's equator whose range holds about so many vertices.
fn sweep(clay: &Clay, action: Action, vertices: f64) -> Sweep {
    // A cap of the height h has a share of h / 2 of the ball.
    let share = vertices / clay.mesh().vertex_count() as f64;
    let radius = (4.0 * share).sqrt();
    let mut sweep = Sweep::new(action, Tool::new(Form::Sphere, DVec3::splat(0.6 * radius)));
    sweep.decay = Decay::Bell;
    sweep.range = 0.4 * radius;
    sweep
}

/// The median seconds of a step, and how many vertices moved in one.
fn step(clay: &mut Clay, sweep: &Sweep) -> (f64, usize) {
    let mut times = Vec::new();
    let mut moved = 0;
    for k in 0..31 {
        let angle = 0.2 * f64::from(k);
        let place = |t: f64| DVec3::new(libm::cos(angle) * t, libm::sin(angle) * t, 0.0);
        let before: Vec<DVec3> = clay
            .mesh()
            .vertices()
            .map(|v| clay.mesh().position(v))
            .collect();
        let mut drag = Drag::new(clay, sweep);
        if sweep.action == Action::Pull {
            drag.step(clay, PathPoint::new(place(1.0)));
        }
        let start = Instant::now();
        drag.step(clay, PathPoint::new(place(1.02)));
        times.push(start.elapsed().as_secs_f64());
        drag.finish(clay);
        let after = clay.mesh().vertices().map(|v| clay.mesh().position(v));
        moved = after.zip(&before).filter(|(a, b)| a != *b).count();
    }
    times.sort_by(f64::total_cmp);
    (times[times.len() / 2], moved)
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
    let mut small = ball(10_000);
    let mut large = ball(1_000_000);
    for (name, action) in [
        ("push", Action::Push),
        ("pull", Action::Pull),
        ("smooth", Action::Smooth),
    ] {
        for vertices in [200.0, 2000.0] {
            let of_small = sweep(&small, action, vertices);
            let (a, moved_a) = step(&mut small, &of_small);
            let of_large = sweep(&large, action, vertices);
            let (b, moved_b) = step(&mut large, &of_large);
            let plain = pass(moved_b.max(1));
            println!(
                "{name}: {moved_a} vertices of 10⁴ faces {:.3} ms, {moved_b} of 10⁶ {:.3} ms: {:.2} times a vertex; {:.1} plain passes",
                1e3 * a,
                1e3 * b,
                (b / moved_b as f64) / (a / moved_a as f64),
                b / plain,
            );
        }
    }
}
