//! Skins against the fields they come from: what is skinned stays on the surface of the scene that
//! moved.

use glam::DVec3;
use mesh::{Export, Part, TriangleMesh};
use rats::{Project, compile_at};
use scene::Scene;

fn scenes(text: &str, count: u32) -> Vec<Scene> {
    let project = Project::single(text);
    let scene = |frame: u32| {
        let compiled = compile_at(&project, &[], f64::from(frame));
        let worst = compiled.diagnostics.iter().map(|d| d.severity).max();
        assert!(
            worst <= Some(rats::Severity::Warning),
            "{:?}",
            compiled.diagnostics
        );
        std::sync::Arc::unwrap_or_clone(compiled.scene)
    };
    (0..count).map(scene).collect()
}

/// Points of the surface of the first body: along rays from points of its curves.
fn on_surface(scene: &Scene) -> Vec<DVec3> {
    let surfaces = scene.soft_surfaces();
    let sum = &surfaces[0].sum;
    let curves = scene.elements.iter().filter_map(|e| e.shape.curves());
    let mut points = Vec::new();
    for (place, _) in curves.flat_map(|c| c.points().collect::<Vec<_>>()) {
        for i in 0..8 {
            let angle = f64::from(i) * 0.785;
            let direction = DVec3::new(0.3, libm::cos(angle), libm::sin(angle)).normalize();
            let value = |t: f64| sum.jet(place + direction * t).value - field::THRESHOLD;
            let (mut inside, mut outside) = (1e-3, 2.0);
            if value(inside) < 0.0 || value(outside) > 0.0 {
                continue;
            }
            for _ in 0..50 {
                let middle = 0.5 * (inside + outside);
                if value(middle) > 0.0 {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            points.push(place + direction * inside);
        }
    }
    assert!(points.len() > 100, "{}", points.len());
    points
}

const SNAKE: &str = "\
surface s, kernel cauchy, blobbiness -3, diffuse Red, radius 0.3
skeleton s, SNAKE {
  node A <0 3 0> node B <1 3 0> node C <2 3 0> node D <3 3 0> node E <4 3 0>
  node LEG <2 2 0.8> radius 0.2
  curve A B C D E
  curve C LEG
}
motion { pin A, bending 0.1 }
";

#[test]
fn skinned_vertices_stay_near_the_surface_that_moved() {
    let scenes = scenes(SNAKE, 16);
    let points = on_surface(&scenes[0]);
    let mesh = TriangleMesh::new(points.clone(), vec![]);
    let rig = rig::rig(&scenes, 25.0, &[(Some(0), &mesh)]).unwrap();
    assert_eq!(rig.joints.len(), 1 + 6);
    assert_eq!(rig.frames.len(), 16);
    // The tip has fallen by more than its thickness.
    let [first, last] = [0, 15].map(|frame: usize| {
        let curves = scenes[frame].elements[0].shape.curves().unwrap();
        curves.skeleton.nodes[4].position
    });
    assert!(last.distance(first) > 1.0, "{last}");
    for (frame, scene) in scenes.iter().enumerate() {
        let sum = &scene.soft_surfaces()[0].sum;
        let mut worst = 0.0f64;
        for (point, shares) in points.iter().zip(&rig.shares[0]) {
            let weights: f32 = shares.iter().map(|share| share.1).sum();
            assert!((weights - 1.0).abs() < 1e-5);
            let moved = rig.skin(*point, shares, &rig.frames[frame]);
            if frame == 0 {
                assert!(moved.distance(*point) < 1e-6);
            }
            let jet = sum.jet(moved);
            let slope = DVec3::from(jet.gradient).length().max(0.5);
            worst = worst.max((jet.value - field::THRESHOLD).abs() / slope);
        }
        // A linear skin of few joints is off where the body bends most: by less than half its
        // thickness.
        assert!(worst < 0.16, "frame {frame}: {worst}");
    }
}

#[test]
fn what_no_skeleton_holds_stays() {
    let text = format!("{SNAKE}sphere s 0.3, 9 9 9\n");
    let scenes = scenes(&text, 10);
    let mesh = TriangleMesh::new(
        vec![DVec3::new(9.3, 9.0, 9.0), DVec3::new(0.0, 3.3, 0.0)],
        vec![],
    );
    let rig = rig::rig(&scenes, 25.0, &[(Some(0), &mesh)]).unwrap();
    let moved = |i: usize| rig.skin(mesh.positions[i], &rig.shares[0][i], &rig.frames[9]);
    // The ball and the snake are one body, whose far ends have next to nothing of each other.
    assert_eq!(rig.shares[0][0][0], (0, 1.0));
    assert_eq!(moved(0), mesh.positions[0]);
    assert!(rig.shares[0][1][0].0 != 0);
    assert!(moved(1).distance(mesh.positions[1]) < 0.2, "{}", moved(1));
}

#[test]
fn hard_shapes_stay_however_near_they_are() {
    let scenes = scenes(SNAKE, 10);
    let mesh = TriangleMesh::new(on_surface(&scenes[0]), vec![]);
    let rig = rig::rig(&scenes, 25.0, &[(None, &mesh)]).unwrap();
    assert!(rig.shares[0].iter().all(|shares| shares[0] == (0, 1.0)));
}

#[test]
fn a_rigged_file_is_written_and_read() {
    let scenes = scenes(SNAKE, 5);
    let points = on_surface(&scenes[0]);
    let triangles = (0..points.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let mesh = TriangleMesh::new(points, triangles.collect());
    let rig = rig::rig(&scenes, 25.0, &[(Some(0), &mesh)]).unwrap();
    let export = Export {
        name: "snake".into(),
        parts: vec![Part {
            name: "snake".into(),
            mesh,
        }],
        millimetres: 25.0,
    };
    let file = export.write_rigged(&rig).unwrap();
    let again = mesh::read(&file.name, &file.bytes).unwrap();
    assert_eq!(again.triangles.len(), export.parts[0].mesh.triangles.len());
}

#[test]
fn scenes_that_cannot_be_rigged_say_why() {
    assert!(rig::rig(&[], 25.0, &[]).is_err());
    let ball = scenes(
        "surface s, blobbiness -2, diffuse Red\nsphere s 1 0 0 0\n",
        1,
    );
    let why = rig::rig(&ball, 25.0, &[]).unwrap_err();
    assert!(why.contains("no skeleton"), "{why}");
    // A skeleton that changes ends the animation there.
    let text = "var n = 2 += 1\nsurface s, kernel cauchy, diffuse Red, radius 0.3\n\
        skeleton s, A { node A <0 0 0> node B <1 0 0> node C <2 0 0> curve A B }\n";
    let project = Project::single(text);
    let mut all: Vec<Scene> = (0..3)
        .map(|f| compile_at(&project, &[], f64::from(f)).scene)
        .map(std::sync::Arc::unwrap_or_clone)
        .collect();
    all.push(scenes(SNAKE, 1).remove(0));
    assert_eq!(rig::rig(&all, 25.0, &[]).unwrap().frames.len(), 3);
}
