//! A text means the same scene, to the last bit, on every platform: run natively and as WebAssembly.

use rats::{File, Project, compile, link};

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

/// Hash (FNV-1a) of the scene's bytes.
const SCENE: u64 = 0xDE6F_AD6C_B6B5_40F7;

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn a_scene_is_the_same_everywhere() {
    let project = Project {
        files: vec![File {
            name: "main.rat".into(),
            text: TEXT.into(),
        }],
    };
    let compiled = compile(&project);
    let errors = compiled
        .diagnostics
        .iter()
        .filter(|d| d.severity == rats::Severity::Error);
    assert_eq!(errors.count(), 0, "{:?}", compiled.diagnostics);
    assert_eq!(compiled.scene.elements.len(), 82);
    let bytes = postcard::to_allocvec(&compiled.scene).expect("packs");
    let hash = bytes.iter().fold(0xCBF2_9CE4_8422_2325_u64, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3)
    });
    assert_eq!(hash, SCENE, "{hash:#018x}: what the text means has changed");
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn a_link_is_read_back_everywhere() {
    let shared = link::Shared {
        project: Project {
            files: vec![File {
                name: "main.rat".into(),
                text: TEXT.into(),
            }],
        },
        camera: Some(scene::Camera::default()),
    };
    let fragment = link::encode(&shared).expect("small enough");
    assert_eq!(link::decode(&fragment).expect("reads back"), shared);
}
