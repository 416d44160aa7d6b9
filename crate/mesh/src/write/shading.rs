//! Normals of a mesh as viewers shade it: those that it has, else those of its triangles, smooth
//! where they meet at a small angle.

use crate::triangle_mesh::TriangleMesh;
use glam::DVec3;
use std::collections::BTreeMap;

/// Cosine of the largest angle between the normals of two triangles that are shaded as one surface:
/// 30°.
const SMOOTH: f64 = 0.866;

/// Vertices of a file. Where triangles meet at an edge that is seen, each side has vertices of its
/// own.
pub(super) struct Shading {
    /// Vertex of the mesh that each vertex stands for. The mesh's own come first, in their order.
    pub(super) origins: Vec<u32>,
    /// Normal of each vertex, of length 1.
    pub(super) normals: Vec<[f32; 3]>,
    /// Vertices of each triangle.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Shading {
    /// Computes the shading of a mesh whose indices are in range.
    pub(super) fn new(mesh: &TriangleMesh) -> Self {
        let count = mesh.positions.len();
        let normals = mesh.normals.as_ref();
        let given: Vec<Option<DVec3>> = (0..count)
            .map(|v| normals.and_then(|all| all[v].try_normalize()))
            .collect();
        // Triangles at vertices without a normal, each with the number of its corner there.
        let mut around: Vec<Vec<(usize, usize)>> = vec![Vec::new(); count];
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for (k, v) in triangle.iter().enumerate() {
                if given[*v as usize].is_none() {
                    around[*v as usize].push((t, k));
                }
            }
        }
        let mut all = Self {
            origins: (0..count as u32).collect(),
            normals: given
                .iter()
                .map(|normal| round(normal.unwrap_or(DVec3::Z)))
                .collect(),
            triangles: mesh.triangles.clone(),
        };
        for (v, corners) in around.iter().enumerate() {
            for (i, (surface, normal)) in surfaces(mesh, corners).into_iter().enumerate() {
                let normal = round(normal);
                let own = if i == 0 {
                    all.normals[v] = normal;
                    v as u32
                } else {
                    all.origins.push(v as u32);
                    all.normals.push(normal);
                    all.origins.len() as u32 - 1
                };
                for (t, k) in surface {
                    all.triangles[t][k] = own;
                }
            }
        }
        all
    }
}

fn round(normal: DVec3) -> [f32; 3] {
    normal.to_array().map(|x| x as f32)
}

/// The corners at a vertex by the smooth surfaces that they are of, each with its normal: the mean
/// of its triangles', by their angles at the vertex.
fn surfaces(mesh: &TriangleMesh, corners: &[(usize, usize)]) -> Vec<(Vec<(usize, usize)>, DVec3)> {
    let normals = corners.iter().map(|(t, _)| {
        let [a, b, c] = mesh.corners(*t);
        (b - a).cross(c - a).normalize_or_zero()
    });
    let normals: Vec<DVec3> = normals.collect();
    // Each is of the surface with the lowest number that it is joined with.
    let mut surface: Vec<usize> = (0..corners.len()).collect();
    fn find(surface: &[usize], mut i: usize) -> usize {
        while surface[i] != i {
            i = surface[i];
        }
        i
    }
    let mut beside: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, (t, k)) in corners.iter().enumerate() {
        for other in [(k + 1) % 3, (k + 2) % 3] {
            let neighbor = mesh.triangles[*t][other];
            let known = beside.entry(neighbor).or_default();
            for j in known.iter() {
                if normals[i].dot(normals[*j]) >= SMOOTH {
                    let [one, two] = [find(&surface, i), find(&surface, *j)];
                    surface[one.max(two)] = one.min(two);
                }
            }
            // More than two triangles at an edge are no surface.
            if known.len() < 2 {
                known.push(i);
            }
        }
    }
    let mut found: BTreeMap<usize, (Vec<(usize, usize)>, DVec3)> = BTreeMap::new();
    for (i, (t, k)) in corners.iter().enumerate() {
        let own = mesh.corners(*t);
        let at = own[*k];
        let [u, v] = [own[(k + 1) % 3] - at, own[(k + 2) % 3] - at];
        let angle = libm::atan2(u.cross(v).length(), u.dot(v));
        let (all, sum) = found.entry(find(&surface, i)).or_default();
        all.push((*t, *k));
        *sum += normals[i] * angle;
    }
    let whole = found.into_values();
    whole
        .map(|(all, sum)| (all, sum.normalize_or(DVec3::Z)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a prism around the z axis with so many sides, from −1 to 1, with lids that are fans
    /// around their middle.
    fn prism(sides: u32) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for z in [-1.0, 1.0] {
            for i in 0..sides {
                let angle = core::f64::consts::TAU * f64::from(i) / f64::from(sides);
                let (sine, cosine) = libm::sincos(angle);
                mesh.positions.push(DVec3::new(cosine, sine, z));
            }
        }
        mesh.positions.extend([DVec3::NEG_Z, DVec3::Z]);
        for i in 0..sides {
            let j = (i + 1) % sides;
            let [a, b, c, d] = [i, j, sides + i, sides + j];
            let lids = [[2 * sides, b, a], [2 * sides + 1, c, d]];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
            mesh.triangles.extend(lids);
        }
        mesh
    }

    fn corners(shading: &Shading) -> impl Iterator<Item = (u32, DVec3)> {
        let corners = shading.triangles.as_flattened().iter();
        corners.map(|i| {
            let normal = DVec3::from_array(shading.normals[*i as usize].map(f64::from));
            (shading.origins[*i as usize], normal)
        })
    }

    #[test]
    fn round_sides_are_smooth_and_rims_are_sharp() {
        let mesh = prism(24);
        let shading = Shading::new(&mesh);
        // Two at each corner of a rim: one of the side, one of the lid.
        assert_eq!(shading.origins.len(), mesh.positions.len() + 48);
        for (v, normal) in corners(&shading) {
            let at = mesh.positions[v as usize].with_z(0.0);
            let is_right = normal.z.abs() > 0.9999 || normal.dot(at) > 0.9999;
            assert!(is_right, "{at} {normal}");
        }
    }

    #[test]
    fn flat_sides_stay_flat() {
        let mesh = prism(6);
        let shading = Shading::new(&mesh);
        let triangles = mesh.triangles.as_flattened().len();
        assert_eq!(corners(&shading).count(), triangles);
        for (i, (_, normal)) in corners(&shading).enumerate() {
            let [a, b, c] = mesh.corners(i / 3);
            let flat = (b - a).cross(c - a).normalize();
            assert!(normal.distance(flat) < 1e-6);
        }
    }

    #[test]
    fn normals_are_kept_and_missing_ones_found() {
        let mut mesh = prism(24);
        let mut normals = vec![DVec3::ZERO; mesh.positions.len()];
        normals[3] = DVec3::new(2.0, 0.0, 0.0);
        mesh.normals = Some(normals);
        let shading = Shading::new(&mesh);
        assert_eq!(shading.origins.len(), mesh.positions.len() + 47);
        for (v, normal) in corners(&shading) {
            assert!((normal.length() - 1.0).abs() < 1e-6);
            assert!(v != 3 || normal == DVec3::X);
        }
        let first: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        assert_eq!(shading.origins[..first.len()], first);
    }
}
