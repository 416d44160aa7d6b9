//! Meshes of implicit surfaces, judged by others.

use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use mesh::{Topology, self_intersections};
use mesher::{MeshError, Options, Progress, SurfaceMesh, box_of, polygonize};
use std::ops::ControlFlow;

fn shaping(kernel: Kernel, radius: f64) -> Shaping {
    Shaping {
        kernel,
        radius,
        blobbiness: -2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    }
}

fn mesh(sum: &Sum, tolerance: f64, threads: usize) -> Result<SurfaceMesh, MeshError> {
    let domain = box_of(sum.support().expect("no plane"));
    let options = Options {
        threads,
        ..Options::new(tolerance)
    };
    let mut report = |_| ControlFlow::Continue(());
    polygonize(sum, &domain, &options, &mut Progress::new(&mut report))
}

fn check(name: &str, sum: &Sum, tolerance: f64) -> SurfaceMesh {
    let start = std::time::Instant::now();
    let surface = mesh(sum, tolerance, 1).unwrap();
    let time = start.elapsed();
    let topology = Topology::of(&surface.mesh).unwrap();
    let angles: Vec<f64> = (0..surface.mesh.triangles.len())
        .map(|i| mesh::smallest_angle(&surface.mesh.corners(i)).to_degrees())
        .collect();
    let sharp = angles.iter().filter(|a| **a < 15.0).count();
    println!(
        "{name}: {} of {} triangles, {} cells, {topology}; error {:.2e} of {tolerance:.2e}, undecided {}, angles below 15°: {sharp}, least {:.1}, {} evaluations, {time:.2?}",
        surface.mesh.triangles.len(),
        surface.raw_triangles,
        surface.cells,
        surface.error,
        surface.undecided.len(),
        angles.iter().copied().fold(90.0, f64::min),
        surface.evaluations,
    );
    assert!(topology.is_closed_manifold(), "{name}: {topology}");
    let crossings = self_intersections(&surface.mesh, 10).unwrap();
    assert!(crossings.is_free(), "{name}: {crossings:?}");
    assert!(surface.mesh.signed_volume() > 0.0, "{name}");
    assert!(surface.error <= tolerance * 1.001 || !surface.undecided.is_empty(), "{name}");
    // By the slope, as far as first order goes.
    for i in 0..surface.mesh.triangles.len() {
        let [a, b, c] = surface.mesh.corners(i);
        for p in [a, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0] {
            let jet = sum.jet(p);
            let slope = DVec3::from_array(jet.gradient).length();
            let distance = (jet.value - THRESHOLD).abs() / slope;
            assert!(distance < 1.5 * tolerance, "{name}: {p} {distance} {tolerance}");
        }
    }
    surface
}

#[test]
fn simple_shapes() {
    let point = |x: f64, kernel, radius| {
        let center = DVec3::X * x;
        Primitive::new(Skeleton::Point { center }, &shaping(kernel, radius), None).unwrap()
    };
    for kernel in Kernel::ALL {
        if std::env::var("K").is_ok_and(|k| !k.contains(kernel.name())) { continue; }
        let ball = Sum::new(vec![point(0.3, kernel, 1.0)]);
        let surface = check(&format!("ball {kernel:?}"), &ball, 3.5e-3);
        let volume = surface.mesh.signed_volume() * 0.75 / core::f64::consts::PI;
        assert!((volume - 1.0).abs() < 0.02, "{kernel:?}: {volume}");
        let pair = Sum::new(vec![point(0.0, kernel, 1.0), point(1.9, kernel, 0.7)]);
        check(&format!("pair {kernel:?}"), &pair, 4e-3);
        let arc = Skeleton::Arc {
            center: DVec3::ZERO,
            u: DVec3::X,
            v: DVec3::Y,
            radius: 1.0,
            angle: core::f64::consts::TAU,
        };
        let ring: Sum = Primitive::new(arc, &shaping(kernel, 0.3), None).into_iter().collect();
        let surface = check(&format!("ring {kernel:?}"), &ring, 4e-3);
        let topology = Topology::of(&surface.mesh).unwrap();
        assert_eq!(topology.genera, [1], "{kernel:?}");
    }
}
