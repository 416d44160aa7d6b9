//! Measures the time of a frame and of an operation as [`Simulation::work`] counts them:
//! `cargo run --release -p motion --example speed`. The limits on the work of a text rest on it.

use glam::DVec3;
use motion::{Body, Obstacle, Settings, Setup, Simulation};
use skeleton::{Node, Scheme, Skeleton};
use std::time::Instant;

fn body(nodes: impl Iterator<Item = DVec3>) -> Body {
    let nodes = nodes.map(|position| Node {
        position,
        radius: 0.2,
    });
    let nodes: Vec<Node> = nodes.collect();
    let curves = vec![(0..nodes.len()).collect()];
    Body {
        skeleton: Skeleton { nodes, curves },
        scheme: Scheme::Cubic,
        pinned: Vec::new(),
    }
}

/// Returns a spiral that falls into a heap.
fn spiral(count: usize, boxes: u32) -> (Vec<Body>, Vec<Obstacle>) {
    let boxes = (0..boxes).map(|i| Obstacle::Box {
        center: DVec3::new(f64::from(i), -1.0, 0.0),
        axes: [DVec3::X, DVec3::Y, DVec3::Z],
    });
    (
        vec![body((0..count).map(|i| {
            let t = i as f64 * 0.9;
            let radius = 1.0 + 0.01 * t;
            DVec3::new(radius * libm::cos(t), 1.0 + 0.12 * t, radius * libm::sin(t))
        }))],
        boxes.collect(),
    )
}

/// Worms that lie across each other in one place, all of whose flesh touches.
fn knot(count: usize) -> (Vec<Body>, Vec<Obstacle>) {
    const NODES: usize = 10;
    (
        (0..count / NODES)
            .map(|number| {
                let angle = number as f64 * 2.4;
                let along = DVec3::new(
                    libm::cos(angle),
                    0.3 * libm::sin(3.0 * angle),
                    libm::sin(angle),
                );
                body((0..NODES).map(move |i| DVec3::Y + along * (0.2 * (i as f64 - 4.5))))
            })
            .collect(),
        Vec::new(),
    )
}

fn measure(
    name: &str,
    (bodies, mut obstacles): (Vec<Body>, Vec<Obstacle>),
) -> Result<(), motion::Error> {
    obstacles.push(Obstacle::Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    });
    let setup = Setup {
        bodies,
        obstacles,
        settings: Settings::default(),
    };
    let start = Instant::now();
    let mut simulation = Simulation::new(&setup)?;
    let begun = start.elapsed().as_secs_f64();
    let frames = 50;
    let start = Instant::now();
    for _ in 0..frames {
        simulation.advance(&[]);
    }
    let frame = start.elapsed().as_secs_f64() / f64::from(frames);
    let sum = simulation
        .positions()
        .iter()
        .fold(DVec3::ZERO, |a, b| a + b);
    println!(
        "{name}: {:.2} ms to begin, {:.3} ms a frame, {:.2} ns an operation; ends at {sum}",
        begun * 1e3,
        frame * 1e3,
        frame * 1e9 / simulation.work() as f64
    );
    Ok(())
}

fn main() -> Result<(), motion::Error> {
    for (count, boxes) in [(8, 0), (20, 4), (60, 20), (199, 100)] {
        let name = format!("spiral of {count} nodes, {boxes} boxes");
        measure(&name, spiral(count, boxes))?;
    }
    for count in [20, 60, 200] {
        measure(&format!("knot of {count} nodes"), knot(count))?;
    }
    Ok(())
}
