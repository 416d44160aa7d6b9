//! Meshes for tests.

use glam::DVec3;
use trials::Random;

/// Returns a sphere of about the radius 1 of `rings` rings, its vertices disturbed.
pub fn lumpy_sphere(rings: u32, seed: u64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut random = Random::new(seed);
    let around = 2 * rings;
    let mut positions = vec![DVec3::Z, -DVec3::Z];
    let turn = core::f64::consts::PI / f64::from(rings);
    for i in 1..rings {
        for j in 0..around {
            let (a, b) = (turn * f64::from(i), turn * f64::from(j));
            let p = DVec3::new(
                libm::sin(a) * libm::cos(b),
                libm::sin(a) * libm::sin(b),
                libm::cos(a),
            );
            positions.push(p + random.vector(0.3 * turn));
        }
    }
    let at = |i: u32, j: u32| 2 + (i - 1) * around + j % around;
    let mut triangles = Vec::new();
    for j in 0..around {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        triangles.push([1, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (positions, triangles)
}
