//! Random strokes keep all invariants, and undo gives the first bits back.

use crate::common::run;
use sculpt::{Action, Clay, Sculpture, Shape, Start, Stroke};

#[test]
fn ten_thousand_random_strokes_keep_the_mesh_and_can_be_taken_back() {
    let refused: usize = (0..40).map(|seed| run(seed, 250)).sum();
    // Some are refused (nothing would be left, a part is no disc), most are not.
    assert!((10..2000).contains(&refused), "{refused} were refused");
}

#[test]
fn undo_without_memory_replays() {
    let start = Clay::of_shape(&Start::new(Shape::Sphere, 3)).unwrap();
    let mut sculpture = Sculpture::new(start.clone());
    sculpture.limit_undo(0);
    let mut random = crate::common::Random(7);
    let mut digests = vec![start.digest()];
    for i in 0..20 {
        let stroke = match i % 5 {
            4 => Stroke::Refine(sculpt::Refinement::Local),
            _ => Stroke::Sweep(crate::common::sweep(&mut random, Action::Push)),
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
