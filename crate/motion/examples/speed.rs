//! Measures the time of a frame and of an operation as [`Simulation::work`] counts them:
//! `cargo run --release -p motion --example speed`. The limits on the work of a text rest on it.

use glam::DVec3;
use motion::{Body, Obstacle, Settings, Setup, Simulation};
use skeleton::{Node, Scheme, Skeleton};
use std::time::Instant;

fn main() -> Result<(), motion::Error> {
    for (count, boxes) in [(8, 0), (20, 4), (60, 20), (199, 100)] {
        // A spiral that falls into a heap.
        let node = |i: usize| {
            let t = i as f64 * 0.9;
            let radius = 1.0 + 0.01 * t;
            let place = DVec3::new(radius * libm::cos(t), 1.0 + 0.12 * t, radius * libm::sin(t));
            Node {
                position: place,
                radius: 0.2,
            }
        };
        let skeleton = Skeleton {
            nodes: (0..count).map(node).collect(),
            curves: vec![(0..count).collect()],
        };
        let mut obstacles = vec![Obstacle::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        }];
        obstacles.extend((0..boxes).map(|i| Obstacle::Box {
            center: DVec3::new(f64::from(i), -1.0, 0.0),
            axes: [DVec3::X, DVec3::Y, DVec3::Z],
        }));
        let setup = Setup {
            bodies: vec![Body {
                skeleton,
                scheme: Scheme::Cubic,
                pinned: Vec::new(),
            }],
            obstacles,
            settings: Settings::default(),
        };
        let start = Instant::now();
        let mut simulation = Simulation::new(&setup)?;
        let begun = start.elapsed().as_secs_f64();
        let frames = 100;
        let start = Instant::now();
        for _ in 0..frames {
            simulation.advance(&[]);
        }
        let frame = start.elapsed().as_secs_f64() / f64::from(frames);
        println!(
            "{count} nodes, {boxes} boxes: {:.2} ms to begin, {:.3} ms a frame, {:.2} ns an operation",
            begun * 1e3,
            frame * 1e3,
            frame * 1e9 / simulation.work() as f64
        );
    }
    Ok(())
}
