//! Levels of detail: topology, the error that is told, what is carried over.

use crate::solids::{sphere, torus};
use glam::DVec3;
use mesh::{HalfEdgeMesh, Topology, closest_point, levels_of_detail, simplify};

#[test]
fn levels_keep_topology_and_tell_their_error() {
    for (mesh, genus) in [(sphere(24), 0), (torus(60, 30), 1)] {
        let mut mesh = mesh;
        mesh.normals = Some(mesh.positions.clone());
        mesh.colors = Some(
            mesh.positions
                .iter()
                .map(|p| [p.x.abs() as f32 / 2.0; 3])
                .collect(),
        );
        let levels = levels_of_detail(&mesh, 60).unwrap();
        assert!(levels.len() >= 2, "{}", levels.len());
        let mut count = mesh.triangles.len();
        for level in &levels {
            let own = &level.mesh;
            assert!(own.triangles.len() <= (count / 4).max(60));
            count = own.triangles.len();
            let topology = Topology::of(own).unwrap();
            assert!(topology.is_closed_manifold());
            assert_eq!(topology.genera, [genus]);
            assert!(level.error < 0.35, "{}", level.error);
            // The error against all triangles, one by one.
            for p in mesh.positions.iter().step_by(17) {
                let distances = (0..count).map(|i| closest_point(&own.corners(i), *p).distance(*p));
                assert!(distances.fold(f64::INFINITY, f64::min) <= level.error);
            }
            assert_eq!(own.normals.as_ref().unwrap().len(), own.positions.len());
            for (p, c) in own.positions.iter().zip(own.colors.as_ref().unwrap()) {
                let expected = p.x.abs() as f32 / 2.0;
                assert!(
                    f64::from((c[0] - expected).abs()) < 0.01 + level.error,
                    "{p} {c:?}"
                );
            }
        }
        // A regular torus of as many triangles is off by 0.016.
        let errors: Vec<f64> = levels.iter().map(|level| level.error).collect();
        assert!(errors[0] < 0.1, "{errors:?}");
        assert_eq!(levels, levels_of_detail(&mesh, 60).unwrap());
    }
}

#[test]
fn flat_parts_vanish_and_edges_stay() {
    // A cube's faces as grids: nothing is lost down to forty triangles.
    let mut cube = HalfEdgeMesh::from_polygons(&crate::solids::cube()).unwrap();
    for _ in 0..3 {
        cube.triangulate().unwrap();
        for h in cube.edges().collect::<Vec<_>>() {
            let middle = 0.5 * (cube.position(cube.origin(h)) + cube.position(cube.target(h)));
            cube.bisect_edge(h, middle).unwrap();
        }
    }
    cube.triangulate().unwrap();
    assert!(cube.face_count() > 500);
    simplify(&mut cube, 40);
    cube.validate().unwrap();
    let mesh = cube.to_triangles().unwrap();
    assert!(mesh.triangles.len() <= 40, "{}", mesh.triangles.len());
    assert!(
        (mesh.signed_volume() - 1.0).abs() < 1e-6,
        "{}",
        mesh.signed_volume()
    );
    // A tetrahedron cannot be simplified.
    let mut least = HalfEdgeMesh::from_triangles(&sphere(1)).unwrap();
    simplify(&mut least, 0);
    least.validate().unwrap();
    assert!(least.face_count() >= 4);
    let mut open = sphere(3);
    open.triangles.push([0, 1, 2]);
    open.positions[0] += DVec3::X * 1e-3;
    assert!(levels_of_detail(&open, 4).is_err());
}
