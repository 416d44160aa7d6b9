//! Boxes as meshes. Corner i is at the upper end of the axis k where bit k of i is set.

use glam::DVec3;

/// Corners of each side, counter-clockwise as seen from outside.
pub const SIDES: [[u32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [1, 3, 7, 5],
    [3, 2, 6, 7],
    [2, 0, 4, 6],
];

/// Returns the corners of a box.
#[must_use]
pub fn corners(low: DVec3, high: DVec3) -> Vec<DVec3> {
    let corner = (0..8_u32).map(|i| [0, 1, 2].map(|k| [low, high][(i >> k & 1) as usize][k]));
    corner.map(DVec3::from).collect()
}

/// Returns the halves of its sides.
#[must_use]
pub fn triangles() -> Vec<[u32; 3]> {
    let halves = SIDES.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.as_flattened().to_vec()
}
