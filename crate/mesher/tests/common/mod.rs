//! Judges of meshes.

use field::{Implicit, THRESHOLD};
use glam::DVec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64};
use mesh::{Bvh, Topology, TriangleMesh, closest_point, self_intersections};

/// Whether `manifold-rust` takes a mesh for a closed manifold, of the volume that we say it has.
pub fn assert_manifold(name: &str, mesh: &TriangleMesh) {
    let topology = Topology::of(mesh).unwrap();
    assert!(topology.is_closed_manifold(), "{name}: {topology}");
    let positions = mesh.positions.iter().flat_map(|p| p.to_array());
    let judge = Manifold::from_mesh_gl64(&MeshGL64 {
        num_prop: 3,
        vert_properties: positions.collect(),
        tri_verts: mesh
            .triangles
            .as_flattened()
            .iter()
            .map(|i| u64::from(*i))
            .collect(),
        ..MeshGL64::default()
    });
    assert!(
        matches!(judge.status(), Error::NoError),
        "{name}: {:?}",
        judge.status()
    );
    let (ours, theirs) = (mesh.signed_volume(), judge.volume());
    assert!(
        (ours - theirs).abs() <= 1e-9 * theirs.abs(),
        "{name}: {ours} {theirs}"
    );
}

/// Whether a mesh is proved not to cut itself.
pub fn assert_embedded(name: &str, mesh: &TriangleMesh) {
    let crossings = self_intersections(mesh, 10).unwrap();
    assert!(crossings.is_free(), "{name}: {crossings:?}");
}

/// A point of the surface near a point, by steps of Newton's.
pub fn on_surface(function: &dyn Implicit, mut point: DVec3) -> Option<DVec3> {
    for _ in 0..30 {
        let jet = function.jet(point);
        let gradient = DVec3::from_array(jet.gradient);
        let step = gradient * ((THRESHOLD - jet.value) / gradient.length_squared());
        point += step.clamp_length_max(0.1);
        if step.length() < 1e-12 {
            return Some(point);
        }
    }
    None
}

/// The largest distances found, by sampling, from the mesh to the surface and from the surface to the mesh.
pub fn distances(function: &dyn Implicit, mesh: &TriangleMesh, samples: usize) -> [f64; 2] {
    let bvh = Bvh::new(&mesh.triangle_boxes());
    let mut farthest = [0.0_f64; 2];
    let mut state = 7_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    for _ in 0..samples {
        let i = (random() * mesh.triangles.len() as f64) as usize;
        let [a, b, c] = mesh.corners(i);
        let (mut u, mut v) = (random(), random());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let point = a + (b - a) * u + (c - a) * v;
        let Some(found) = on_surface(function, point) else {
            continue;
        };
        farthest[0] = farthest[0].max(point.distance(found));
        // A point of the surface somewhere near, found from outside of the mesh.
        let size = a.distance(b).max(a.distance(c));
        let off = DVec3::new(random(), random(), random()) - 0.5;
        if let Some(found) = on_surface(function, point + off * size) {
            let closest =
                |i: u32| closest_point(&mesh.corners(i as usize), found).distance_squared(found);
            if let Some((_, square)) = bvh.nearest(found, f64::INFINITY, closest) {
                farthest[1] = farthest[1].max(square.sqrt());
            }
        }
    }
    farthest
}
