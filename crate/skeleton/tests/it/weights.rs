//! Weights of nodes: vertices are the means that they say, wherever the nodes are.

use glam::DVec3;
use skeleton::{Node, Scheme, Skeleton};
use trials::{Random, count};

#[test]
fn vertices_are_means_of_nodes() {
    let mut random = Random::new(7);
    for _ in 0..count(5) {
        let nodes = (0..9).map(|_| Node {
            position: random.vector(5.0),
            radius: 0.1,
        });
        let skeleton = Skeleton {
            nodes: nodes.collect(),
            // A branch, a loop, and a curve of two.
            curves: vec![
                vec![0, 1, 2, 3, 4],
                vec![2, 5, 6],
                vec![3, 7, 8, 3],
                vec![6, 0],
            ],
        };
        for scheme in [Scheme::Cubic, Scheme::Chaikin, Scheme::FourPoint] {
            for levels in 0..4 {
                let polyline = skeleton.polyline(scheme, levels).unwrap();
                let weights = skeleton.weights(scheme, levels).unwrap();
                assert_eq!(weights.len(), polyline.vertices.len());
                for (vertex, own) in polyline.vertices.iter().zip(&weights) {
                    let sum: f64 = own.iter().map(|(_, weight)| weight).sum();
                    assert!((sum - 1.0).abs() < 1e-12);
                    let mean = own.iter().fold(DVec3::ZERO, |mean, &(node, weight)| {
                        mean + skeleton.nodes[node].position * weight
                    });
                    // Weights of less than a millionth are left out.
                    assert!(mean.distance(vertex.position) < 1e-4, "{scheme:?} {levels}");
                }
            }
        }
    }
}
