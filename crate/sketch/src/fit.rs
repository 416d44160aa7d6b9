//! Fitting a subdivision curve of few nodes to a stroke.

use glam::DVec3;
use skeleton::{Node, Scheme, Skeleton};

/// Most nodes of a fitted curve.
pub const MOST_NODES: usize = 24;
/// Points of a stroke that are looked at.
const MOST_POINTS: usize = 160;
/// Levels to which curves are refined to be measured.
const LEVELS: u32 = 3;
/// Rounds in which the points' places along the curve are found anew.
const ROUNDS: usize = 4;
/// Weight of the nodes' second differences against the points: what points leave open stays
/// straight.
const STIFFNESS: f64 = 1e-4;

/// A point of a stroke with the radius that is wanted there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The place.
    pub position: DVec3,
    /// The radius there.
    pub radius: f64,
}

/// Finds the nodes of a curve of the cubic scheme that passes all samples within `tolerance`, as
/// few as possible but at most [`MOST_NODES`]. It begins at the first sample and ends at the last.
/// `None` if the samples do not reach farther than the tolerance, or a number is not finite.
///
/// For each number of nodes the sum of squared distances is made least: samples get places along
/// the curve, the nodes follow by linear equations, the places are found anew. So the curve is
/// smoother than the hand was.
#[must_use]
pub fn fit(samples: &[Sample], tolerance: f64) -> Option<Vec<Node>> {
    let is_usable = samples
        .iter()
        .all(|s| s.position.is_finite() && s.radius.is_finite() && s.radius >= 0.0);
    if !is_usable || !tolerance.is_finite() || tolerance <= 0.0 {
        return None;
    }
    let samples = spread(samples);
    let first = samples.first()?;
    let distances = samples.iter().map(|s| s.position.distance(first.position));
    if distances.fold(0.0, f64::max) <= tolerance {
        return None;
    }
    let mut best: Option<(f64, Vec<Node>)> = None;
    for count in 2..=MOST_NODES.min(samples.len().max(2)) {
        let (nodes, error) = fit_nodes(&samples, count)?;
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, nodes));
        }
        if error <= tolerance {
            break;
        }
    }
    best.map(|(_, nodes)| nodes)
}

/// The samples at even distances along the stroke, its ends among them.
fn spread(samples: &[Sample]) -> Vec<Sample> {
    let mut along = vec![0.0];
    for pair in samples.windows(2) {
        let length = pair[0].position.distance(pair[1].position);
        along.push(along[along.len() - 1] + length);
    }
    let length = along[along.len() - 1];
    if samples.len() < 2 || length <= 0.0 {
        return samples.to_vec();
    }
    let count = (2 * samples.len()).clamp(16, MOST_POINTS);
    let even = (0..count).map(|i| {
        let wanted = length * i as f64 / (count - 1) as f64;
        let next = along.partition_point(|a| *a < wanted);
        let next = next.clamp(1, samples.len() - 1);
        let (from, to) = (samples[next - 1], samples[next]);
        let part = along[next] - along[next - 1];
        let share = if part > 0.0 {
            ((wanted - along[next - 1]) / part).clamp(0.0, 1.0)
        } else {
            0.0
        };
        Sample {
            position: from.position.lerp(to.position, share),
            radius: from.radius + (to.radius - from.radius) * share,
        }
    });
    even.collect()
}

/// Finds the curve with `count` nodes that is nearest to the samples. Returns its nodes and the
/// greatest distance of a sample.
fn fit_nodes(samples: &[Sample], count: usize) -> Option<(Vec<Node>, f64)> {
    let basis = Basis::new(count)?;
    let last = samples.len() - 1;
    let mut places: Vec<f64> = (0..samples.len()).map(|i| i as f64 / last as f64).collect();
    let mut nodes = Vec::new();
    let mut error = f64::INFINITY;
    for _ in 0..ROUNDS {
        let found = basis.nodes(samples, &places);
        let curve = basis.curve(&found);
        let far = samples
            .iter()
            .zip(&mut places)
            .map(|(sample, place)| {
                let (nearest, distance) = nearest(&curve, sample.position);
                *place = nearest;
                distance
            })
            .fold(0.0, f64::max);
        // The ends keep theirs.
        (places[0], places[last]) = (0.0, 1.0);
        if far < error {
            (nodes, error) = (found, far);
        }
    }
    let nodes = nodes.iter().enumerate().map(|(i, position)| {
        let share = i as f64 / (count - 1) as f64;
        Node {
            position: *position,
            radius: radius(samples, share, 0.5 / (count - 1) as f64),
        }
    });
    Some((nodes.collect(), error))
}

/// The mean radius of samples around a share of the stroke.
fn radius(samples: &[Sample], share: f64, around: f64) -> f64 {
    let last = (samples.len() - 1) as f64;
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, sample) in samples.iter().enumerate() {
        if (i as f64 / last - share).abs() <= around {
            sum += sample.radius;
            count += 1.0;
        }
    }
    if count > 0.0 {
        sum / count
    } else {
        samples[(share * last).round() as usize].radius
    }
}

/// Finds the place along a polyline, 0 … 1 by its vertices' numbers, that is nearest to a point,
/// and the distance there.
fn nearest(curve: &[DVec3], point: DVec3) -> (f64, f64) {
    let pieces = (curve.len() - 1) as f64;
    let mut best = (0.0, f64::INFINITY);
    for (i, ends) in curve.windows(2).enumerate() {
        let along = ends[1] - ends[0];
        let square = along.length_squared();
        let share = if square > 0.0 {
            ((point - ends[0]).dot(along) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let distance = point.distance(ends[0] + along * share);
        if distance < best.1 {
            best = ((i as f64 + share) / pieces, distance);
        }
    }
    best
}

/// The weights of nodes at the vertices of a curve's polyline.
struct Basis {
    count: usize,
    /// The weights of all nodes, a row for each vertex.
    rows: Vec<Vec<f64>>,
}

impl Basis {
    fn new(count: usize) -> Option<Self> {
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for node in 0..count {
            // The places of vertices depend linearly on those of nodes.
            let nodes = (0..count).map(|i| Node {
                position: if i == node { DVec3::X } else { DVec3::ZERO },
                radius: 0.0,
            });
            let skeleton = Skeleton {
                nodes: nodes.collect(),
                curves: vec![(0..count).collect()],
            };
            let polyline = skeleton.polyline(Scheme::Cubic, LEVELS).ok()?;
            rows.resize(polyline.vertices.len(), Vec::new());
            for (row, vertex) in rows.iter_mut().zip(&polyline.vertices) {
                row.push(vertex.position.x);
            }
        }
        Some(Self { count, rows })
    }

    /// The weights of the nodes at a place along the curve.
    fn row(&self, place: f64) -> Vec<f64> {
        let at = place.clamp(0.0, 1.0) * (self.rows.len() - 1) as f64;
        let index = (at as usize).min(self.rows.len() - 2);
        let share = at - index as f64;
        let pairs = self.rows[index].iter().zip(&self.rows[index + 1]);
        pairs.map(|(a, b)| a + (b - a) * share).collect()
    }

    fn curve(&self, nodes: &[DVec3]) -> Vec<DVec3> {
        let points = self.rows.iter().map(|row| {
            let parts = row.iter().zip(nodes).map(|(weight, node)| *node * *weight);
            parts.sum()
        });
        points.collect()
    }

    /// The nodes whose curve comes nearest to the samples at their places. The ends are the
    /// samples'.
    fn nodes(&self, samples: &[Sample], places: &[f64]) -> Vec<DVec3> {
        let (first, last) = (samples[0].position, samples[samples.len() - 1].position);
        let free = self.count - 2;
        let mut matrix = vec![vec![0.0; free]; free];
        let mut right = vec![DVec3::ZERO; free];
        let mut add = |row: &[f64], target: DVec3, weight: f64| {
            let rest = target - first * row[0] - last * row[self.count - 1];
            for i in 0..free {
                for j in 0..free {
                    matrix[i][j] += weight * row[i + 1] * row[j + 1];
                }
                right[i] += rest * (weight * row[i + 1]);
            }
        };
        for (sample, place) in samples.iter().zip(places) {
            add(&self.row(*place), sample.position, 1.0);
        }
        for i in 1..self.count - 1 {
            let mut row = vec![0.0; self.count];
            (row[i - 1], row[i], row[i + 1]) = (1.0, -2.0, 1.0);
            add(&row, DVec3::ZERO, STIFFNESS * samples.len() as f64);
        }
        let mut nodes = vec![first];
        nodes.extend(solve(matrix, right));
        nodes.push(last);
        nodes
    }
}

/// Solves a system with a symmetric positive definite matrix.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<DVec3>) -> Vec<DVec3> {
    let n = right.len();
    for k in 0..n {
        let (above, below) = matrix.split_at_mut(k + 1);
        let pivot = &above[k];
        for (i, row) in (k + 1..n).zip(below) {
            let factor = row[k] / pivot[k];
            for (own, other) in row.iter_mut().zip(pivot) {
                *own -= factor * other;
            }
            right[i] = right[i] - right[k] * factor;
        }
    }
    for k in (0..n).rev() {
        let known: DVec3 = (k + 1..n).map(|j| right[j] * matrix[k][j]).sum();
        right[k] = (right[k] - known) / matrix[k][k];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(points: impl Iterator<Item = DVec3>) -> Vec<Sample> {
        let samples = points.map(|position| Sample {
            position,
            radius: 0.2,
        });
        samples.collect()
    }

    fn farthest(nodes: &[Node], samples: &[Sample]) -> f64 {
        let skeleton = Skeleton {
            nodes: nodes.to_vec(),
            curves: vec![(0..nodes.len()).collect()],
        };
        let polyline = skeleton.polyline(Scheme::Cubic, 6).unwrap();
        let curve: Vec<DVec3> = polyline.vertices.iter().map(|v| v.position).collect();
        let far = samples.iter().map(|s| nearest(&curve, s.position).1);
        far.fold(0.0, f64::max)
    }

    fn arc(count: usize, turn: f64, shake: f64) -> Vec<Sample> {
        samples((0..count).map(move |i| {
            let (s, c) = libm::sincos(turn * i as f64 / (count - 1) as f64);
            let off = shake * libm::sin(i as f64 * 12.9898);
            DVec3::new(c, s, 0.5) * (1.0 + off)
        }))
    }

    #[test]
    fn a_straight_stroke_is_two_nodes_and_a_bent_one_few() {
        let line = samples((0..40).map(|i| DVec3::new(f64::from(i), 2.0, -1.0)));
        let nodes = fit(&line, 0.1).unwrap();
        assert_eq!(nodes.len(), 2);
        assert_eq!(nodes[0].position, DVec3::new(0.0, 2.0, -1.0));
        assert_eq!(nodes[1].position, DVec3::new(39.0, 2.0, -1.0));
        let bent = arc(60, 3.0, 0.0);
        let nodes = fit(&bent, 0.01).unwrap();
        assert!((4..=7).contains(&nodes.len()), "{}", nodes.len());
        assert!(farthest(&nodes, &bent) < 0.011);
    }

    #[test]
    fn a_shaking_hand_is_smoothed() {
        let shaken = arc(120, 3.0, 0.01);
        let nodes = fit(&shaken, 0.03).unwrap();
        assert!(nodes.len() <= 6, "{}", nodes.len());
        assert!(farthest(&nodes, &arc(120, 3.0, 0.0)) < 0.03);
    }

    #[test]
    fn radii_follow_the_pressure() {
        let mut line = samples((0..50).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)));
        for (i, sample) in line.iter_mut().enumerate() {
            sample.radius = 1.0 + i as f64 / 49.0;
            sample.position.y = 5.0 * libm::sin(i as f64 / 8.0);
        }
        let nodes = fit(&line, 0.2).unwrap();
        assert!(nodes.windows(2).all(|pair| pair[0].radius < pair[1].radius));
        assert!(nodes[0].radius < 1.2 && nodes[nodes.len() - 1].radius > 1.8);
    }

    #[test]
    fn a_scribble_has_at_most_so_many_nodes_and_a_dot_has_none() {
        let wild = samples((0..3000).map(|i| {
            let t = f64::from(i);
            DVec3::new(libm::sin(t * 0.9), libm::sin(t * 0.61), libm::cos(t * 0.3))
        }));
        let nodes = fit(&wild, 1e-6).unwrap();
        assert!(nodes.len() <= MOST_NODES);
        assert!(nodes.iter().all(|node| node.position.is_finite()));
        assert_eq!(fit(&samples([DVec3::ONE; 5].into_iter()), 0.1), None);
        assert_eq!(fit(&[], 0.1), None);
        assert_eq!(
            fit(&samples([DVec3::NAN, DVec3::ONE].into_iter()), 0.1),
            None
        );
        let two = samples([DVec3::ZERO, DVec3::ONE].into_iter());
        assert_eq!(fit(&two, 0.1).map(|nodes| nodes.len()), Some(2));
        assert_eq!(fit(&two, 0.0), None);
    }
}
