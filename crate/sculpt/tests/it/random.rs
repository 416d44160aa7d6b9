//! Random strokes keep all invariants, and undo gives the first bits back.

use crate::strokes::{stroke, sweep};
use glam::DVec3;
use mesh::VertexId;
use sculpt::{
    Action, Beginning, Clay, Deletion, Refinement, Region, Script, Sculpture, Shape, Start, Stroke,
    replay,
};
use trials::{Random, count};

/// Returns the vertices with a mask of 1, which must stay, and the bits of their places.
fn vertices_that_stay(clay: &Clay) -> Vec<(VertexId, [u64; 3])> {
    let vertices = clay.mesh().vertices().filter(|v| clay.mask(*v) == 1.0);
    vertices
        .map(|v| (v, bits(clay.mesh().position(v))))
        .collect()
}

/// The bits of a place.
pub fn bits(p: DVec3) -> [u64; 3] {
    p.to_array().map(f64::to_bits)
}

/// Checks the clay after a stroke.
fn check(clay: &Clay, stroke: &Stroke, before: &Before) {
    let mesh = clay.mesh();
    mesh.validate()
        .unwrap_or_else(|error| panic!("{stroke}: {error}"));
    let mut euler = 0;
    for shell in mesh.shells() {
        let twice = 2 - shell.boundary_loops as i64 - shell.euler_characteristic();
        assert!(twice >= 0 && twice % 2 == 0, "{stroke}: no genus");
        euler += shell.euler_characteristic();
    }
    assert_eq!(euler, mesh.euler_characteristic());
    match stroke {
        Stroke::Fill | Stroke::Delete(Deletion::Hole) => {}
        _ => assert_eq!(mesh.euler_characteristic(), before.euler, "{stroke}"),
    }
    let is_still = matches!(
        stroke,
        Stroke::Sweep(_) | Stroke::Average(..) | Stroke::Region(_) | Stroke::Masks(_)
    );
    if is_still {
        let counts = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
        assert_eq!(counts, before.counts, "{stroke}");
    }
    for v in mesh.vertices() {
        assert!((0.0..=1.0).contains(&clay.mask(v)), "{stroke}");
        assert!(clay.color(v).iter().all(|c| (0.0..=1.0).contains(c)));
    }
    let changes_masks = match stroke {
        Stroke::Masks(_) => true,
        Stroke::Sweep(sweep) => matches!(sweep.action, Action::Mask(_)),
        _ => false,
    };
    for (v, place) in &before.held {
        assert!(mesh.has_vertex(*v), "{stroke}: a held vertex is lost");
        assert_eq!(
            bits(mesh.position(*v)),
            *place,
            "{stroke}: a held vertex moved"
        );
        assert!(
            changes_masks || clay.mask(*v) == 1.0,
            "{stroke}: a mask is lost"
        );
    }
    if let Region::Faces(faces) = clay.region() {
        assert!(faces.is_sorted_by(|a, b| a < b), "{stroke}");
        assert!(faces.iter().all(|f| mesh.has_face(*f)), "{stroke}");
    }
}

/// Values that are compared after a stroke.
struct Before {
    euler: i64,
    counts: [usize; 3],
    held: Vec<(VertexId, [u64; 3])>,
}

impl Before {
    fn of(clay: &Clay) -> Self {
        let mesh = clay.mesh();
        Self {
            euler: mesh.euler_characteristic(),
            counts: [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
            held: vertices_that_stay(clay),
        }
    }
}

/// Carries out so many random strokes, checks each, takes all back and carries them out again.
/// Returns how many were refused.
fn run(seed: u64, count: usize) -> usize {
    let mut random = Random::new(seed);
    let shape = random.pick(&Shape::ALL);
    let start = Start::new(shape, 2 + random.below(3) as u32);
    let clay = Clay::of_shape(&start).expect("a start");
    let mut sculpture = Sculpture::new(clay.clone());
    let mut refused = 0;
    for _ in 0..count {
        let faces = sculpture.clay().mesh().face_count();
        let stroke = stroke(&mut random, faces);
        let before = Before::of(sculpture.clay());
        let digest = sculpture.clay().digest();
        match sculpture.carry_out(stroke.clone()) {
            Ok(()) => check(sculpture.clay(), &stroke, &before),
            Err(_) => {
                refused += 1;
                assert_eq!(sculpture.clay().digest(), digest, "{stroke} left something");
            }
        }
    }
    let last = sculpture.clay().digest();
    let strokes: Vec<Stroke> = sculpture.strokes().cloned().collect();
    while sculpture.undo().expect("undone").is_some() {}
    assert_eq!(sculpture.clay().digest(), clay.digest(), "the first bits");
    assert_eq!(*sculpture.clay().mesh(), *clay.mesh());
    while sculpture.redo().expect("redone").is_some() {}
    assert_eq!(sculpture.clay().digest(), last, "the last bits");
    // The text gives the same.
    let script = Script::new(Beginning::Shape(start), strokes);
    let again: Script = script.to_string().parse().expect("its own text");
    assert_eq!(again.strokes, script.strokes);
    let replayed = replay(&again, &mut |_| Err(String::new()), u64::MAX, |_, _, _| ());
    assert_eq!(
        replayed.expect("replayed").digest(),
        last,
        "the replayed bits"
    );
    refused
}

#[test]
fn random_strokes_keep_the_mesh_and_can_be_taken_back() {
    let runs = count(20);
    let refused: usize = (0..runs as u64).map(|seed| run(seed, 250)).sum();
    // Some are refused (nothing would be left, a part is no disc), most are not.
    assert!(
        (runs / 4..50 * runs).contains(&refused),
        "{refused} were refused"
    );
}

#[test]
fn undo_without_memory_replays() {
    let start = Clay::of_shape(&Start::new(Shape::Sphere, 3)).unwrap();
    let mut sculpture = Sculpture::new(start.clone());
    sculpture.limit_undo(0);
    let mut random = Random::new(7);
    let mut digests = vec![start.digest()];
    for i in 0..20 {
        let stroke = match i % 5 {
            4 => Stroke::Refine(Refinement::Local),
            _ => Stroke::Sweep(sweep(&mut random, Action::Push)),
        };
        sculpture.carry_out(stroke).unwrap();
        digests.push(sculpture.clay().digest());
    }
    assert_eq!(sculpture.depth(), [20, 0]);
    for digest in digests.iter().rev().skip(1) {
        sculpture.undo().unwrap();
        assert_eq!(sculpture.clay().digest(), *digest);
    }
    assert!(sculpture.undo().unwrap().is_none());
    while sculpture.redo().unwrap().is_some() {}
    assert_eq!(Some(&sculpture.clay().digest()), digests.last());
}
