//! Files of skeletons: the first byte chooses the format.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, bytes)) = bytes.split_first() else {
        return;
    };
    let names = [
        "s.swc", "s.3mf", "s.vtp", "s.vtk", "s.csv", "s.obj", "s.ply", "s.xyz", "s.pdb",
    ];
    let reading = limbs::Reading {
        radius: Some(1.0),
        radii: None,
        bonds: true,
    };
    let name = names[usize::from(*choice) % names.len()];
    if let Ok(Some(mut graph)) = limbs::read(name, bytes, &reading) {
        assert!(graph.limbs.iter().flat_map(|limb| limb.radii).all(|radius| radius > 0.0));
        graph.simplify(0.1);
        drop(graph.write_swc());
        drop(graph.merge(0.1));
        drop(graph.write_obj());
    }
});
