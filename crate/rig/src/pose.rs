//! The turns of joints.

use glam::{DQuat, DVec3};

/// The turns of a skeleton's edges, frame after frame.
#[derive(Debug)]
pub struct Turns {
    edges: Vec<Edge>,
    nodes: usize,
}

#[derive(Debug)]
struct Edge {
    ends: [usize; 2],
    /// The direction in the frame before; zero if the edge has had no length so far.
    direction: DVec3,
    /// The turn since the start.
    turn: DQuat,
}

impl Turns {
    /// Edges at rest.
    pub fn new(curves: &[Vec<usize>], places: &[DVec3]) -> Self {
        let pairs = curves.iter().flat_map(|curve| curve.windows(2));
        let edges = pairs.filter(|pair| pair[0] != pair[1]).map(|pair| Edge {
            ends: [pair[0], pair[1]],
            direction: (places[pair[1]] - places[pair[0]]).normalize_or_zero(),
            turn: DQuat::IDENTITY,
        });
        Self {
            edges: edges.collect(),
            nodes: places.len(),
        }
    }

    /// The nodes' turns in the next frame: the means of their edges'.
    pub fn follow(&mut self, places: &[DVec3]) -> Vec<DQuat> {
        let mut sums: Vec<Option<DQuat>> = vec![None; self.nodes];
        for edge in &mut self.edges {
            let [a, b] = edge.ends;
            let now = (places[b] - places[a]).normalize_or_zero();
            if now != DVec3::ZERO {
                if edge.direction != DVec3::ZERO {
                    edge.turn = (shortest(edge.direction, now) * edge.turn).normalize();
                }
                edge.direction = now;
            }
            for node in edge.ends {
                let sum = &mut sums[node];
                *sum = Some(match *sum {
                    None => edge.turn,
                    // Both signs are one turn.
                    Some(sum) if sum.dot(edge.turn) < 0.0 => sum - edge.turn,
                    Some(sum) => sum + edge.turn,
                });
            }
        }
        let turns = sums.into_iter().map(|sum| match sum {
            Some(sum) if sum.length() > 1e-6 => sum.normalize(),
            _ => DQuat::IDENTITY,
        });
        turns.collect()
    }
}

/// The shortest turn from one unit vector to another: `(1 + a·b, a×b)`, normalised.
fn shortest(from: DVec3, to: DVec3) -> DQuat {
    let (cosine, axis) = (from.dot(to), from.cross(to));
    if 1.0 + cosine > 1e-9 {
        DQuat::from_xyzw(axis.x, axis.y, axis.z, 1.0 + cosine).normalize()
    } else {
        // Half a turn, about any axis across.
        let axis = from.any_orthonormal_vector();
        DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_take_edges_along() {
        let curves = [vec![0, 1, 2]];
        let rest = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 0.5, 0.0)];
        let mut turns = Turns::new(&curves, &rest);
        assert!(turns.follow(&rest).iter().all(|t| *t == DQuat::IDENTITY));
        // Ten steps of a whole turn of both edges about an axis.
        let axis = DVec3::new(0.3, -0.5, 0.8).normalize();
        for step in 1..=10 {
            let whole = DQuat::from_axis_angle(axis, f64::from(step) * 0.3);
            let places = rest.map(|p| whole * p);
            let found = turns.follow(&places);
            // An edge's own twist is not known, its direction is.
            let turned = found[0] * DVec3::X;
            assert!(turned.distance(whole * DVec3::X) < 1e-12, "{turned}");
            assert!(found.iter().all(|turn| turn.is_normalized()));
        }
        // Back on itself.
        let mut turns = Turns::new(&curves, &rest);
        let found = turns.follow(&rest.map(|p| -p));
        assert!((found[0] * DVec3::X).distance(-DVec3::X) < 1e-12);
        // An edge without a length keeps its turn.
        let found = turns.follow(&[DVec3::ZERO; 3]);
        assert!(found.iter().all(|turn| turn.is_normalized()));
    }
}
