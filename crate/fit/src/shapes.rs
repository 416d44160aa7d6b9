//! Shapes beside the head whose fits are tried: a ball with bumps, a hand, a vase with a handle.
//!
//! Each is a function of space, below 0 inside, made into even triangles: a vertex in each cell
//! that the surface passes through, at the mean of where it crosses the cell's edges (Gibson's
//! surface nets).

use glam::{DVec2, DVec3};
use mesh::TriangleMesh;
use std::collections::BTreeMap;

/// Half of the side of the cube that holds every shape.
const HALF: f64 = 1.5;

/// Returns a ball of radius 1 with bumps a tenth high, in cells of this size.
#[must_use]
pub fn ball(cell: f64) -> TriangleMesh {
    polygonize(cell, &|p: DVec3| {
        let bumps = libm::sin(3.0 * p.x + 0.5) * libm::cos(2.5 * p.y) + libm::sin(3.2 * p.z + p.x);
        p.length() - 1.0 - 0.05 * bumps
    })
}

/// Returns a hand with spread fingers, 2.1 high, in cells of this size; a finger is 0.2 thick.
#[must_use]
pub fn hand(cell: f64) -> TriangleMesh {
    polygonize(cell, &|p: DVec3| {
        let beyond = (p + DVec3::new(0.0, 0.0, 0.25)).abs() - DVec3::new(0.4, 0.06, 0.38);
        let outside = beyond.max(DVec3::ZERO).length();
        let mut value = outside + beyond.max_element().min(0.0) - 0.1;
        for (x, height) in [(-0.36, 0.75), (-0.12, 1.0), (0.12, 1.05), (0.36, 0.9)] {
            let root = DVec3::new(x, 0.0, 0.1);
            value = blend(
                value,
                distance_from(p, root, DVec3::new(1.9 * x, -0.08, height)) - 0.1,
            );
        }
        let thumb = [DVec3::new(0.35, 0.0, -0.35), DVec3::new(0.9, -0.1, 0.05)];
        value = blend(value, distance_from(p, thumb[0], thumb[1]) - 0.11);
        let wrist = DVec3::new(0.0, 0.0, -0.6);
        blend(
            value,
            distance_from(p, wrist, wrist - 0.3 * DVec3::Z) - 0.24,
        )
    })
}

/// Returns a hollow vase with a handle, 2 high, in cells of this size; its wall is 0.2 thick.
#[must_use]
pub fn vase(cell: f64) -> TriangleMesh {
    polygonize(cell, &|p: DVec3| {
        let around = DVec2::new(p.x, p.y).length();
        let radius = 0.5 + 0.18 * libm::sin(2.4 * p.z + 0.4);
        let hollow = (around - radius + 0.2).max(-0.7 - p.z);
        let body = (around - radius).max(p.z.abs() - 1.0).max(-hollow);
        let ring = DVec2::new(p.x - 0.6, p.z - 0.05).length() - 0.42;
        let handle = DVec2::new(ring, p.y).length() - 0.11;
        body.min(handle.max(radius - 0.1 - around))
    })
}

/// Returns the distance of a point from a segment.
fn distance_from(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let way = to - from;
    let t = ((p - from).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    p.distance(from + way * t)
}

/// Returns the lesser of two values, rounded where they are alike.
fn blend(a: f64, b: f64) -> f64 {
    const WIDTH: f64 = 0.06;
    let share = (WIDTH - (a - b).abs()).max(0.0) / WIDTH;
    a.min(b) - 0.25 * WIDTH * share * share
}

/// Returns triangles where a function is 0, outward of where it is below.
fn polygonize(cell: f64, value: &dyn Fn(DVec3) -> f64) -> TriangleMesh {
    let count = (2.0 * HALF / cell).ceil() as usize;
    let side = count + 1;
    let mut values = Vec::with_capacity(side * side * side);
    for number in 0..side * side * side {
        values.push(value(node(number, side, cell)));
    }
    // Strides to the next node along x, y and z.
    let strides = [1, side, side * side];
    let mut mesh = TriangleMesh::default();
    let mut vertices: BTreeMap<usize, u32> = BTreeMap::new();
    for number in 0..values.len() {
        let place = split(number, side);
        if place.contains(&count) {
            continue;
        }
        let (mut sum, mut crossings) = (DVec3::ZERO, 0.0);
        for axis in 0..3 {
            let [u, v] = [strides[(axis + 1) % 3], strides[(axis + 2) % 3]];
            for from in [0, u, v, u + v].map(|offset| number + offset) {
                let to = from + strides[axis];
                if (values[from] < 0.0) != (values[to] < 0.0) {
                    let t = values[from] / (values[from] - values[to]);
                    sum += node(from, side, cell).lerp(node(to, side, cell), t);
                    crossings += 1.0;
                }
            }
        }
        if crossings > 0.0 {
            vertices.insert(number, mesh.positions.len() as u32);
            mesh.positions.push(sum / crossings);
        }
    }
    for number in 0..values.len() {
        let place = split(number, side);
        for axis in 0..3 {
            let [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
            let is_inner = place[axis] < count && place[one] > 0 && place[other] > 0;
            if !is_inner || place[one] == count || place[other] == count {
                continue;
            }
            let [low, high] = [values[number], values[number + strides[axis]]];
            if (low < 0.0) == (high < 0.0) {
                continue;
            }
            let [u, v] = [strides[one], strides[other]];
            let mut ring =
                [number - u - v, number - v, number, number - u].map(|cell| vertices[&cell]);
            if high < 0.0 {
                ring.reverse();
            }
            let [a, b, c, d] = ring;
            let [p, q, r, s] = ring.map(|i| mesh.positions[i as usize]);
            mesh.triangles
                .extend(if p.distance_squared(r) <= q.distance_squared(s) {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                });
        }
    }
    mesh
}

/// Columns of a node by its number.
fn split(number: usize, side: usize) -> [usize; 3] {
    [number % side, number / side % side, number / (side * side)]
}

/// Place of a node.
fn node(number: usize, side: usize, cell: f64) -> DVec3 {
    let [x, y, z] = split(number, side).map(|i| i as f64 * cell - HALF);
    DVec3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh::Topology;

    #[test]
    fn shapes_are_closed_and_face_outwards() {
        // The handle makes a hole: 2 − 2·1.
        for (mesh, characteristic) in [(ball(0.13), 2), (hand(0.05), 2), (vase(0.07), 0)] {
            let topology = Topology::of(&mesh).unwrap();
            assert!(topology.repairs.is_none() && topology.boundary_edges == 0);
            let (vertices, facets) = (mesh.positions.len() as i64, mesh.triangles.len() as i64);
            assert_eq!(vertices - facets / 2, characteristic);
            assert!(mesh.signed_volume() > 0.3, "{}", mesh.signed_volume());
        }
    }
}
