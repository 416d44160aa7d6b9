//! A text means the same scene, to the last bit, on every platform: run natively and as
//! WebAssembly.

use rats::{Project, compile, link};
use trials::bits::Hash;

const TEXT: &str = "\
seed 7
blobscale absolute
fragile all
eyep 3 3 3
fov 50 50
vup 0 0 1
light SummerSky point, pos 2 4 3, inten 1.2, noshadow
surface s diffuse OrangeRed, shine 10, blob -128, radius .034, strength 2
object SHELL
for i = 0 to 40 {
  var a = 2*pi*rand
  cylinder s 0.05 <sin(a) cos(a) i/40> <exp(-i/9) atan(a)^2 sqrt(i)>
  arc s 1 0.1 <tan(a/7) 0 i> <1 a 3> 37*a 111
}
close
rotate 1 1 0 30, SHELL
";

#[test]
fn a_scene_and_a_link_are_the_same_everywhere() {
    let project = Project::single(TEXT);
    let compiled = compile(&project);
    let mut messages = compiled.diagnostics.iter();
    assert!(messages.all(|message| message.severity != rats::Severity::Error));
    assert_eq!(compiled.scene.elements.len(), 82);
    let scene = postcard::to_allocvec(&compiled.scene).expect("packs");
    let camera = Some(scene::Camera::default());
    let shared = link::Shared { project, camera };
    let fragment = link::encode(&shared).expect("small enough");
    assert_eq!(link::decode(&fragment).expect("reads back"), shared);
    trials::bits::compare(
        &[
            ("scene".into(), Hash::of(&scene)),
            ("link".into(), Hash::of(fragment.as_bytes())),
        ],
        include_str!("../bits.txt"),
        concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt"),
    );
}
