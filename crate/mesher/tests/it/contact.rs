//! Meshes of two bodies in contact: their sheets lie on each other.

use crate::judges::{Distances, assert_manifold};
use contact::{Bulge, Squashed};
use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use mesh::TriangleMesh;
use mesher::{Options, Progress, box_of, polygonize};
use std::ops::ControlFlow;
use std::sync::Arc;

/// The largest error of a mesh.
const TOLERANCE: f64 = 0.045;

/// A thick limb that leans to one side.
fn limb(x: f64, lean: f64, kernel: Kernel) -> Arc<dyn Implicit> {
    let shaping = Shaping {
        kernel,
        radius: 0.6,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let [base, apex] = [-0.5, 0.5].map(|y| DVec3::new(x, y, lean * y));
    let segment = Primitive::new(Skeleton::Segment { base, apex }, &shaping, None);
    Arc::new(segment.into_iter().collect::<Sum>())
}

fn meshed(function: &dyn Implicit) -> TriangleMesh {
    let domain = box_of(function.support().expect("it is no plane"));
    let mut report = |_| ControlFlow::Continue(());
    let progress = &mut Progress::new(&mut report);
    let surface = polygonize(function, &domain, &Options::new(TOLERANCE), progress);
    surface.expect("it has a surface").mesh
}

/// The sheet on which the fields are equal is the surface of both bodies where both were inside.
#[test]
fn sheets_lie_on_each_other() {
    let bulges = [
        Bulge::Fast { c: 0.3 },
        Bulge::Height {
            c: 0.3,
            m: 0.65,
            h: 0.2,
        },
        Bulge::Ripple {
            c: 0.3,
            h: 0.15,
            n: 1,
        },
    ];
    for (bulge, kernel) in bulges
        .into_iter()
        .zip([Kernel::Cubed, Kernel::Gauss, Kernel::Cauchy])
    {
        let alone = [limb(-0.2, 0.5, kernel), limb(0.2, -0.5, kernel)];
        let pressed = [0, 1].map(|i| {
            let other = Arc::clone(&alone[1 - i]);
            Squashed::new(Arc::clone(&alone[i]), vec![(other, bulge)])
        });
        let meshes = pressed.each_ref().map(|function| meshed(function));
        for mesh in &meshes {
            assert_manifold("a limb", mesh);
        }
        let mut farthest = 0.0f64;
        for i in [0, 1] {
            let other = Distances::new(&meshes[1 - i]);
            let mut on_sheet = 0;
            for point in &meshes[i].positions {
                // A little inside of the crease, so that the nearest point of the other mesh is on
                // its sheet, too.
                let inside = alone.iter().all(|f| f.jet(*point).value > 1.05 * THRESHOLD);
                if inside {
                    farthest = farthest.max(other.to(*point));
                    on_sheet += 1;
                }
            }
            assert!(on_sheet > 12, "{bulge:?} {on_sheet}");
            // Away from the sheet the bodies are apart.
            let apart = meshes[i].positions.iter().map(|p| other.to(*p));
            assert!(apart.fold(0.0, f64::max) > 0.3);
        }
        println!("{bulge:?}: sheets within {farthest:.2e} of each other");
        assert!(farthest <= 2.0 * TOLERANCE, "{bulge:?} {farthest}");
    }
}
