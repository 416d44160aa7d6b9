//! Files of meshes and heights: the first byte chooses the format.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, bytes)) = bytes.split_first() else {
        return;
    };
    match choice % 6 {
        0 => drop(mesh::heights(bytes)),
        kind => {
            let name = ["m.obj", "m.ply", "m.stl", "m.glb", "m.3mf"][usize::from(kind) - 1];
            drop(mesh::read(name, bytes));
        }
    }
});
