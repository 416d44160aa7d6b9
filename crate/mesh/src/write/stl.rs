//! Binary STL.

use super::prepared::{Prepared, put_floats};
use glam::DVec3;

/// The heading; it must not begin with `solid`.
const HEAD: &[u8; 80] =
    b"binary STL, millimetres                                                         ";

pub(super) fn write(parts: &[Prepared<'_>]) -> Vec<u8> {
    let count: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    let mut bytes = Vec::with_capacity(84 + 50 * count);
    bytes.extend(HEAD);
    bytes.extend((count as u32).to_le_bytes());
    for part in parts {
        for triangle in &part.mesh.triangles {
            let corners = triangle.map(|i| part.positions[i as usize]);
            let [a, b, c] = corners.map(|p| DVec3::from(p.map(f64::from)));
            let normal = (b - a).cross(c - a).normalize_or_zero();
            put_floats(&mut bytes, &normal.to_array().map(|x| x as f32));
            put_floats(&mut bytes, corners.as_flattened());
            bytes.extend([0; 2]);
        }
    }
    bytes
}
