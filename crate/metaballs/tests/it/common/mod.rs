//! Meshes and numbers for tests.

use glam::DVec3;

/// Numbers between 0 and 1, the same in every run.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A point with coordinates from −1 to 1.
    pub fn point(&mut self) -> DVec3 {
        DVec3::from_array(core::array::from_fn(|_| 2.0 * self.next() - 1.0))
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point();
            if p.length_squared() <= 1.0
                && let Some(unit) = p.try_normalize()
            {
                return unit;
            }
        }
    }
}

/// A sphere of about the radius 1 of `rings` rings, its vertices disturbed.
pub fn lumpy_sphere(rings: u32, seed: u64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut numbers = Numbers(seed);
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
            positions.push(p + numbers.point() * 0.3 * turn);
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
