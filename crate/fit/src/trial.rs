//! Head with neck and shoulders, made by a formula: something to fit whose true shape is known.

use crate::disturb::Numbers;
use glam::DVec3;
use mesh::TriangleMesh;

/// Rows of the profile from the crown down: height, half width, half depth, and the middle's place
/// from front to back.
const PROFILE: [[f64; 4]; 15] = [
    [1.62, 0.10, 0.12, 0.06],
    [1.52, 0.38, 0.46, 0.06],
    [1.30, 0.60, 0.74, 0.05],
    [1.00, 0.71, 0.87, 0.03],
    [0.70, 0.72, 0.89, 0.00],
    [0.40, 0.68, 0.84, -0.02],
    [0.10, 0.60, 0.74, -0.05],
    [-0.15, 0.49, 0.60, -0.05],
    [-0.35, 0.37, 0.46, 0.02],
    [-0.58, 0.33, 0.36, 0.09],
    [-0.85, 0.40, 0.38, 0.11],
    [-1.05, 0.78, 0.43, 0.11],
    [-1.22, 1.20, 0.49, 0.11],
    [-1.50, 1.40, 0.53, 0.11],
    [-1.85, 1.42, 0.54, 0.11],
];

/// Bumps: middle (x, z), widths (x, z), height outwards, on the front (−y) or on the sides.
const FRONT: [[f64; 5]; 6] = [
    [0.00, 0.36, 0.11, 0.17, 0.20],
    [-0.27, 0.52, 0.14, 0.10, -0.08],
    [0.27, 0.52, 0.14, 0.10, -0.08],
    [0.00, 0.72, 0.40, 0.09, 0.05],
    [0.00, 0.03, 0.20, 0.06, 0.04],
    [0.00, -0.16, 0.18, 0.10, 0.09],
];

/// Returns a closed mesh of about `facets` triangles of a head, about 3.5 units high; it looks
/// along −y, z is up.
#[must_use]
pub fn head(facets: usize) -> TriangleMesh {
    let rings = ((facets as f64 / 2.0).sqrt().round() as u32).max(6);
    let around = rings + rings % 2;
    let mut mesh = TriangleMesh::default();
    let turn = core::f64::consts::TAU / f64::from(around);
    for i in 0..rings {
        let v = f64::from(i) / f64::from(rings - 1);
        let [z, width, depth, middle] = row(v);
        for j in 0..around {
            let angle = turn * (f64::from(j) + 0.5 * f64::from(i % 2));
            let (x, y) = (libm::sin(angle), -libm::cos(angle));
            let mut p = DVec3::new(width * x, middle + depth * y, z);
            for [cx, cz, wx, wz, height] in FRONT {
                let (u, w) = ((p.x - cx) / wx, (z - cz) / wz);
                p.y -= height * libm::exp(-u * u - w * w) * (-y).max(0.0);
            }
            let (u, w) = ((p.y - 0.05) / 0.13, (z - 0.42) / 0.2);
            p.x += 0.13 * x.signum() * libm::exp(-u * u - w * w) * x.abs();
            mesh.positions.push(p);
        }
    }
    let [top, bottom] = [(0, 0.03), (rings - 1, 0.0)].map(|(ring, rise)| {
        let first = (ring * around) as usize;
        let own = &mesh.positions[first..first + around as usize];
        let middle = own.iter().sum::<DVec3>() / f64::from(around) + DVec3::Z * rise;
        mesh.positions.push(middle);
        mesh.positions.len() as u32 - 1
    });
    let at = |i: u32, j: u32| i * around + j % around;
    for j in 0..around {
        mesh.triangles.push([top, at(0, j), at(0, j + 1)]);
        mesh.triangles
            .push([bottom, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 0..rings - 1 {
            let [a, b] = [at(i, j), at(i, j + 1)];
            let [c, d] = [at(i + 1, j), at(i + 1, j + 1)];
            if i % 2 == 0 {
                mesh.triangles.extend([[a, c, b], [b, c, d]]);
            } else {
                mesh.triangles.extend([[a, c, d], [a, d, b]]);
            }
        }
    }
    mesh
}

/// The profile at a share of its rows, by Catmull and Rom's cubics.
fn row(v: f64) -> [f64; 4] {
    let last = PROFILE.len() - 1;
    let at = v * last as f64;
    let i = (at as usize).min(last - 1);
    let t = at - i as f64;
    let rows = [i.saturating_sub(1), i, i + 1, (i + 2).min(last)].map(|k| PROFILE[k]);
    core::array::from_fn(|k| {
        let [a, b, c, d] = rows.map(|row| row[k]);
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    })
}

/// Returns a control mesh of about 60 vertices around the head: the head itself with few facets, a
/// little larger.
#[must_use]
pub fn cage() -> TriangleMesh {
    let mut cage = head(128);
    for p in &mut cage.positions {
        *p = DVec3::new(
            p.x * 1.08,
            0.05 + (p.y - 0.05) * 1.08,
            -0.1 + (p.z + 0.1) * 1.04,
        );
    }
    cage
}

/// Returns moves of control points that bend a head and make it uneven: smooth, with a part for
/// each control by itself.
#[must_use]
pub fn moves(controls: &[DVec3], size: f64, seed: u64) -> Vec<DVec3> {
    let mut numbers = Numbers::new(seed);
    let mut moves = Vec::with_capacity(controls.len());
    for c in controls {
        let bend = DVec3::new(
            0.6 * libm::sin(1.1 * c.z + 0.4),
            0.5 * libm::cos(1.3 * c.z + c.x),
            0.4 * libm::sin(1.7 * c.x + 0.6),
        );
        moves.push((bend + 0.35 * numbers.direction()) * size);
    }
    moves
}

/// Returns points spread evenly over the triangles of a mesh, by area.
#[must_use]
pub fn sample(positions: &[DVec3], triangles: &[[u32; 3]], count: usize, seed: u64) -> Vec<DVec3> {
    let mut sums = Vec::with_capacity(triangles.len());
    let mut total = 0.0;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        total += (b - a).cross(c - a).length();
        sums.push(total);
    }
    let mut numbers = Numbers::new(seed);
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        let at = numbers.uniform() * total;
        let i = sums
            .partition_point(|sum| *sum <= at)
            .min(sums.len().saturating_sub(1));
        let (mut u, mut v) = (numbers.uniform(), numbers.uniform());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        if let Some(triangle) = triangles.get(i) {
            let [a, b, c] = triangle.map(|i| positions[i as usize]);
            points.push(a + (b - a) * u + (c - a) * v);
        }
    }
    points
}
