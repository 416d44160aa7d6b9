//! Packed scenes, and tiles with the counts of the work for them, are the same to the last bit
//! natively and as wasm. Whole pictures are compared in `pins.rs`.

use crate::common::{FEW, TILE, compile, trace};
use tracer::{Pass, tiles};
use trials::bits::{Hash, compare};

#[test]
fn scenes_and_tiles_have_the_kept_bits() {
    let mut found = Vec::new();
    for name in FEW {
        let mut scene = compile(name);
        let mut packed = Hash::default();
        packed.bytes(&postcard::to_allocvec(&scene).expect("a scene is packed"));
        found.push((format!("{name} packed"), packed));
        scene.settings.samples = 2;
        let size = [128; 2];
        let tile = tiles(size[0], size[1], TILE)[1];
        for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
            let mut hash = Hash::default();
            for (_, pixels, stats) in trace(&scene, size, [(pass, tile)].into_iter()) {
                hash.bytes(&pixels);
                hash.bytes(&postcard::to_allocvec(&stats).expect("counts are packed"));
            }
            found.push((format!("{name} {pass:?}"), hash));
        }
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt");
    compare(&found, include_str!("../bits.txt"), path);
}
