//! Springs: edges of control polygons, bending at their corners, twist along their edges.

use crate::setup::{Body, Settings};
use glam::DVec3;

/// Spring between nodes.
#[derive(Clone, Debug)]
pub enum Link {
    /// Spring between two nodes, at rest at a distance.
    Distance {
        nodes: [usize; 2],
        rest: f64,
        /// Compliance: the inverse of the spring's constant.
        give: f64,
    },
    /// Node at a distance from a point between its two neighbours: 0 on a straight curve, more at a
    /// corner.
    Bend {
        /// The neighbour before, the node, the neighbour behind.
        nodes: [usize; 3],
        /// The point between the neighbours: this share of the way.
        share: f64,
        rest: f64,
        give: f64,
    },
}

impl Link {
    /// Moves the nodes towards where the spring is at rest.
    pub fn solve(&self, places: &mut [DVec3], inverse: &[f64], step: f64) {
        match *self {
            Self::Distance { nodes, rest, give } => {
                let [a, b] = nodes;
                let apart = places[b] - places[a];
                let weight = inverse[a] + inverse[b];
                let Some(move_by) = correction(apart, rest, weight, give, step) else {
                    return;
                };
                places[a] -= move_by * inverse[a];
                places[b] += move_by * inverse[b];
            }
            Self::Bend {
                nodes,
                share,
                rest,
                give,
            } => {
                let [a, b, c] = nodes;
                let (of_a, of_c) = (1.0 - share, share);
                let apart = places[b] - (places[a] * of_a + places[c] * of_c);
                let weight = inverse[b] + inverse[a] * of_a * of_a + inverse[c] * of_c * of_c;
                let Some(move_by) = correction(apart, rest, weight, give, step) else {
                    return;
                };
                places[b] += move_by * inverse[b];
                places[a] -= move_by * (inverse[a] * of_a);
                places[c] -= move_by * (inverse[c] * of_c);
            }
        }
    }

    /// Computes the energy `(length − rest)²/(2·give)`; 0 if the spring does not give way at all.
    pub fn energy(&self, places: &[DVec3]) -> f64 {
        let (apart, rest, give) = match *self {
            Self::Distance { nodes, rest, give } => {
                (places[nodes[1]] - places[nodes[0]], rest, give)
            }
            Self::Bend {
                nodes: [a, b, c],
                share,
                rest,
                give,
            } => {
                let between = places[a] * (1.0 - share) + places[c] * share;
                (places[b] - between, rest, give)
            }
        };
        if give > 0.0 {
            let stretch = apart.length() - rest;
            0.5 * stretch * stretch / give
        } else {
            0.0
        }
    }
}

/// The impulse, in lengths times mass, that takes two points at `apart` towards a distance of
/// `rest`.
fn correction(apart: DVec3, rest: f64, weight: f64, give: f64, step: f64) -> Option<DVec3> {
    let length = apart.length();
    let hold = weight + give / (step * step);
    // Points at one place have no direction to part in.
    (length > 0.0 && hold > 0.0).then(|| apart * ((rest - length) / (length * hold)))
}

/// The springs of a body whose nodes begin at `first`.
pub fn links(body: &Body, first: usize, settings: &Settings, into: &mut Vec<Link>) {
    let nodes = &body.skeleton.nodes;
    let distance = |a: usize, b: usize| nodes[a].position.distance(nodes[b].position);
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    let mut edges = Vec::new();
    for pair in body.skeleton.curves.iter().flat_map(|c| c.windows(2)) {
        let [a, b] = [pair[0], pair[1]];
        if a != b && !around[a].contains(&b) {
            around[a].push(b);
            around[b].push(a);
            edges.push([a, b]);
        }
    }
    if settings.stiffness > 0.0 {
        into.extend(edges.iter().map(|&[a, b]| Link::Distance {
            nodes: [first + a, first + b],
            rest: distance(a, b),
            give: distance(a, b) / settings.stiffness,
        }));
    }
    let stiffness = settings.stiffness * settings.bending;
    if stiffness <= 0.0 {
        return;
    }
    for (b, neighbours) in around.iter().enumerate() {
        for (i, &a) in neighbours.iter().enumerate() {
            for &c in &neighbours[i + 1..] {
                let (before, behind) = (distance(a, b), distance(b, c));
                let whole = before + behind;
                let share = if whole > 0.0 { before / whole } else { 0.5 };
                into.push(Link::Bend {
                    nodes: [first + a, first + b, first + c],
                    share,
                    rest: nodes[b]
                        .position
                        .distance(nodes[a].position * (1.0 - share) + nodes[c].position * share),
                    give: 0.5 * whole / stiffness,
                });
            }
        }
    }
    for &[b, c] in &edges {
        for &a in around[b].iter().filter(|&&a| a != c) {
            for &d in around[c].iter().filter(|&&d| d != b && d != a) {
                let rest = distance(a, d);
                into.push(Link::Distance {
                    nodes: [first + a, first + d],
                    rest,
                    give: (distance(a, b) + distance(b, c) + distance(c, d)) / stiffness,
                });
            }
        }
    }
}

/// Masses by the flesh around each node: radius² times half the length of its edges, scaled to a
/// mean of 1. None is less than a fiftieth of the greatest, as the light ends of heavy limbs would
/// need many more steps.
pub fn masses(body: &Body) -> Vec<f64> {
    let nodes = &body.skeleton.nodes;
    let mut masses = vec![0.0; nodes.len()];
    for pair in body.skeleton.curves.iter().flat_map(|c| c.windows(2)) {
        let [a, b] = [pair[0], pair[1]];
        let half = 0.5 * nodes[a].position.distance(nodes[b].position);
        for i in [a, b] {
            masses[i] += half * nodes[i].radius * nodes[i].radius;
        }
    }
    let most = masses.iter().copied().fold(0.0, f64::max);
    if most <= 0.0 || !most.is_finite() {
        return vec![1.0; nodes.len()];
    }
    for mass in &mut masses {
        *mass = mass.max(0.02 * most) / most;
    }
    let mean = masses.iter().sum::<f64>() / masses.len() as f64;
    masses.iter().map(|mass| mass / mean).collect()
}
