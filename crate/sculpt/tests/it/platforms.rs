//! Strokes make the same mesh, to the last bit, on every platform: run natively and as WebAssembly.

use sculpt::{Clay, Script, Sculpture, Shape, Start, replay};
use trials::Random;
use trials::bits::Hash;

/// Text with tools of all forms, all decays and all kinds of refinement.
const STROKES: &str = "\
strokes 1
start sphere 6 1 1.2 0.8
push sphere 0.4 0.3 0.5 goo 1 : 1 0.2 0.1, 0.8 0.2 0.1
refine propagate
symmetry x
pull box 0.2 0.2 0.3 0.4 1.7 turn 10 20 30 bell 0.5 normal : 0 0.9 0.3, 0.1 1.4 0.5 0.7
loop 1
average 2 0.35
simplify 0.5
";

/// Returns the mesh's digest after the text.
fn of_text() -> u64 {
    let script: Script = STROKES.parse().expect("a text of strokes");
    let none = &mut |name: &str| Err(format!("there is no {name}"));
    let clay = replay(&script, none, u64::MAX, |_, _, _| ()).expect("replayed");
    clay.mesh().validate().expect("a mesh");
    clay.digest()
}

/// Returns a digest of all meshes on the way, some of which a later simplification might hide.
fn of_random_strokes() -> u64 {
    let mut random = Random::fixed(11);
    let clay = Clay::of_shape(&Start::new(Shape::Sphere, 4)).expect("a start");
    let mut sculpture = Sculpture::new(clay);
    let (mut done, mut digests) = (0, 0_u64);
    for _ in 0..400 {
        let faces = sculpture.clay().mesh().face_count();
        let stroke = crate::strokes::stroke(&mut random, faces);
        done += u32::from(sculpture.carry_out(stroke).is_ok());
        digests = digests.rotate_left(7) ^ sculpture.clay().digest();
    }
    assert!(done > 300, "{done} strokes were carried out");
    digests
}

#[test]
fn strokes_make_the_same_bits_everywhere() {
    trials::bits::compare(
        &[("text", of_text()), ("random", of_random_strokes())]
            .map(|(name, digest)| (name.into(), Hash::of(&digest.to_le_bytes()))),
        include_str!("../bits.txt"),
        concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt"),
    );
}
