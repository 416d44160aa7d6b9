//! Bits of results, which are the same on every platform: run natively and as WebAssembly.

use glam::DVec3;
use motion::{Body, Obstacle, Settings, Setup, Simulation};
use skeleton::{Node, Scheme, Skeleton};
use trials::bits::Hash;

/// Returns a hash of all places in all frames of a motion.
fn places() -> Hash {
    let node = |i: usize| {
        let t = i as f64;
        Node {
            position: DVec3::new(0.7 * t, 3.0 + 0.3 * t * (7.0 - t), 0.2 * (t % 3.0)),
            radius: 0.4 - 0.03 * t,
        }
    };
    let bodies = [Scheme::Cubic, Scheme::FourPoint, Scheme::Chaikin].map(|scheme| Body {
        skeleton: Skeleton {
            nodes: (0..8).map(node).collect(),
            curves: vec![vec![0, 1, 2, 3, 4], vec![2, 5, 6], vec![2, 7]],
        },
        scheme,
        pinned: Vec::new(),
    });
    let [mut one, two, mut three] = bodies;
    one.pinned = vec![0];
    for node in &mut three.skeleton.nodes {
        node.position += DVec3::new(0.3, 4.0, 0.9);
    }
    let setup = Setup {
        bodies: vec![one, two, three],
        obstacles: vec![
            Obstacle::Plane {
                point: DVec3::ZERO,
                normal: DVec3::new(0.6, 0.8, 0.0),
            },
            Obstacle::Box {
                center: DVec3::new(2.0, 1.0, 0.0),
                axes: [DVec3::X, DVec3::Y * 0.4, DVec3::Z],
            },
            Obstacle::Rod {
                ends: [DVec3::new(4.0, 0.5, -3.0), DVec3::new(4.0, 0.5, 3.0)],
                radii: [0.3, 0.6],
            },
        ],
        settings: Settings {
            bounce: 0.3,
            ..Settings::default()
        },
    };
    let mut simulation = Simulation::new(&setup).unwrap();
    let mut hash = Hash::default();
    for frame in 0..60 {
        simulation.advance(&[DVec3::new(0.0, 3.0, 0.05 * f64::from(frame))]);
        let places = simulation.positions().iter();
        hash.numbers(places.flat_map(|p| p.to_array()));
    }
    hash
}

#[test]
fn a_motion_is_the_same_everywhere() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt");
    trials::bits::compare(
        &[("places".into(), places())],
        include_str!("../bits.txt"),
        path,
    );
}
