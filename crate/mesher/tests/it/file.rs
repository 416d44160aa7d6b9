//! Meshes whose error is measured: sound at any tolerance, and the same on any number of threads.

use crate::judges::{Distances, assert_embedded, assert_manifold, crossings, of_mesh};
use field::{BlobScale, Implicit, Kernel, Primitive, Profile, Shaping, Skeleton, Sum, Taper, Wave};
use glam::DVec3;
use mesh::{Aabb, Topology};
use mesher::{
    MeshError, Model, Options, Progress, SurfaceMesh, Tolerance, Wishes, approximate, box_of,
    mesh_scene,
};
use oracle::Reference;
use oracle::reference::Near;
use scene::Scene;
use std::ops::ControlFlow;
use std::sync::Arc;
use trials::{Random, count};

pub fn primitive(skeleton: Skeleton, kernel: Kernel, radius: f64) -> Primitive {
    let shaping = Shaping {
        kernel,
        radius,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    Primitive::new(skeleton, &shaping, None).unwrap()
}

/// A thin tail between a large and a small ball.
fn tail(kernel: Kernel) -> Sum {
    let (base, apex) = (DVec3::ZERO, DVec3::new(5.0, 1.0, 0.5));
    let parts = [
        (Skeleton::Point { center: base }, 2.0),
        (Skeleton::Point { center: apex }, 0.6),
        (Skeleton::Segment { base, apex }, 0.03),
    ];
    let parts = parts.map(|(skeleton, radius)| primitive(skeleton, kernel, radius));
    parts.into_iter().collect()
}

fn build(sum: &Sum, options: &Options) -> Result<SurfaceMesh, MeshError> {
    build_in(
        sum,
        &box_of(sum.support().expect("it is no plane")),
        options,
    )
}

fn build_in(sum: &Sum, domain: &Aabb, options: &Options) -> Result<SurfaceMesh, MeshError> {
    build_for(sum, domain, options, usize::MAX).0
}

/// The mesh, unless it is cancelled after so many steps, and how many there were.
fn build_for(
    sum: &Sum,
    domain: &Aabb,
    options: &Options,
    steps: usize,
) -> (Result<SurfaceMesh, MeshError>, usize) {
    let mut step = 0;
    let result = approximate(
        sum,
        &[],
        domain,
        options,
        &mut Progress::new(&mut |_| {
            step += 1;
            if step > steps {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }),
    );
    (result, step)
}

#[test]
fn thin_tail_is_unbroken_at_any_tolerance() {
    let mut random = Random::new(3);
    for kernel in [Kernel::Gauss, Kernel::Cauchy, Kernel::Quartic] {
        let sum = tail(kernel);
        for tolerance in [0.1, 0.03, 0.005] {
            let name = format!("{kernel:?} {tolerance}");
            let surface = build(&sum, &Options::new(tolerance)).unwrap();
            let mesh = &surface.mesh;
            assert_manifold(&name, mesh);
            assert_embedded(&name, mesh);
            let genera = Topology::of(mesh).unwrap().genera;
            assert_eq!(genera, [0], "{name}");
            println!(
                "{name}: {} of {} triangles, {:?}",
                mesh.triangles.len(),
                surface.raw_triangles,
                surface.measured.largest.map(|d| d / tolerance),
            );
            assert!(surface.error <= tolerance, "{name}: {}", surface.error);
            let mut reference = Reference::new(sum.primitives.clone());
            reference.patience = 3000;
            let mut sure = 0;
            for _ in 0..count(100) {
                let (_, point) = of_mesh(&mut random, mesh);
                match reference.surface_near(point, 1.001 * tolerance) {
                    Near::Within(_) => sure += 1,
                    Near::Unknown => {}
                    Near::Beyond => panic!("{name}: {point} is too far"),
                }
            }
            assert!(2 * sure > count(100), "{name}: {sure}");
            let near = Distances::new(mesh);
            for _ in 0..count(100) {
                let from = DVec3::new(5.0, 1.0, 0.5) * random.unit();
                let way = random.direction();
                for t in crossings(&sum, from, way, 4.0, 1e-3 * tolerance) {
                    let off = near.to(from + way * t);
                    assert!(off <= 1.001 * tolerance, "{name}: {off}");
                }
            }
        }
    }
}

/// The edges of a cube as limbs that taper.
fn frame(kernel: Kernel, blobbiness: f64) -> Sum {
    fn corner(i: usize) -> DVec3 {
        DVec3::from([1, 2, 4].map(|bit| if i & bit == 0 { 0.0 } else { 1.0 }))
    }
    let limbs = (0..8_usize).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit)));
    let limbs = limbs.filter(|(i, j)| i != j).filter_map(|(i, j)| {
        let shaping = Shaping {
            kernel,
            radius: 0.06,
            blobbiness,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: Some(Taper {
                radius: 0.04,
                blobbiness,
            }),
        };
        let (base, apex) = (corner(i), corner(j));
        Primitive::new(Skeleton::Segment { base, apex }, &shaping, None)
    });
    limbs.collect()
}

/// Cells on limbs are as large as these are thick, however steep the field is there.
#[test]
fn lattices_of_limbs_take_few_evaluations_and_keep_their_cycles() {
    for kernel in [Kernel::Soft, Kernel::Quartic, Kernel::Compact6] {
        for blobbiness in [2.0, 10.0, 30.0] {
            let name = format!("{kernel:?} {blobbiness}");
            let sum = frame(kernel, blobbiness);
            assert_eq!(sum.primitives.len(), 12);
            let surface = build(&sum, &Options::new(0.01)).unwrap();
            assert_manifold(&name, &surface.mesh);
            assert_embedded(&name, &surface.mesh);
            assert_eq!(Topology::of(&surface.mesh).unwrap().genera, [5], "{name}");
            assert!(surface.error <= 0.01, "{name}: {}", surface.error);
            println!(
                "{name}: {} evaluations, {} cells, {} of {} triangles",
                surface.evaluations,
                surface.cells,
                surface.mesh.triangles.len(),
                surface.raw_triangles
            );
            assert!(
                surface.evaluations < 1_000_000,
                "{name}: {}",
                surface.evaluations
            );
        }
    }
}

#[test]
fn threads_change_no_bit() {
    let sum = tail(Kernel::Cauchy);
    let options = Options::new(0.03);
    let one = build(&sum, &options).unwrap();
    let three = build(
        &sum,
        &Options {
            threads: 3,
            ..options
        },
    )
    .unwrap();
    assert_eq!(one.mesh, three.mesh);
    assert_eq!(one.measured, three.measured);
}

#[test]
fn what_the_box_cuts_off_is_closed() {
    let sum = tail(Kernel::Gauss);
    let mut domain = box_of(sum.support().unwrap());
    domain.min.x = 0.5;
    domain.max.y = 0.7;
    let surface = build_in(&sum, &domain, &Options::new(0.02)).unwrap();
    assert!(surface.is_cut);
    assert_manifold("cut", &surface.mesh);
    assert_embedded("cut", &surface.mesh);
    let bounds = surface.mesh.bounds();
    assert_eq!(bounds.min.x, 0.5);
    assert_eq!(bounds.max.y, 0.7);
}

#[test]
fn a_break_cancels_at_any_step() {
    let sum = tail(Kernel::Gauss);
    let domain = box_of(sum.support().unwrap());
    let options = Options::new(0.1);
    let (_, steps) = build_for(&sum, &domain, &options, usize::MAX);
    assert!(steps > 10);
    for last in (0..steps).step_by(1 + steps / count(8)) {
        let (result, _) = build_for(&sum, &domain, &options, last);
        assert_eq!(result.unwrap_err(), MeshError::Cancelled);
    }
}

#[test]
fn limits_hold() {
    let sum = tail(Kernel::Gauss);
    let options = Options {
        max_triangles: 100,
        ..Options::new(0.01)
    };
    assert!(matches!(
        build(&sum, &options),
        Err(MeshError::TooMany { limit: 100, fitting: Some(fitting) }) if fitting > 0.01
    ));
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let result = build(&sum, &Options::new(tolerance));
        assert!(matches!(result, Err(MeshError::NotFinite(_))));
    }
}

/// The scene of a text that has no faults.
fn compile(text: String) -> Arc<Scene> {
    let name = "scene.rat".into();
    let files = vec![rats::File { name, text }];
    let outcome = rats::compile_at(&rats::Project { files }, &[], 0.0);
    outcome.scene
}

fn mesh(scene: &Scene, tolerance: Tolerance) -> Result<Model, MeshError> {
    let wishes = Wishes {
        tolerance,
        prove: false,
        ..Wishes::default()
    };
    let progress = &mut |_| ControlFlow::Continue(());
    mesh_scene(scene, &wishes, &mut Progress::new(progress))
}

/// Balls much smaller than their distances, however steep or wide their fields are.
#[test]
fn small_balls_are_not_missed() {
    let mut random = Random::new(11);
    for kernel in Kernel::ALL {
        for blobbiness in [0.3, 1.0, 2.0, 10.0] {
            let name = format!("{kernel:?} {blobbiness}");
            let mut centers: Vec<DVec3> = Vec::new();
            while centers.len() < 18 {
                let center = DVec3::from([(); 3].map(|()| random.range(-8.0, 8.0)));
                if centers.iter().all(|other| center.distance(*other) > 4.0) {
                    centers.push(center);
                }
            }
            let balls = centers.iter().filter_map(|center| {
                let shaping = Shaping {
                    kernel,
                    radius: 0.1,
                    blobbiness,
                    blob_scale: BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                Primitive::new(Skeleton::Point { center: *center }, &shaping, None)
            });
            let sum: Sum = balls.collect();
            let surface = build(&sum, &Options::new(0.01)).unwrap();
            assert_manifold(&name, &surface.mesh);
            let shells = Topology::of(&surface.mesh).unwrap().genera;
            assert_eq!(shells, [0; 18], "{name}");
        }
    }
}

/// Clusters of points, none of which has a surface by itself.
#[test]
fn weak_points_are_not_missed_together() {
    let mut random = Random::new(12);
    for kernel in Kernel::ALL {
        let mut points = Vec::new();
        for cluster in [[-5.0, -5.0, -5.0], [5.0, 5.0, 5.0], [1.2, 3.2, -3.1]] {
            let cluster = DVec3::from(cluster);
            for _ in 0..200 {
                let shaping = Shaping {
                    kernel,
                    radius: 0.2,
                    blobbiness: 2.0,
                    blob_scale: BlobScale::Relative,
                    strength: 0.01,
                    influence: 1e-3,
                    taper: None,
                };
                let center = cluster + 0.02 * random.direction();
                points.extend(Primitive::new(Skeleton::Point { center }, &shaping, None));
            }
        }
        let sum: Sum = points.into_iter().collect();
        let domain = Aabb::of_points([DVec3::splat(-6.0), DVec3::splat(6.0)]);
        let surface = build_in(&sum, &domain, &Options::new(0.02)).unwrap();
        assert_manifold(&format!("{kernel:?}"), &surface.mesh);
        let shells = Topology::of(&surface.mesh).unwrap().genera;
        assert_eq!(shells, [0; 3], "{kernel:?}");
    }
}

/// Skeletons side by side, none of which has a surface by itself.
#[test]
fn weak_skeletons_are_not_missed_together() {
    let mut text = String::from("surface s diffuse White blob -2 strength 0.004\n");
    for i in 0..60 {
        let [x, z] = [i % 8, i / 8].map(|k| f64::from(k) * 1e-3);
        text += &format!(
            "skeleton s, S{i} local 5 {{\n\
                 node A <{x} 0 {z}> radius 0.04 node B <0.3 0.1 0.2> radius 0.04 curve A B\n}}\n"
        );
    }
    text += "surface t diffuse White blob -2\n\
        skeleton t, THICK local 5 {\n\
            node A <-9 -5 -7> radius 0.4 node B <-6 -5 -7> radius 0.4 curve A B\n\
        }\n";
    let model = mesh(&compile(text), Tolerance::Absolute(0.05)).unwrap();
    let shells = Topology::of(&model.parts[0].mesh).unwrap().genera;
    assert_eq!(shells, [0; 2]);
}

/// Balls where the gradient of another shape jumps, smaller than cells of the usual size.
#[test]
fn small_balls_at_kinks_are_not_missed() {
    let mut random = Random::new(13);
    let profile = Profile {
        waves: [Wave::Hat, Wave::One],
        scale: [4.0, 1.0],
        bounds: [0.5, 1.0],
        ..Profile::default()
    };
    let (base, apex) = (DVec3::NEG_X * 4.0, DVec3::X * 4.0);
    let shaping = Shaping {
        kernel: Kernel::Gauss,
        radius: 0.5,
        blobbiness: 2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let line = Primitive::new(Skeleton::Segment { base, apex }, &shaping, Some(profile));
    let mut sum: Sum = line.into_iter().collect();
    for i in 0..12 {
        let center = DVec3::new(
            random.range(-0.05, 0.05),
            1.6 + 0.05 * f64::from(i),
            random.range(-0.1, 0.1),
        );
        let shaping = Shaping {
            radius: 0.012,
            ..shaping
        };
        let ball = Primitive::new(Skeleton::Point { center }, &shaping, None);
        sum.primitives.extend(ball);
    }
    let surface = build(&sum, &Options::new(0.02)).unwrap();
    let shells = Topology::of(&surface.mesh).unwrap().genera.len();
    assert!(shells == 13, "{shells}");
}

/// Kernels that fall steeply take no small cells in limbs, and the creases between limbs do not
/// make the mesh cut itself.
#[test]
fn struts_take_few_cells() {
    let mut text = String::from(
        "surface S, radius 2.3, kernel compact6, blobbiness -8\nskeleton S, CUBE subdivide 0 {\n\
         node A <0 0 0> node B <30 2 0> node C <31 30 1> node D <0 28 3>\n\
         node E <1 0 30> node F <30 1 31> node G <32 30 30> node H <0 30 28> node M <14 16 15>\n",
    );
    let struts = "AB BC CD DA EF FG GH HE AE BF CG DH AM BM CM DM EM FM GM HM";
    for strut in struts.split(' ') {
        let (from, to) = strut.split_at(1);
        text += &format!("curve {from} {to}\n");
    }
    let model = mesh(&compile(text + "}\n"), Tolerance::Relative(1e-3)).unwrap();
    let part = &model.parts[0];
    assert!(part.is_measured && part.error <= model.tolerance);
    assert_embedded("struts", &part.mesh);
    // Edges less nodes, plus one.
    let topology = Topology::of(&part.mesh).unwrap();
    assert!(topology.is_closed_manifold());
    assert_eq!(topology.genera, [20 - 9 + 1]);
    assert!(part.raw_triangles < 100_000, "{}", part.raw_triangles);
}

/// Limbs that are thousands of times longer than thick take no cells along them: branches, bends, a
/// ring, and limbs that are thinner than the tolerance.
#[test]
fn thin_limbs_are_one_shell_of_few_triangles() {
    for tolerance in [0.003, 0.05, 0.15] {
        let text = String::from(
            "surface S, radius 0.05, kernel compact6, blobbiness -8\n\
             skeleton S, TREE subdivide 0 {\n\
             node A <0 0 0> node B <200 9 0> node C <310 60 20> node D <290 -70 10>\n\
             node E <420 10 -30> node F <-150 30 40> node G <-160 200 -9> node H <500 200 90>\n\
             node I <150 300 -20>\n",
        );
        let limbs = "AB BC BD CE DE AF AG EH CI".split(' ');
        let limbs = limbs.map(|limb| limb.split_at(1));
        let limbs: String = limbs.map(|(a, b)| format!("curve {a} {b}\n")).collect();
        let name = format!("within {tolerance}");
        let scene = compile(text + &limbs + "}\n");
        let model = mesh(&scene, Tolerance::Absolute(tolerance)).unwrap();
        let part = &model.parts[0];
        println!(
            "{name}: {} of {} triangles, {:?}",
            part.mesh.triangles.len(),
            part.raw_triangles,
            part.error
        );
        assert!(part.is_measured && part.error <= model.tolerance, "{name}");
        assert!(part.undecided.is_empty(), "{name}");
        assert_manifold(&name, &part.mesh);
        assert_embedded(&name, &part.mesh);
        // Edges less nodes, plus one.
        assert_eq!(Topology::of(&part.mesh).unwrap().genera, [1], "{name}");
        assert!(part.raw_triangles < 20_000, "{name}");
    }
}

/// A ball that carves another leaves a cavity far smaller than the cells that its kernel asks for.
#[test]
fn small_cavities_are_not_missed() {
    let mut random = Random::new(31);
    for _ in 0..count(6) {
        let center = random.direction() * 0.3;
        let off = center + random.direction() * random.range(0.03, 0.06);
        let text = format!(
            "surface S, radius 1, kernel gauss, blobbiness -8\n\
             surface C, radius 0.5, kernel gauss, blobbiness -8, strength -1\n\
             sphere S 1 {} {} {}\nsphere C 0.5 {} {} {}\n",
            center.x, center.y, center.z, off.x, off.y, off.z
        );
        let model = mesh(&compile(text), Tolerance::Absolute(2e-3)).unwrap();
        let topology = Topology::of(&model.parts[0].mesh).unwrap();
        assert_eq!(topology.genera.len(), 2, "{center} {off}");
    }
}

/// Bounds on local convolution tell nothing of large cells.
#[test]
fn thin_limbs_of_local_convolution_are_not_missed() {
    let text = "surface s diffuse White blob -2\n\
        skeleton s, THICK local 5 {\n\
            node A <0 0 0> radius 0.4 node B <3 0 0> radius 0.4 curve A B\n\
        }\n\
        skeleton s, THIN local 5 {\n\
            node A <0 2 1> radius 0.08 node B <3 -1 2> radius 0.08 curve A B\n\
        }\n";
    let scene = compile(text.into());
    let model = mesh(&scene, Tolerance::Absolute(0.05)).unwrap();
    let meshes = model
        .parts
        .iter()
        .map(|part| Topology::of(&part.mesh).unwrap());
    assert_eq!(meshes.map(|mesh| mesh.genera.len()).sum::<usize>(), 2);
}

#[test]
fn bodies_on_each_other_end_with_words() {
    let ball = "sphere s 1 0 0 0\n";
    let text = format!(
        "surface s diffuse White blob -2\nbody A\n{ball}close\nbody B\n{ball}close\ncontact A B\n"
    );
    let scene = compile(text);
    assert_eq!(scene.surfaces().len(), 2);
    let result = mesh(&scene, Tolerance::Relative(1e-2));
    // As the one takes away what the other has, nothing is left of either.
    assert!(
        matches!(result, Err(MeshError::Nothing | MeshError::Flat { .. })),
        "{result:?}"
    );
}
