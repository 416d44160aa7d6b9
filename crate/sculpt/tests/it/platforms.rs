//! Strokes make the same mesh, to the last bit, on every platform: run natively and as WebAssembly.

use sculpt::{Clay, Script, Sculpture, Shape, Start, replay};

/// A text with tools of all forms, all decays and all kinds of refinement.
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

/// Digests after the text, and after the random strokes.
const EXPECTED: [u64; 2] = [0x564E_017E_1E76_6424, 0x067C_94F8_E005_4E79];

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn a_text_of_strokes_makes_the_same_bits_everywhere() {
    let script: Script = STROKES.parse().expect("a text of strokes");
    let none = &mut |name: &str| Err(format!("there is no {name}"));
    let clay = replay(&script, none, u64::MAX, |_, _, _| ()).expect("replayed");
    clay.mesh().validate().expect("a mesh");
    let digest = clay.digest();
    assert_eq!(digest, EXPECTED[0], "{digest:#018x}: the mesh has changed");
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn random_strokes_make_the_same_bits_everywhere() {
    let mut random = crate::common::Random(11);
    let clay = Clay::of_shape(&Start::new(Shape::Sphere, 4)).expect("a start");
    let mut sculpture = Sculpture::new(clay);
    let (mut done, mut digests) = (0, 0_u64);
    for _ in 0..400 {
        let faces = sculpture.clay().mesh().face_count();
        let stroke = crate::common::stroke(&mut random, faces);
        done += u32::from(sculpture.carry_out(stroke).is_ok());
        // Also of the meshes on the way, which a later simplification might hide.
        digests = digests.rotate_left(7) ^ sculpture.clay().digest();
    }
    assert!(done > 300, "{done} strokes were carried out");
    assert_eq!(
        digests, EXPECTED[1],
        "{digests:#018x}: the meshes have changed"
    );
}
