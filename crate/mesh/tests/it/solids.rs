//! Meshes with known topology.

use glam::DVec3;
use mesh::{PolygonSoup, TriangleMesh};
use trials::boxes;

/// Returns a cube of six quadrilaterals from 0 to 1.
pub fn cube() -> PolygonSoup {
    let mut soup = PolygonSoup::new(boxes::corners(DVec3::ZERO, DVec3::ONE));
    for side in boxes::SIDES {
        soup.add_face(&side);
    }
    soup
}

/// Returns a grid on a torus: n by m quadrilaterals, or twice as many triangles.
pub fn torus(n: u32, m: u32) -> TriangleMesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let turn = |k: u32, of: u32| f64::from(k) / f64::from(of) * core::f64::consts::TAU;
            let (a, b) = (turn(i, n), turn(j, m));
            let radius = 1.0 + 0.4 * libm::cos(b);
            positions.push(DVec3::new(
                radius * libm::cos(a),
                radius * libm::sin(a),
                0.4 * libm::sin(b),
            ));
            let at = |i: u32, j: u32| i % n * m + j % m;
            let [p, q] = [at(i, j), at(i + 1, j)];
            let [r, s] = [at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
    TriangleMesh::new(positions, triangles)
}

/// An octahedron whose triangles are cut into n² each, on the unit sphere.
pub fn sphere(n: u32) -> TriangleMesh {
    let mut number = std::collections::BTreeMap::new();
    let mut mesh = TriangleMesh::default();
    for octant in 0..8 {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|a| a.to_array().map(|x| x as i64));
        let sign = |bit: u32| if octant >> bit & 1 == 0 { 1 } else { -1 };
        let mut corner = |i: u32, j: u32| {
            let k = n - i - j;
            let mut place = [0_i64; 3];
            for (axis, (weight, bit)) in axes.iter().zip([(i, 0), (j, 1), (k, 2)]) {
                for (x, a) in place.iter_mut().zip(axis) {
                    *x += a * i64::from(weight) * sign(bit);
                }
            }
            *number.entry(place).or_insert_with(|| {
                mesh.positions
                    .push(DVec3::from(place.map(|x| x as f64)).normalize());
                mesh.positions.len() as u32 - 1
            })
        };
        let mut faces = Vec::new();
        for i in 0..n {
            for j in 0..n - i {
                faces.push([corner(i, j), corner(i + 1, j), corner(i, j + 1)]);
                if i + j + 1 < n {
                    faces.push([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
                }
            }
        }
        if sign(0) * sign(1) * sign(2) < 0 {
            faces.iter_mut().for_each(|f| f.swap(1, 2));
        }
        mesh.triangles.extend(faces);
    }
    mesh
}
