//! Limbs that a closed mesh cuts, as beam lattices of files are.

use crate::judges::assert_manifold;
use glam::DVec3;
use mesh::{Aabb, Topology, TriangleMesh};
use mesher::{Model, Progress, Step, Tolerance, Wishes, mesh_scene};
use rats::{Project, compile};
use scene::curves::Clip;
use scene::{Form, Scene, Shape};
use std::ops::ControlFlow;
use std::sync::Arc;
use trials::boxes;

/// Limbs: two that cross, and a third beside them.
const LIMBS: &str = "skeleton Flesh, S { node A <-9 0 0> node B <9 0 0> node C <0 -9 0> \
    node D <0 9 0> node E <-9 0 4> node F <9 0 4> curve A B curve C D curve E F }";

/// The scene of a text, in which all skeletons are cut by a mesh.
fn scene(text: &str, clip: &Clip) -> Scene {
    let compiled = compile(&Project::single(format!(
        "verbose off\neyep 0 0 90\nsurface Flesh, diffuse Red, radius 1, kernel compact6, \
         blobbiness -8\n{text}"
    )));
    assert_eq!(compiled.diagnostics, []);
    let mut scene = Arc::unwrap_or_clone(compiled.scene);
    for element in &mut scene.elements {
        if let Shape::Function(function) = &mut element.shape
            && let Form::Skeleton(curves) = &mut function.form
        {
            Arc::make_mut(curves).clip = Some(Arc::new(clip.clone()));
        }
    }
    scene
}

/// A box from one corner to another, as a mesh.
fn block(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    (boxes::corners(low, high), boxes::triangles())
}

fn build(scene: &Scene, is_united: bool) -> Model {
    let wishes = Wishes {
        tolerance: Tolerance::Absolute(0.06),
        prove: false,
        union: is_united,
        ..Wishes::default()
    };
    mesh_scene(scene, &wishes, &mut Progress::new(&mut go_on)).unwrap()
}

fn go_on(_: Step) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Meshes a text, hard shapes united, that is cut by some meshes.
fn cut(text: &str, is_inside: bool, by: &[&(Vec<DVec3>, Vec<[u32; 3]>)]) -> Model {
    let meshes = by.iter().copied().cloned().collect();
    let is_hard = text.starts_with("soft off");
    build(&scene(text, &Clip { is_inside, meshes }), is_hard)
}

/// The volume of the only part, which is closed.
fn volume(model: &Model, name: &str) -> f64 {
    let [part] = &model.parts[..] else {
        panic!("{name}: {} parts", model.parts.len())
    };
    assert!(part.is_closed, "{name}");
    assert_manifold(name, &part.mesh);
    part.mesh.signed_volume()
}

#[test]
fn both_sides_of_a_mesh_make_up_the_whole() {
    for text in [LIMBS.to_owned(), format!("soft off\n{LIMBS}")] {
        let far = block(DVec3::splat(90.0), DVec3::splat(99.0));
        let whole = volume(&cut(&text, false, &[&far]), "whole");
        let half = block(DVec3::new(0.25, -20.0, -20.0), DVec3::splat(20.0));
        let [inside, outside] = [true, false].map(|side| cut(&text, side, &[&half]));
        for (model, side) in [(&inside, 1.0), (&outside, -1.0)] {
            let positions = &model.parts[0].mesh.positions;
            assert!(positions.iter().all(|p| side * (p.x - 0.25) >= -1e-9));
            let on_face = positions.iter().filter(|p| (p.x - 0.25).abs() < 1e-9);
            assert!(on_face.count() > 10, "{text}");
        }
        let parts = [inside, outside].map(|model| volume(&model, "half"));
        assert!(parts[0] > 0.3 * whole && parts[1] > 0.3 * whole);
        assert!(
            (parts[0] + parts[1] - whole).abs() < 1e-6 * whole,
            "{parts:?} {whole}"
        );
        // Turned inside out it cuts the same; two cut as their union.
        let mut turned = half.clone();
        turned.1.iter_mut().for_each(|t| t.swap(1, 2));
        let again = volume(&cut(&text, true, &[&turned]), "turned");
        assert!((again - parts[0]).abs() < 1e-9 * whole);
        let more = block(DVec3::new(0.1, -20.0, -20.0), DVec3::splat(10.0));
        let both = volume(&cut(&text, true, &[&half, &more]), "two");
        assert!(both > parts[0] && both < whole);
    }
}

#[test]
fn clips_follow_their_skeleton() {
    let half = block(DVec3::new(0.25, -20.0, -20.0), DVec3::splat(20.0));
    let clip = Clip {
        is_inside: true,
        meshes: vec![half],
    };
    let model = build(&scene(&format!("{LIMBS}\ntranslate 5 0 0 S"), &clip), false);
    let bounds = model.bounds();
    assert!((bounds.min.x - 5.25).abs() < 1e-9, "{bounds:?}");
}

#[test]
fn what_cannot_be_clipped_is_told() {
    let (positions, mut triangles) = block(DVec3::new(0.25, -20.0, -20.0), DVec3::splat(20.0));
    let mut clip = Clip {
        is_inside: true,
        meshes: vec![(positions.clone(), triangles.clone())],
    };
    // A ball of the same body blends with the limbs, and is not clipped.
    let mixed = build(
        &scene(&format!("{LIMBS}\nsphere Flesh 2, 0 0 -3"), &clip),
        false,
    );
    assert!(
        mixed
            .notes
            .iter()
            .any(|note| note.contains("not clipped, as other limbs"))
    );
    assert!(mixed.bounds().min.x < -8.0);
    triangles.pop();
    clip.meshes = vec![(positions, triangles)];
    let open = build(&scene(LIMBS, &clip), false);
    assert!(open.notes.iter().any(|note| note.contains("is not closed")));
    assert!(open.bounds().min.x < -8.0);
    // Nothing is left.
    clip.meshes = vec![block(DVec3::splat(30.0), DVec3::splat(40.0))];
    let wishes = Wishes {
        prove: false,
        ..Wishes::default()
    };
    let none = mesh_scene(
        &scene(LIMBS, &clip),
        &wishes,
        &mut Progress::new(&mut go_on),
    );
    assert!(none.is_err());
}

/// Copies have meshes of their own: each hard one is cut at its own.
#[test]
fn copies_are_clipped_by_copies_of_the_mesh() {
    let half = block(DVec3::new(0.25, -20.0, -20.0), DVec3::splat(20.0));
    let clip = Clip {
        is_inside: true,
        meshes: vec![half],
    };
    let copies = format!("{LIMBS}\ninstance S, COPY translate 5 0 8");
    let model = build(&scene(&format!("soft off\n{copies}"), &clip), false);
    let [part] = &model.parts[..] else {
        panic!("{} parts", model.parts.len())
    };
    for shell in shells(&part.mesh) {
        let is_copy = shell.max.z > 6.0;
        let least = if is_copy { 5.25 } else { 0.25 };
        assert!((shell.min.x - least).abs() < 1e-9, "{shell:?}");
    }
    // Soft ones blend, and the mesh of neither cuts both.
    let model = build(&scene(&copies, &clip), false);
    let mut notes = model.notes.iter();
    assert!(notes.any(|note| note.contains("not clipped, as other limbs")));
    assert!(model.bounds().min.x < -8.0);
    // Each is cut if it is a body of its own.
    let bodies = format!("body B\n{LIMBS}\nclose\ninstance B, COPY translate 5 0 8");
    let model = build(&scene(&bodies, &clip), false);
    let least = model.parts.iter().map(|part| part.mesh.bounds().min.x);
    let least: Vec<f64> = least.collect();
    assert!((least[0] - 0.25).abs() < 1e-9 && (least[1] - 5.25).abs() < 1e-9);
}

/// The boxes of a mesh's connected parts.
fn shells(mesh: &TriangleMesh) -> Vec<Aabb> {
    let topology = Topology::of(mesh).unwrap();
    let mut boxes = vec![Aabb::EMPTY; topology.genera.len()];
    let mut shell: Vec<usize> = (0..mesh.positions.len()).collect();
    let mut is_done = false;
    while !is_done {
        is_done = true;
        for triangle in &mesh.triangles {
            let least = triangle.iter().map(|i| shell[*i as usize]).min().unwrap();
            for i in triangle {
                is_done &= shell[*i as usize] == least;
                shell[*i as usize] = least;
            }
        }
    }
    let mut firsts = shell.clone();
    firsts.sort_unstable();
    firsts.dedup();
    assert_eq!(firsts.len(), boxes.len());
    for (at, first) in mesh.positions.iter().zip(&shell) {
        let own = &mut boxes[firsts.binary_search(first).unwrap()];
        *own = own.union(&Aabb::of_points([*at]));
    }
    boxes
}

#[test]
fn meshes_of_too_many_triangles_clip_nothing() {
    let (positions, triangles) = block(DVec3::new(0.25, -20.0, -20.0), DVec3::splat(20.0));
    let clip = Clip {
        is_inside: true,
        meshes: vec![(positions, triangles.repeat(9_000))],
    };
    for text in [LIMBS.to_owned(), format!("soft off\n{LIMBS}")] {
        let model = build(&scene(&text, &clip), false);
        let mut notes = model.notes.iter();
        assert!(notes.any(|note| note.contains("not clipped, as the mesh that clips it has")));
        assert!(model.bounds().min.x < -8.0);
    }
}
