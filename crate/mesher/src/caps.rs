//! Flat ends of skeletons as groups of triangles, so that they can be chosen in other programs.

use glam::DVec3;
use mesh::{Group, TriangleMesh};
use scene::flat_ends::FlatEnd;

/// Distance from its plane, in radii, within which a vertex is one of a flat end.
const NEAR: f64 = 0.06;
/// Distance from its middle, in radii, within which a vertex is one of a flat end.
const WIDE: f64 = 1.2;
/// Least cosine of the angle between the plane and a triangle of a flat end.
const ALONG: f64 = 0.9;

/// Share of its radius within which the places of two flat ends are one.
const SAME: f64 = 1e-6;

/// Number of holes that flat ends leave in a mesh, and whether vertices were moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Caps {
    /// Number of open ends.
    pub holes: usize,
    /// Whether vertices were moved, so that triangles may touch that did not.
    pub are_moved: bool,
}

/// Leaves out ends that meet another one at the same place, where the limbs go on in each other.
fn drop_joints(ends: &[FlatEnd]) -> Vec<FlatEnd> {
    let free = ends.iter().enumerate().filter(|(i, own)| {
        !ends.iter().enumerate().any(|(other, end)| {
            let near = SAME * own.radius.min(end.radius);
            let is_same = own.at.distance(end.at) <= near;
            other != *i && is_same && own.outward.dot(end.outward) < 0.0
        })
    });
    free.map(|(_, end)| *end).collect()
}

/// Parts the only group of a mesh: triangles of flat ends come last, with a group and a material
/// for each, `inlet` for the widest end and `outlet-1` … for the others. Their vertices are moved
/// into the plane. Triangles of open ends are taken out. Ends that meet are none.
pub fn part(mesh: &mut TriangleMesh, ends: &[FlatEnd]) -> Caps {
    let ends = &drop_joints(ends)[..];
    let [whole] = &mesh.groups[..] else {
        return Caps::default();
    };
    if ends.is_empty() {
        return Caps::default();
    }
    let whole = whole.clone();
    let mut of: Vec<Option<usize>> = (0..mesh.triangles.len())
        .map(|i| {
            let corners = mesh.corners(i);
            ends.iter().position(|end| is_on(corners, end))
        })
        .collect();
    let mut end_at = vec![None; mesh.positions.len()];
    for (triangle, end) in mesh.triangles.iter().zip(&of) {
        for corner in triangle.iter().filter(|_| end.is_some()) {
            end_at[*corner as usize] = *end;
        }
    }
    for (position, end) in mesh.positions.iter_mut().zip(&end_at) {
        if let Some(end) = end.map(|end| &ends[end]) {
            *position -= end.outward * end.outward.dot(*position - end.at);
        }
    }
    // A triangle whose three corners were moved into the plane of an end is part of that end.
    for (end, triangle) in of.iter_mut().zip(&mesh.triangles) {
        let [a, b, c] = triangle.map(|i| end_at[i as usize]);
        if a == b && b == c {
            *end = a;
        }
    }
    let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
    order.retain(|i| of[*i].is_none_or(|end| !ends[end].is_open));
    // Those of no end come first.
    order.sort_by_key(|i| of[*i].map_or(0, |end| end + 1));
    mesh.triangles = order.iter().map(|i| mesh.triangles[*i]).collect();
    let flat = (0..ends.len()).filter(|end| !ends[*end].is_open);
    let widest = flat.reduce(|a, b| {
        if ends[b].radius > ends[a].radius {
            b
        } else {
            a
        }
    });
    let mut outlets = 1..;
    let mut holes = 0;
    let mut start = of.iter().filter(|end| end.is_none()).count() as u32;
    mesh.groups[0].triangles = 0..start;
    for (end, own) in ends.iter().enumerate() {
        let count = of.iter().filter(|at| **at == Some(end)).count() as u32;
        if own.is_open {
            holes += usize::from(count > 0);
            continue;
        }
        let name = match widest == Some(end) {
            true => String::from("inlet"),
            false => format!("outlet-{}", outlets.next().unwrap_or(1)),
        };
        if count == 0 {
            continue;
        }
        let mut material = whole.material.clone().unwrap_or_default();
        material.name.clone_from(&name);
        mesh.groups.push(Group {
            name,
            material: Some(material),
            triangles: start..start + count,
        });
        start += count;
    }
    if holes > 0 {
        drop_lonely_vertices(mesh);
    }
    Caps {
        holes,
        are_moved: end_at.iter().any(Option::is_some),
    }
}

/// Takes out the vertices that no triangle has.
fn drop_lonely_vertices(mesh: &mut TriangleMesh) {
    let mut places = vec![u32::MAX; mesh.positions.len()];
    let mut kept = Vec::new();
    for corner in mesh.triangles.as_flattened_mut() {
        let place = &mut places[*corner as usize];
        if *place == u32::MAX {
            *place = kept.len() as u32;
            kept.push(*corner as usize);
        }
        *corner = *place;
    }
    mesh.positions = kept.iter().map(|i| mesh.positions[*i]).collect();
    if let Some(normals) = &mut mesh.normals {
        *normals = kept.iter().map(|i| normals[*i]).collect();
    }
    if let Some(colors) = &mut mesh.colors {
        *colors = kept.iter().map(|i| colors[*i]).collect();
    }
}

/// Whether a triangle is one of a flat end.
fn is_on(corners: [DVec3; 3], end: &FlatEnd) -> bool {
    let is_near = corners.iter().all(|corner| {
        let offset = *corner - end.at;
        let across = end.outward.dot(offset).abs();
        across <= NEAR * end.radius && offset.length() <= WIDE * end.radius
    });
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    is_near && normal.dot(end.outward) >= ALONG * normal.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh::Material;

    /// A prism of six sides around the x axis from 0 to 5, whose lids are shifted by 0.02.
    fn prism() -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for x in [0.02, 4.98] {
            mesh.positions.push(DVec3::X * x);
            for i in 0..6 {
                let (sine, cosine) = libm::sincos(f64::from(i) * std::f64::consts::FRAC_PI_3);
                mesh.positions.push(DVec3::new(x, cosine, sine));
            }
        }
        for i in 0..6_u32 {
            let [a, b] = [1 + i, 1 + (i + 1) % 6];
            mesh.triangles.push([0, b, a]);
            mesh.triangles.push([7, 7 + a, 7 + b]);
            mesh.triangles.push([a, b, 7 + b]);
            mesh.triangles.push([a, 7 + b, 7 + a]);
        }
        mesh.groups = vec![Group {
            name: String::new(),
            material: Some(Material::default()),
            triangles: 0..24,
        }];
        mesh
    }

    #[test]
    fn lids_are_groups_in_their_planes() {
        let ends =
            [(0.0, DVec3::NEG_X, 1.0), (5.0, DVec3::X, 1.01)].map(|(x, outward, radius)| FlatEnd {
                at: DVec3::X * x,
                outward,
                radius,
                is_open: false,
            });
        let mut mesh = prism();
        assert_eq!(part(&mut mesh, &ends).holes, 0);
        let names: Vec<(&str, u32)> = mesh
            .groups
            .iter()
            .map(|group| (&group.name[..], group.triangles.len() as u32))
            .collect();
        assert_eq!(names, [("", 12), ("outlet-1", 6), ("inlet", 6)]);
        for (group, x) in mesh.groups[1..].iter().zip([0.0, 5.0]) {
            for i in group.triangles.clone() {
                assert!(
                    mesh.corners(i as usize)
                        .iter()
                        .all(|corner| (corner.x - x).abs() < 1e-12)
                );
            }
            assert_eq!(group.material.as_ref().unwrap().name, group.name);
        }
        // Ends elsewhere, or that look the other way, are none of the mesh.
        let mut same = prism();
        let other = FlatEnd {
            outward: DVec3::NEG_X,
            ..ends[1]
        };
        assert_eq!(part(&mut same, &[other]), Caps::default());
        assert_eq!(same.triangles, prism().triangles);
        assert_eq!(same.groups, prism().groups);
        // One that is open is a hole, and the other one the widest that there is.
        let mut mesh = prism();
        let open = FlatEnd {
            is_open: true,
            ..ends[1]
        };
        assert_eq!(part(&mut mesh, &[ends[0], open]).holes, 1);
        let names: Vec<(&str, u32)> = mesh
            .groups
            .iter()
            .map(|group| (&group.name[..], group.triangles.len() as u32))
            .collect();
        assert_eq!(names, [("", 12), ("inlet", 6)]);
        assert_eq!(mesh.positions.len(), 13);
        let rims = [0.0, 5.0].map(|x| mesh.positions.iter().filter(|p| p.x == x).count());
        assert_eq!(rims, [7, 6]);
    }
}
