//! Meshes for the eye: closed, outward, near the surface, and with thin limbs.

use crate::file::primitive;
use core::ops::ControlFlow;
use field::{Implicit, Kernel, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use mesh::{Topology, TriangleMesh};
use mesher::{Cage, MeshError, Progress, look};

/// Returns a large ball, a small one apart from it, and a thin limb that leads from the large one
/// to nowhere, with cages around their skeletons.
fn creature(kernel: Kernel, thin: f64) -> (Sum, Vec<Cage>) {
    let tip = DVec3::new(0.0, 3.0, 0.0);
    let apart = DVec3::new(4.0, 0.0, 0.0);
    let balls = [(DVec3::ZERO, 1.0), (apart, 0.3)];
    let mut cages = Cage::around_lines(&[[(DVec3::ZERO, thin), (tip, thin)]]);
    cages.extend(balls.map(|(center, radius)| Cage::around_point(center, radius)));
    let limb = Skeleton::Segment {
        base: DVec3::ZERO,
        apex: tip,
    };
    let mut all = vec![primitive(limb, kernel, thin)];
    all.extend(balls.map(|(center, radius)| primitive(Skeleton::Point { center }, kernel, radius)));
    (all.into_iter().collect(), cages)
}

fn try_look(
    function: &dyn Implicit,
    cages: &[Cage],
    sizes: [f64; 2],
) -> Result<TriangleMesh, MeshError> {
    look(
        function,
        cages,
        sizes,
        &mut Progress::new(&mut |_| ControlFlow::Continue(())),
    )
}

#[test]
fn mesh_is_closed_and_near_the_surface() {
    for kernel in [Kernel::Gauss, Kernel::Cauchy, Kernel::Cubed] {
        // Twice as thick as a cell, as thick, and a quarter of it.
        for thin in [0.2, 0.1, 0.025] {
            let (sum, cages) = creature(kernel, thin);
            let mesh = try_look(&sum, &cages, [0.01, 0.1]).unwrap();
            let topology = Topology::of(&mesh).unwrap();
            let told = format!("{kernel:?} {thin}: {topology:?}");
            assert_eq!(topology.genera, [0, 0], "{told}");
            assert_eq!(topology.boundary_edges, 0, "{told}");
            assert!(mesh.signed_volume() > 4.0, "{told}");
            let highest = mesh.positions.iter().map(|p| p.y).fold(0.0, f64::max);
            assert!(highest > 3.0, "{told} ends at {highest}");
            let mut inward = 0;
            for i in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(i);
                let jet = sum.jet((a + b + c) / 3.0);
                let slope = DVec3::from_array(jet.gradient);
                // The middles of the smallest cells are off by a part of them.
                let off = (jet.value - THRESHOLD).abs() / slope.length();
                assert!(off < 0.03, "{told} off by {off}");
                inward += usize::from((b - a).cross(c - a).dot(slope) > 0.0);
            }
            // Around the thinnest limb, slivers.
            assert!(
                200 * inward <= mesh.triangles.len(),
                "{told} {inward} face inward"
            );
        }
    }
}

#[test]
fn mesh_has_fewer_triangles_where_the_surface_is_flat() {
    let (sum, cages) = creature(Kernel::Gauss, 0.1);
    let counts = [0.02, 0.005].map(|tolerance| {
        let mesh = try_look(&sum, &cages, [tolerance, 0.02]).unwrap();
        mesh.triangles.len()
    });
    assert!(counts[1] > 2 * counts[0], "{counts:?}");
}

#[test]
fn what_cannot_be_meshed_is_told() {
    let (sum, cages) = creature(Kernel::Gauss, 0.1);
    assert_eq!(
        try_look(&sum, &[], [0.01, 0.1]).unwrap_err(),
        MeshError::Nothing
    );
    for sizes in [[0.0, 0.1], [0.1, f64::NAN], [f64::NAN, 0.1], [0.1, -1.0]] {
        let error = try_look(&sum, &cages, sizes).unwrap_err();
        assert!(
            matches!(error, MeshError::NotFinite(_)),
            "{sizes:?} {error}"
        );
    }
    let error = try_look(&sum, &cages, [1e-9, 1e-6]).unwrap_err();
    assert!(matches!(error, MeshError::TooMany { .. }), "{error}");
    let plane = Skeleton::Plane {
        point: DVec3::ZERO,
        normal: DVec3::Z,
    };
    let plane: Sum = [primitive(plane, Kernel::Gauss, 0.5)].into_iter().collect();
    let error = try_look(&plane, &cages, [0.01, 0.1]).unwrap_err();
    assert_eq!(error, MeshError::Unbounded);
    let error = look(
        &sum,
        &cages,
        [0.01, 0.1],
        &mut Progress::new(&mut |_| ControlFlow::Break(())),
    )
    .unwrap_err();
    assert_eq!(error, MeshError::Cancelled);
}
